//! A derivative study: the estimation as ever, and then the techniques compared on the same problem.

use std::ops::ControlFlow;

use super::Fault;
use super::prepare::Plan;
use super::run::{JobResult, no_start, run};
use crate::estimate::study::{self, Clock, NoStudy, StudyStep};
use crate::estimate::{self, Derivatives, Outcome, Problem};

/// What a study tells as it goes.
#[derive(Clone, Copy, Debug)]
pub enum Progress<'a> {
    Estimation(estimate::Progress<'a>),
    Finding(&'a StudyStep),
    /// Nothing new, but an occasion to stop it.
    Underway,
}

/// Runs a plan and compares the techniques; `observer` may stop it. What there is of an estimate is then kept.
///
/// # Errors
/// The start values lead nowhere.
pub fn run_study(
    plan: &Plan,
    clock: &dyn Clock,
    observer: &mut dyn FnMut(Progress<'_>) -> ControlFlow<()>,
) -> Result<JobResult, Vec<Fault>> {
    let mut result = run(plan, &mut |progress| {
        observer(Progress::Estimation(progress))
    })?;
    if result.estimate.outcome == Outcome::Cancelled {
        return Ok(result);
    }
    let mut listener =
        |step: Option<&StudyStep>| observer(step.map_or(Progress::Underway, Progress::Finding));
    match study::study(&plan.problem, clock, &mut listener) {
        Ok(study) => result.study = Some(study),
        Err(NoStudy::Unusable(why)) => return Err(vec![no_start(&plan.problem, why)]),
        Err(NoStudy::Stopped) => {
            result.estimate.outcome = Outcome::Cancelled;
            result.estimate.reason = format!(
                "the study was stopped on request; of the estimation: {}",
                result.estimate.reason
            );
        }
    }
    Ok(result)
}

/// A study simulates very often: only what simulates fast is let in.
pub(super) fn check(problem: &Problem) -> Result<(), Vec<Fault>> {
    if !problem.model.delays.is_empty() {
        let message = "only the technique \"forward_sensitivities\" knows delays, so there is nothing to compare; leave the delays out of the model";
        return Err(vec![Fault::new("/model", "bad_option", message)]);
    }
    let central = Derivatives::CentralDifference { step: 1e-6 };
    let operations = study::operations(problem, &central);
    if operations <= study::MOST_OPERATIONS {
        return Ok(());
    }
    let message = format!(
        "a gradient by central differences takes {operations:e} operations here, at most {:e} are allowed for a study; choose \"rows\", or fix parameters",
        study::MOST_OPERATIONS
    );
    Err(vec![Fault::new(
        "/kind",
        super::bounds::JOB_TOO_LARGE,
        message,
    )])
}
