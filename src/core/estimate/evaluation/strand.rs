//! The sums of all segments, by as many threads as pay.
//!
//! Segments do not know of one another. Each thread takes some that follow one another, and what they give is added up
//! in their order afterwards: numbers do not depend on how many threads there were.

use std::ops::Range;

use rayon::prelude::*;

use super::local_sums::LocalSums;
use crate::estimate::problem::unusable::{Unusable, left_range};
use crate::estimate::problem::{Problem, set_parameters};
use crate::simulate::{Block, Sensitivities};
use crate::stop;

/// Fewer samples than these are not worth a thread of their own: it takes some 10 µs to wake one.
const LEAST_SAMPLES: usize = 1000;

/// One thread's own machinery to go along segments.
pub(crate) struct Strand<'p> {
    machinery: Sensitivities<'p>,
    parameters: Vec<f64>,
}

impl<'p> Strand<'p> {
    pub(crate) fn new(problem: &'p Problem) -> Self {
        let options = &problem.options;
        Self {
            machinery: Sensitivities::new(
                &problem.model,
                &problem.columns,
                options.integrator,
                options.input_interpolation,
            ),
            parameters: Vec::new(),
        }
    }

    /// As many as the machine has cores for, and the problem work.
    pub(crate) fn several(problem: &'p Problem) -> Vec<Self> {
        let paying = problem.samples() / LEAST_SAMPLES;
        let count = rayon::current_num_threads()
            .min(problem.segments.len())
            .min(paying)
            .max(1);
        (0..count).map(|_| Self::new(problem)).collect()
    }

    /// Goes along one segment and hands outputs and sensitivities to `sink`.
    pub(crate) fn run(
        &mut self,
        problem: &Problem,
        segment: usize,
        theta: &[f64],
        sink: impl FnMut(&Block<'_>),
    ) -> Result<(), Unusable> {
        set_parameters(problem, segment, theta, &mut self.parameters)?;
        self.machinery
            .run(&problem.segments[segment], &self.parameters, sink)
            .map_err(|diverged| left_range(segment, &diverged))
    }

    fn sums(
        &mut self,
        problem: &Problem,
        segments: Range<usize>,
        theta: &[f64],
        full: bool,
    ) -> Result<Vec<LocalSums>, Unusable> {
        let one = |segment: usize| {
            let mut sums = LocalSums::new(problem, full);
            self.run(problem, segment, theta, |block| {
                sums.add(block, &problem.segments[segment]);
            })?;
            Ok(sums)
        };
        segments.map(one).collect()
    }
}

/// The sums of each segment, in order.
///
/// # Errors
/// That of the first segment that has one.
pub(crate) fn sums(
    strands: &mut [Strand<'_>],
    problem: &Problem,
    theta: &[f64],
    full: bool,
) -> Result<Vec<LocalSums>, Unusable> {
    if let [strand] = strands {
        return strand.sums(problem, 0..problem.segments.len(), theta, full);
    }
    let parts = parts(problem, strands.len());
    let of_part =
        |(strand, part): (&mut Strand<'_>, Range<usize>)| strand.sums(problem, part, theta, full);
    let found: Vec<Result<Vec<LocalSums>, Unusable>> = (strands.par_iter_mut())
        .zip(parts)
        .map(stop::shared(of_part))
        .collect();
    let mut all = Vec::with_capacity(problem.segments.len());
    for part in found {
        all.extend(part?);
    }
    Ok(all)
}

/// Segments that follow one another, about as many samples in each part.
fn parts(problem: &Problem, count: usize) -> Vec<Range<usize>> {
    let share = problem.samples().div_ceil(count);
    let (mut first, mut samples) = (0, 0);
    let mut parts = Vec::with_capacity(count);
    for (index, segment) in problem.segments.iter().enumerate() {
        samples += segment.len();
        if samples >= share * (parts.len() + 1) || index + 1 == problem.segments.len() {
            parts.push(first..index + 1);
            first = index + 1;
        }
    }
    parts
}
