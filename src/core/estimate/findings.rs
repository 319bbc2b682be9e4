//! What a reader of an estimate must be told: steps too long for a motion, and models that no simulation can follow.

use crate::estimate::answer::Solution;
use crate::estimate::filter_error::finer_steps::filter_error_in_steps;
use crate::estimate::options::estimator::Estimator;
use crate::estimate::options::steps::StepsPerSample;
use crate::estimate::options::technique::Derivatives;
use crate::estimate::problem::Problem;
use crate::estimate::report::estimate::Estimate;
use crate::estimate::report::iteration::Outcome;
use crate::estimate::report::progress::unobserved;
use crate::flight::{Finding, Severity, five_digits};
use crate::simulate::{Rates, StateMatrixAt, Steps};

/// A shift of an estimate by more, in standard errors, is a warning.
const SHIFT: f64 = 0.1;
/// |λ| h above which a motion is at the edge of what a step can integrate: the classical method is unstable above 2.8.
const EDGE: f64 = 2.0;
/// Growth, as the exponent of e, that no simulation survives: an error of rounding is as large as what is simulated.
const HOPELESS: f64 = 30.0;
/// And growth that most do not.
const DOUBTFUL: f64 = 12.0;
/// R² below which a fit is not one that survived it.
const GOOD: f64 = 0.95;
/// Iterations of filter error that are spent on the offer.
const MOST_ITERATIONS: usize = 50;

/// The findings of an estimate from a problem.
pub(super) fn findings(problem: &Problem, solution: &Solution) -> Vec<Finding> {
    if solution.estimate.outcome == Outcome::Cancelled {
        return Vec::new();
    }
    let found = &solution.estimate;
    let all = [
        step_too_long(problem, found),
        at_edge(found),
        unstable(problem, found),
    ];
    all.into_iter().flatten().collect()
}

fn warning(code: &str, message: String, remedy: String) -> Finding {
    Finding {
        code: code.to_string(),
        severity: Severity::Warning,
        channel: None,
        rows: Vec::new(),
        count: 0,
        message,
        remedy,
    }
}

/// Halving the steps would move a parameter.
fn step_too_long(problem: &Problem, found: &Estimate) -> Option<Finding> {
    let integration = found.integration.as_ref()?;
    let halved = integration
        .halved
        .as_ref()
        .filter(|halved| halved.most > SHIFT)?;
    let size = |shift: &Option<f64>| shift.map_or(0.0, f64::abs);
    let most = (0..halved.shifts.len())
        .max_by(|&a, &b| size(&halved.shifts[a]).total_cmp(&size(&halved.shifts[b])));
    let what = match most {
        Some(place) if place < problem.unknowns.len() => format!("'{}'", problem.name(place)),
        _ => "a parameter".to_string(),
    };
    let message = format!(
        "the integration steps are too long for the accuracy of the estimate: with half their length {what} would move by {} of its standard error (steps from one sample to the next: {})",
        five_digits(halved.most),
        integration.most_steps()
    );
    let remedy = match problem.options.steps_per_sample {
        StepsPerSample::Number(_) => "say \"steps_per_sample\": \"auto\", or a larger number",
        StepsPerSample::Auto(_) => {
            "use the integrator \"rk4\", say \"steps_per_sample\" with a larger number, or record at a higher rate"
        }
    };
    Some(warning("step_too_long", message, remedy.to_string()))
}

/// A motion is as fast as a step can integrate, or faster.
fn at_edge(found: &Estimate) -> Option<Finding> {
    let integration = found.integration.as_ref()?;
    if integration.fastest < EDGE {
        return None;
    }
    let message = format!(
        "the fastest motion of the estimate turns or decays by {:.2} within one integration step, at the edge of what a step can follow (2.8 with rk4): its parameters may be those of the integrator, not of the aircraft",
        integration.fastest
    );
    let remedy = "say \"steps_per_sample\" with a larger number; look whether the motion is real, and bound its parameters";
    Some(warning("mode_at_edge", message, remedy.to_string()))
}

/// With the start values the model grows so fast that no simulation follows it.
fn unstable(problem: &Problem, found: &Estimate) -> Option<Finding> {
    if problem.options.estimator != Estimator::OutputError {
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
    Some(warning("unstable_model", message, remedy.to_string()))
}

/// What filter error finds from the same start values.
fn offer(problem: &Problem) -> Option<String> {
    let even = |steps: &Steps| matches!(steps, Steps::Even(_));
    let possible = problem.model.delays.is_empty()
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
        let value = format!("{} = {}", row.name, five_digits(row.estimate));
        match row.standard_error {
            Some(error) => format!("{value} ± {}", five_digits(error)),
            None => value,
        }
    });
    let told: Vec<String> = told.collect();
    Some(format!("; filter error finds {}", told.join(", ")))
}
