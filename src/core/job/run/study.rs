//! A derivative study: the estimation as ever, and then the techniques compared on the same problem.

use std::ops::ControlFlow;

use super::finish::finish;
use super::fit;
use crate::estimate::study::{self, Clock, NoStudy, StudyStep};
use crate::estimate::{self, Outcome};
use crate::flight::Faults;
use crate::job::no_start::no_start;
use crate::job::plan::Plan;
use crate::job::result::JobResult;
use crate::stop;

/// What a study tells as it goes.
#[derive(Clone, Copy, Debug)]
pub enum StudyProgress<'a> {
    /// The estimation got on.
    Estimation(estimate::Progress<'a>),
    /// A result of the comparison.
    Finding(&'a StudyStep),
    /// Nothing new, but an occasion to stop it.
    Underway,
}

/// Runs a plan and compares the techniques; `observer` may stop it. What there is of an estimate is then kept.
///
/// # Errors
/// The start values lead nowhere. A finding that a strict job refuses.
pub fn run_study(
    plan: &Plan,
    clock: &dyn Clock,
    observer: &mut dyn FnMut(StudyProgress<'_>) -> ControlFlow<()>,
) -> Result<JobResult, Faults> {
    let mut result = fit(plan, &mut |progress| {
        observer(StudyProgress::Estimation(progress))
    })?;
    if result.estimate.outcome == Outcome::Cancelled {
        return finish(plan, result);
    }
    let mut listener = |step: Option<&StudyStep>| {
        observer(step.map_or(StudyProgress::Underway, StudyProgress::Finding))
    };
    match stop::droppable(|| study::study(&plan.problem, clock, &mut listener)) {
        Ok(Ok(study)) => result.study = Some(study),
        Ok(Err(NoStudy::Unusable(why))) => return Err(no_start(&plan.problem, why).into()),
        Ok(Err(NoStudy::Stopped)) | Err(_) => {
            result.estimate.outcome = Outcome::Cancelled;
            result.estimate.reason = format!(
                "the study was stopped on request; of the estimation: {}",
                result.estimate.reason
            );
        }
    }
    finish(plan, result)
}
