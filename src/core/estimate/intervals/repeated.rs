//! Estimates of recordings that are made anew, many times.

use std::ops::Range;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::fitted::Fitted;
use super::refit::refit;
use super::teller::Teller;
use crate::estimate::problem::Problem;
use crate::stop;

/// How often the work tells how far it is.
pub(super) const PARTS: usize = 4;

/// What is added to the outputs of the estimate.
pub(super) trait Scatter: Sync {
    /// To the outputs of a segment, by output, then sample.
    fn add(&self, random: &mut ChaCha8Rng, segment: usize, outputs: &mut [Vec<f64>]);
}

/// The estimates that were found.
pub(super) struct Estimates {
    /// By recording, then place of θ, SI.
    pub found: Vec<Vec<f64>>,
    /// How many fits found no minimum.
    pub failed: usize,
}

/// Numbers that no two methods share.
pub(super) struct Draws {
    pub name: &'static str,
    pub count: usize,
    pub seed: u64,
    /// The first stream of the generator; each recording has one of its own.
    pub stream: u64,
}

/// Makes and fits recordings; none where the watcher wants no more.
pub(super) fn estimates(
    fitted: &Fitted,
    scatter: &dyn Scatter,
    draws: &Draws,
    teller: &mut Teller<'_, '_>,
) -> Option<Estimates> {
    let mut found = Vec::with_capacity(draws.count);
    for part in 0..PARTS {
        let numbers = draws.count * part / PARTS..draws.count * (part + 1) / PARTS;
        let last = numbers.end;
        found.extend(in_parallel(&fitted.problem, numbers, |problem, number| {
            let mut random = ChaCha8Rng::seed_from_u64(draws.seed);
            random.set_stream(draws.stream + number as u64);
            make(fitted, scatter, &mut random, problem);
            refit(problem, fitted.theta.clone()).map(|minimum| minimum.theta)
        }));
        teller.tell(format!("{}: {last} of {} fits", draws.name, draws.count))?;
    }
    let found: Vec<Vec<f64>> = found.into_iter().flatten().collect();
    Some(Estimates {
        failed: draws.count - found.len(),
        found,
    })
}

/// Puts outputs of the estimate and what is added to them in the place of what was measured.
fn make(fitted: &Fitted, scatter: &dyn Scatter, random: &mut ChaCha8Rng, problem: &mut Problem) {
    for (index, segment) in problem.segments.iter_mut().enumerate() {
        let mut outputs: Vec<Vec<f64>> = fitted.modelled(index).map(<[f64]>::to_vec).collect();
        scatter.add(random, index, &mut outputs);
        let measured = &fitted.problem.segments[index].measured;
        for (output, measured) in outputs.iter_mut().zip(measured) {
            // what was not measured is not made up
            let missing = output.iter_mut().zip(measured).filter(|(_, z)| z.is_nan());
            missing.for_each(|(z, _)| *z = f64::NAN);
        }
        segment.measured = outputs;
    }
}

/// Work by number on all threads, each with a problem of its own; results in order.
fn in_parallel<T: Send>(
    problem: &Problem,
    numbers: Range<usize>,
    work: impl Fn(&mut Problem, usize) -> T + Send + Sync,
) -> Vec<T> {
    let threads = rayon::current_num_threads().min(numbers.len()).max(1);
    let every = numbers.clone();
    let of_thread = move |thread: usize| {
        let mut own = problem.clone();
        let numbers = every.clone().skip(thread).step_by(threads);
        numbers
            .map(|number| work(&mut own, number))
            .collect::<Vec<T>>()
    };
    let found: Vec<Vec<T>> = (0..threads)
        .into_par_iter()
        .map(stop::shared(of_thread))
        .collect();
    let mut of_threads: Vec<_> = found.into_iter().map(Vec::into_iter).collect();
    (0..numbers.len())
        .filter_map(|place| of_threads[place % threads].next())
        .collect()
}
