//! A diagnosis: the declared model fitted, and what it lacks.

use std::ops::ControlFlow;

use super::finish::finish;
use super::fit;
use crate::diagnose::{Inconclusive, Step, diagnose};
use crate::estimate::Outcome;
use crate::flight::{Fault, Faults};
use crate::job::no_start::no_start;
use crate::job::plan::Plan;
use crate::job::result::JobResult;
use crate::stop;

/// Runs the plan of a diagnosis; `watcher` is told of its steps and may stop it.
///
/// # Errors
/// The declared model cannot be fitted. A finding that a strict job refuses.
pub fn run_diagnosis(
    plan: &Plan,
    watcher: &mut dyn FnMut(Option<&Step>) -> ControlFlow<()>,
) -> Result<JobResult, Faults> {
    let Some(case) = &plan.case else {
        let message = "the job was not prepared as a diagnosis";
        return Err(Fault::new("/kind", "bad_option", message).into());
    };
    match stop::droppable(|| diagnose(case, watcher)).unwrap_or(Err(Inconclusive::Stopped)) {
        Ok(conclusion) => finish(
            plan,
            JobResult {
                estimate: conclusion.estimate,
                model: conclusion.diagnosis.model.clone(),
                histories: conclusion.histories,
                study: None,
                diagnosis: Some(conclusion.diagnosis),
                structure: None,
            },
        ),
        Err(Inconclusive::Unfit(why)) => {
            Err(Fault::new("/parameters", "diverged_at_start", why.to_string()).into())
        }
        Err(Inconclusive::NoStart(why)) => Err(no_start(&plan.problem, why).into()),
        // what there is so far is where the declared model starts from
        Err(Inconclusive::Stopped) => {
            let mut result = fit(plan, &mut |_| ControlFlow::Break(()))?;
            result.estimate.outcome = Outcome::Cancelled;
            result.estimate.reason = format!(
                "the diagnosis was stopped on request; of the declared model: {}",
                result.estimate.reason
            );
            finish(plan, result)
        }
    }
}
