//! What happens on the blocking thread: prepare, run, and make the result ready to be kept.

use std::ops::ControlFlow;
use std::sync::Arc;

use tokio::sync::mpsc;
use tokio::task::JoinError;

use super::clock::ThreadClock;
use super::stop::Stop;
use crate::estimate::Outcome;
use crate::flight::Maneuver;
use crate::job::{self, EventBody, Fault, JobKind, JobSpec, Progress};
use crate::model::ModelDocument;
use crate::store::{ResultParts, StoreError};

/// What a run that came to a result answers; `outcome` says of what kind.
pub struct Answer {
    pub outcome: Outcome,
    pub reason: String,
    pub parts: ResultParts,
}

/// Why a run came to no result.
#[derive(Debug)]
pub enum Unanswered {
    /// The job cannot be started.
    Refused(Vec<Fault>),
    Store(StoreError),
    /// The solver panicked, saying this.
    Panicked(String),
    /// The runtime was taken down under it.
    Dropped,
}

impl From<StoreError> for Unanswered {
    fn from(error: StoreError) -> Self {
        Self::Store(error)
    }
}

impl From<JoinError> for Unanswered {
    fn from(error: JoinError) -> Self {
        let Ok(panic) = error.try_into_panic() else {
            return Self::Dropped;
        };
        let text = panic.downcast_ref::<&str>().map(ToString::to_string);
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
        Self::Panicked(text.unwrap_or_else(|| "without a message".to_string()))
    }
}

/// Tells `log` of each step and stops between two iterations when asked. A full log slows the
/// solver down to the pace at which the store writes, so that memory stays bounded.
pub fn solve(
    spec: &JobSpec,
    model: &ModelDocument,
    maneuvers: &[Arc<Maneuver>],
    stop: &Stop,
    log: &mpsc::Sender<EventBody>,
) -> Result<Answer, Unanswered> {
    let plan = job::prepare(spec, model, maneuvers).map_err(Unanswered::Refused)?;
    // a log that nobody reads any more means that the job was abandoned: the observer stops then
    let _ = log.blocking_send(EventBody::Prepared(plan.prepared.clone()));
    let tell = |event: Option<EventBody>| {
        let is_lost = event.is_some_and(|event| log.blocking_send(event).is_err());
        if is_lost || stop.asked().is_some() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    };
    let result = match spec.kind {
        JobKind::Estimate => job::run(&plan, &mut |progress| tell(Some(progress.into()))),
        JobKind::DerivativeStudy => job::run_study(&plan, &ThreadClock::start(), &mut |progress| {
            tell(match progress {
                Progress::Estimation(progress) => Some(progress.into()),
                Progress::Finding(step) => Some(EventBody::Finding(step.clone())),
                Progress::Underway => None,
            })
        }),
        JobKind::Diagnose => job::run_diagnosis(&plan, &mut |step| {
            tell(Some(EventBody::Diagnosis(step.clone())))
        }),
    };
    let result = result.map_err(Unanswered::Refused)?;
    let parts = ResultParts::encode(&result)?;
    let (outcome, reason) = (result.estimate.outcome, result.estimate.reason);
    Ok(Answer {
        outcome,
        reason,
        parts,
    })
}
