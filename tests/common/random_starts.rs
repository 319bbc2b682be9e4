//! Estimations from random starts: how many end in the best known optimum.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::json;
use trimtab_core::estimate::{Problem, StartMethod, estimate};
use trimtab_core::job::{self, JobSpec, ModelSource};

use super::published_cases::Case;
use super::recordings::maneuver;

/// A published case, ready to be solved, and the reference's estimate at the places of θ (SI).
pub(crate) fn problem(case: &Case) -> (Problem, Vec<f64>) {
    let (text, rows) = &case.segments[0];
    let recording = maneuver(text.as_bytes());
    let spec = json!({
        "model": case.model, "channels": case.channels,
        "maneuvers": [{"id": recording.digest(), "rows": rows, "gaps": "join"}],
    });
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    let ModelSource::Document(document) = &spec.model else {
        panic!("a document")
    };
    let plan = job::prepare(&spec, document, &[recording]).unwrap_or_else(|f| panic!("{f:#?}"));
    let problem = plan.problem;
    let reference = (0..problem.unknowns.len())
        .map(|place| {
            let name = problem.name(place);
            let found = case.reference.iter().find(|(own, ..)| *own == name);
            problem.unit(place).to_si(found.expect("a reference").2)
        })
        .collect();
    (problem, reference)
}

/// The problem from random start `number`: each unknown drawn evenly from `share` times its reference.
pub(crate) fn drawn(
    problem: &Problem,
    reference: &[f64],
    share: &std::ops::RangeInclusive<f64>,
    number: usize,
) -> Problem {
    let mut random = ChaCha8Rng::seed_from_u64(number as u64);
    let mut problem = problem.clone();
    for (place, value) in reference.iter().enumerate() {
        let index = problem.unknowns.free[place];
        problem.unknowns.all[index].start = value * random.random_range(share.clone());
    }
    problem
}

/// What came of some random starts.
#[derive(Clone, Copy, Default, Debug)]
pub(crate) struct Count {
    pub starts: usize,
    /// det R within 1e-4 of the best known.
    pub best: usize,
    /// Ended elsewhere.
    pub elsewhere: usize,
    /// Could not begin.
    pub unusable: usize,
    /// Simulations, with sensitivities or without, of the last descent.
    pub evaluations: usize,
}

/// Runs random starts on all cores; `best` is the best known det R.
pub(crate) fn count(
    problem: &Problem,
    reference: &[f64],
    share: &std::ops::RangeInclusive<f64>,
    starts: usize,
    method: &StartMethod,
    best: f64,
) -> Count {
    let next = AtomicUsize::new(0);
    let some = || {
        let mut count = Count::default();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= starts {
                return count;
            }
            let mut problem = drawn(problem, reference, share, number);
            problem.options.start = method.clone();
            problem.options.max_iterations = 200;
            count.starts += 1;
            match estimate(&problem, &mut |_| ControlFlow::Continue(())) {
                Ok(solution) => {
                    let found = solution.estimate;
                    count.evaluations += found.evaluations + found.simulations;
                    if found.det_r < best * (1.0 + 1e-4) {
                        count.best += 1;
                    } else {
                        count.elsewhere += 1;
                    }
                }
                Err(_) => count.unusable += 1,
            }
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        let running: Vec<_> = (0..threads).map(|_| scope.spawn(some)).collect();
        running.into_iter().fold(Count::default(), |sum, thread| {
            let own = thread.join().expect("a count");
            Count {
                starts: sum.starts + own.starts,
                best: sum.best + own.best,
                elsewhere: sum.elsewhere + own.elsewhere,
                unusable: sum.unusable + own.unusable,
                evaluations: sum.evaluations + own.evaluations,
            }
        })
    })
}
