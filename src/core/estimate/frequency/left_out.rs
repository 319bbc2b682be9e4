//! What a band of frequencies leaves out: biases, trim values, initial states. They are fitted to the time histories.

use crate::estimate::descent::gauss_newton::descend;
use crate::estimate::options::Options;
use crate::estimate::options::technique::Derivatives;
use crate::estimate::problem::Problem;
use crate::estimate::report::progress::unobserved;

/// Most of these unknowns are linear in the outputs: a few steps are enough.
const MOST_ITERATIONS: usize = 10;
/// In standard errors.
const TOLERANCE: f64 = 1e-2;

/// θ of a problem of the time domain with what does not show in the band fitted, and all that `is_seen` held. Where a
/// simulation leads nowhere, as of an unstable aircraft, it is left as it was.
pub(super) fn with_left_out(
    problem: &Problem,
    theta: Vec<f64>,
    is_seen: impl Fn(usize) -> bool,
) -> Vec<f64> {
    let unknowns = &problem.unknowns;
    let left: Vec<usize> = (0..unknowns.len())
        .filter(|&place| !is_seen(place))
        .collect();
    if left.is_empty() || problem.options.max_iterations == 0 {
        return theta;
    }
    let mut values: Vec<f64> = unknowns.all.iter().map(|unknown| unknown.start).collect();
    for (&index, &value) in unknowns.free.iter().zip(&theta) {
        values[index] = value;
    }
    let held = unknowns.with_starts(&values).with_held(|unknown| {
        let place = unknowns.place(unknown.segment.unwrap_or(0), unknown.parameter);
        place.is_none_or(|place| !left.contains(&place))
    });
    let options = Options {
        max_iterations: MOST_ITERATIONS,
        tolerance: TOLERANCE,
        derivatives: Derivatives::default(),
        ..problem.options.clone()
    };
    let (model, segments) = (problem.model.clone(), problem.segments.clone());
    let rest = Problem::new(model, segments, held, options);
    let Ok(descent) = descend(&rest, rest.unknowns.start(), &mut unobserved) else {
        return theta;
    };
    let mut theta = theta;
    for (place, value) in left.into_iter().zip(descent.last.theta) {
        theta[place] = value;
    }
    theta
}
