//! Models that no simulation can follow, and what filter error finds instead.

use crate::estimate::filter_error::finer_steps::filter_error_in_steps;
use crate::estimate::options::estimator::Estimator;
use crate::estimate::options::technique::Derivatives;
use crate::estimate::problem::Problem;
use crate::estimate::report::estimate::Estimate;
use crate::estimate::report::iteration::Outcome;
use crate::estimate::report::progress::unobserved;
use crate::flight::{Finding, FindingCode, five_digits, with_error};
use crate::simulate::{Rates, StateMatrixAt, Steps};

/// Growth, as the exponent of e, that no simulation survives: an error of rounding is as large as what is simulated.
const HOPELESS: f64 = 30.0;
/// And growth that most do not.
const DOUBTFUL: f64 = 12.0;
/// R² below which a fit is not one that survived it.
const GOOD: f64 = 0.95;
/// Iterations of filter error that are spent on the offer.
const MOST_ITERATIONS: usize = 50;

/// With the start values the model grows so fast that no simulation follows it.
pub(super) fn finding(problem: &Problem, found: &Estimate) -> Option<Finding> {
    let by_simulation = problem.options.estimator == Estimator::OutputError;
    if !by_simulation || found.outcome == Outcome::Cancelled {
        return None;
    }
    let (theta, mut parameters) = (problem.unknowns.start(), Vec::new());
    let mut worst: Option<(f64, f64)> = None;
    for (index, segment) in problem.segments.iter().enumerate() {
        problem.unknowns.parameters(index, &theta, &mut parameters);
        let Rates { growth, .. } =
            StateMatrixAt::new(&problem.model, &parameters).rates_at_start(segment, &parameters);
        let duration = segment.duration();
        if worst.is_none_or(|(growth_before, before)| growth_before * before < growth * duration) {
            worst = Some((growth, duration));
        }
    }
    let (growth, duration) = worst?;
    let fits =
        found.outcome.is_minimum() && (found.outputs.iter()).all(|output| output.r_squared > GOOD);
    if growth * duration < DOUBTFUL || (fits && growth * duration < HOPELESS) {
        return None;
    }
    let message = format!(
        "the model is unstable with its start values ({:.3} 1/s, over {:.3} s): a simulation multiplies each error by e^{:.0}, so that output error cannot follow the motion, and its estimate may be that of another model{}",
        growth,
        duration,
        growth * duration,
        offer(problem).unwrap_or_default()
    );
    let remedy = "use the estimator \"filter_error\", which corrects the states at each sample";
    let finding = Finding::new(FindingCode::UnstableModel, message, remedy);
    Some(finding.at("/options/estimator"))
}

/// What filter error finds from the same start values.
fn offer(problem: &Problem) -> Option<String> {
    let even = |steps: &Steps| matches!(steps, Steps::Even(_));
    let possible = problem.model.paths.of_outputs().is_empty()
        && problem.segments.iter().all(|segment| even(&segment.steps));
    if !possible {
        return None;
    }
    let mut other = problem.clone();
    other.options.estimator = Estimator::FilterError;
    other.options.derivatives = Derivatives::default();
    other.options.max_iterations = other.options.max_iterations.min(MOST_ITERATIONS);
    let found = filter_error_in_steps(&other, &mut unobserved)
        .ok()?
        .estimate;
    if !found.outcome.is_minimum() {
        return Some(format!("; filter error ends {}", found.outcome.name()));
    }
    let rows = found.parameters.iter().filter(|row| !row.fixed);
    let told = rows.map(|row| {
        let value = match row.standard_error {
            Some(error) => with_error(row.estimate, error),
            None => five_digits(row.estimate),
        };
        format!("{} = {value}", row.name)
    });
    let told: Vec<String> = told.collect();
    Some(format!("; filter error finds {}", told.join(", ")))
}
