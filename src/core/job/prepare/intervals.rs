//! What confidence intervals by refits ask for beyond an estimation.

use indexmap::IndexSet;

use super::bounds::JOB_TOO_LARGE;
use super::unknown_name::unknown_name;
use crate::estimate::study::operations;
use crate::estimate::{Derivatives, Estimator, IntervalOptions, Problem};
use crate::flight::Fault;
use crate::job::spec::{JobKind, JobSpec};

/// Most operations that all refits may take, some hours.
const MOST_OPERATIONS: f64 = 1e14;

/// Gradients of a refit from the estimate, and of both sides of a profile: what is usual.
const GRADIENTS: f64 = 3.0;
const GRADIENTS_OF_PROFILE: f64 = 30.0;

/// Checks the options against the kind of job and the estimator.
pub(super) fn check_options(spec: &JobSpec, faults: &mut Vec<Fault>) {
    let Some(options) = &spec.options.confidence_intervals else {
        return;
    };
    let mut refuse = |pointer: &str, message: &str| {
        faults.push(Fault::new(pointer, "bad_option", message));
    };
    if spec.kind != JobKind::Estimate {
        let message = "confidence intervals are found by estimations; say \"kind\": \"estimate\", or leave this out";
        refuse("/options/confidence_intervals", message);
    }
    if spec.options.estimator != Estimator::OutputError {
        let message = "confidence intervals are found by refits with output error; choose the estimator \"output_error\", or leave this out";
        refuse("/options/confidence_intervals", message);
    }
    if let Some((field, message)) = options.fault() {
        refuse(&format!("/options/confidence_intervals/{field}"), &message);
    }
}

/// Checks names of parameters, and how long refits will take.
pub(super) fn check(problem: &Problem) -> Result<(), Vec<Fault>> {
    let Some(options) = &problem.options.confidence_intervals else {
        return Ok(());
    };
    let mut faults = Vec::new();
    let free: IndexSet<&str> = (0..problem.unknowns.len())
        .map(|place| problem.parameter(place).name.as_str())
        .collect();
    for name in &options.parameters {
        if !free.contains(name.as_str()) {
            let pointer = "/options/confidence_intervals/parameters";
            let (what, free) = (("free parameter", name.as_str()), free.iter().copied());
            unknown_name(pointer, "unknown_parameter", what, free, &mut faults);
        }
    }
    let all = gradients(options, problem) * operations(problem, &Derivatives::default()) as f64;
    if all > MOST_OPERATIONS {
        let message = format!(
            "refits take {all:.0e} operations here, at most {MOST_OPERATIONS:.0e} are allowed; ask for fewer, choose \"parameters\" to be profiled, or \"rows\""
        );
        let pointer = "/options/confidence_intervals";
        faults.push(Fault::new(pointer, JOB_TOO_LARGE, message));
    }
    if faults.is_empty() {
        Ok(())
    } else {
        Err(faults)
    }
}

fn gradients(options: &IntervalOptions, problem: &Problem) -> f64 {
    let is_wanted = |place: &usize| {
        let names = &options.parameters;
        names.is_empty() || names.contains(&problem.parameter(*place).name)
    };
    let profiled = match options.profile {
        true => (0..problem.unknowns.len()).filter(is_wanted).count(),
        false => 0,
    };
    let refits = (options.bootstrap + options.monte_carlo) as f64;
    GRADIENTS * refits + GRADIENTS_OF_PROFILE * profiled as f64
}
