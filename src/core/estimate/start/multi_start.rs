//! Many random starts, each run to its end; the best is kept.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::found::Start;
use crate::estimate::descent::gauss_newton::descend;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::progress::{Progress, Watcher};
use crate::estimate::report::start::{StartKind, StartReport};
use crate::stop::{caught, check, droppable, shared};

/// Costs that differ by less than this are of one optimum: a seventh of a standard error away, at most.
const SAME_OPTIMUM: f64 = 0.01;

/// Where one start led.
struct Run {
    number: usize,
    /// θ and -ln L; none where the start could not be simulated.
    end: Option<(Vec<f64>, f64)>,
    evaluations: usize,
}

/// # Errors
/// None of the starts could be simulated.
pub(crate) fn multi_start(
    problem: &Problem,
    starts: usize,
    seed: u64,
    spread: f64,
    watcher: &mut Watcher<'_>,
) -> Result<Start, Unusable> {
    let next = AtomicUsize::new(0);
    let stop = AtomicBool::new(false);
    let threads = std::thread::available_parallelism()
        .map_or(1, NonZero::get)
        .min(starts);
    let (send, runs) = mpsc::channel();
    let one = shared(|number: usize| {
        let theta = random_start(problem, number, seed, spread);
        let run = run(problem, number, theta, &stop);
        // where it was dropped it is kept as far as it came, and no further one is begun
        if droppable(check).is_err() {
            stop.store(true, Ordering::Relaxed);
        }
        run
    });
    let mut tally = Tally::default();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            let send = send.clone();
            let (next, stop, one) = (&next, &stop, &one);
            scope.spawn(move || {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= starts || stop.load(Ordering::Relaxed) {
                        return;
                    }
                    let Ok(run) = caught(|| one(number)) else {
                        stop.store(true, Ordering::Relaxed);
                        return;
                    };
                    if send.send(run).is_err() {
                        return;
                    }
                }
            });
        }
        drop(send);
        // told in the order of their numbers, whichever thread was first: the log is the same every time
        let mut early: Vec<Option<Run>> = (0..starts).map(|_| None).collect();
        let mut told = 0;
        for run in runs {
            let number = run.number;
            early[number] = Some(run);
            while let Some(run) = early.get_mut(told).and_then(Option::take) {
                told += 1;
                let report = tally.add(run, starts);
                if !stop.load(Ordering::Relaxed) && watcher(Progress::Start(&report)).is_break() {
                    stop.store(true, Ordering::Relaxed);
                }
            }
        }
    });
    check();
    let stopped = stop.load(Ordering::Relaxed);
    match tally.best {
        Some((theta, _)) => Ok(Start {
            theta,
            stopped,
            may_shoot: false,
        }),
        // the document's own values then say what is wrong
        None => Ok(Start {
            theta: problem.unknowns.start(),
            stopped,
            may_shoot: false,
        }),
    }
}

/// Start `number` of a seed: the document's own first, so that the result is never worse than without.
fn random_start(problem: &Problem, number: usize, seed: u64, spread: f64) -> Vec<f64> {
    let mut theta = problem.unknowns.start();
    if number == 0 {
        return theta;
    }
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(number as u64);
    for (place, value) in theta.iter_mut().enumerate() {
        let unknown = problem.unknowns.at(place);
        let share: f64 = random.random();
        let (lower, upper) = if unknown.lower.is_finite() && unknown.upper.is_finite() {
            (unknown.lower, unknown.upper)
        } else {
            let reach = spread * value.abs();
            (*value - reach, *value + reach)
        };
        *value = (lower + share * (upper - lower)).clamp(unknown.lower, unknown.upper);
    }
    theta
}

fn run(problem: &Problem, number: usize, theta: Vec<f64>, stop: &AtomicBool) -> Run {
    let mut asked =
        |_: &crate::estimate::report::iteration::Iteration| match stop.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
    match descend(problem, theta, &mut asked) {
        Ok(descent) => Run {
            number,
            evaluations: descent.evaluator.evaluations + descent.evaluator.simulations,
            end: Some((descent.last.theta, descent.last.weighting.cost)),
        },
        Err(_) => Run {
            number,
            evaluations: 1,
            end: None,
        },
    }
}

/// The results of the runs so far.
#[derive(Default)]
struct Tally {
    best: Option<(Vec<f64>, f64)>,
    costs: Vec<f64>,
    runs: usize,
    evaluations: usize,
}

impl Tally {
    fn add(&mut self, run: Run, starts: usize) -> StartReport {
        self.runs += 1;
        self.evaluations += run.evaluations;
        let ended = match run.end {
            Some((theta, cost)) => {
                self.costs.push(cost);
                if self.best.as_ref().is_none_or(|&(_, best)| cost < best) {
                    self.best = Some((theta, cost));
                }
                format!("-ln L {cost:.2}")
            }
            None => "leaves the range of numbers".to_string(),
        };
        let best = self.best.as_ref().map(|&(_, cost)| cost);
        let reached = |best: f64| {
            self.costs
                .iter()
                .filter(|&&c| c - best < SAME_OPTIMUM)
                .count()
        };
        let text = format!(
            "start {} of {starts}: {ended}; {} so far reached the best optimum",
            self.runs,
            best.map_or(0, reached)
        );
        StartReport {
            method: StartKind::MultiStart,
            evaluations: self.evaluations,
            cost: best,
            text,
        }
    }
}
