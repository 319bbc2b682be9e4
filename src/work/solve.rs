//! What happens on the blocking thread: prepare, run, and make the result ready to be kept.

use std::ops::ControlFlow;
use std::sync::Arc;

use tokio::sync::mpsc;
use tokio::task::JoinError;

use super::clock::ThreadClock;
use super::maker::this_program;
use super::stop::{Reason, Stop};
use crate::estimate::{Estimate, Outcome};
use crate::flight::{FindingTally, Maneuver};
use crate::job::{self, EventBody, Faults, JobKind, JobSpec, StructureProgress, StudyProgress};
use crate::model::ModelDocument;
use crate::stop::Interrupted;
use crate::store::{ResultParts, StoreError};

/// What a run that came to a result answers; `outcome` says of what kind.
pub(super) struct Answer {
    pub outcome: Outcome,
    pub reason: String,
    pub findings: FindingTally,
    pub parts: ResultParts,
}

/// Why a run came to no result.
#[derive(Debug)]
pub(super) enum Unanswered {
    /// The job cannot be started.
    Refused(Faults),
    Store(StoreError),
    /// The solver panicked, saying this.
    Panicked(String),
    /// The runtime was taken down under it.
    Dropped,
    /// It was stopped before there was anything to keep.
    Interrupted,
}

impl From<Interrupted> for Unanswered {
    fn from(_: Interrupted) -> Self {
        Self::Interrupted
    }
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

/// Tells `log` of each step and stops when asked, with what there is of a result or without. A full log slows the
/// solver down to the pace at which the store writes, so that memory stays bounded.
pub(super) fn solve(
    spec: &JobSpec,
    model: &ModelDocument,
    maneuvers: &[Arc<Maneuver>],
    stop: &Stop,
    log: &mpsc::Sender<EventBody>,
) -> Result<Answer, Unanswered> {
    stop.flag()
        .heed(|| answer(spec, model, maneuvers, stop, log))?
}

fn answer(
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
        JobKind::Structure => job::run_structure(&plan, &mut |progress| {
            tell(match progress {
                StructureProgress::Estimation(progress) => Some(progress.into()),
                StructureProgress::Underway => None,
            })
        }),
        JobKind::DerivativeStudy => job::run_study(&plan, &ThreadClock::start(), &mut |progress| {
            tell(match progress {
                StudyProgress::Estimation(progress) => Some(progress.into()),
                StudyProgress::Finding(step) => Some(EventBody::Finding(step.clone())),
                StudyProgress::Underway => None,
            })
        }),
        JobKind::Diagnose => job::run_diagnosis(&plan, &mut |step| {
            tell(step.map(|step| EventBody::Diagnosis(step.clone())))
        }),
    };
    let mut result = result.map_err(Unanswered::Refused)?;
    if stop.asked() == Some(Reason::Budget) {
        out_of_time(&mut result.estimate);
    }
    let parts = ResultParts::encode(&result, this_program())?;
    let outcome = result.estimate.outcome;
    let findings = FindingTally::of(&result.estimate.findings);
    // what a diagnosis comes to is more than that its last fit ended well
    let reason = match result.diagnosis {
        Some(diagnosis) => diagnosis.headline(),
        None => result.estimate.reason,
    };
    Ok(Answer {
        outcome,
        reason,
        findings,
        parts,
    })
}

/// What was not cancelled by anybody, but has taken as long as a job may.
fn out_of_time(estimate: &mut Estimate) {
    if estimate.outcome == Outcome::Cancelled {
        estimate.outcome = Outcome::Budget;
        estimate.reason = format!(
            "the job has taken as long as one may (--max-job-seconds); {}",
            estimate.reason
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Model, catalog};
    use crate::simulate::Scenario;

    /// Events that come when the wish to stop is known once so many iterations have been told of, and the outcome.
    fn stopped_after(iterations: usize) -> (Vec<EventBody>, Outcome) {
        let model = catalog::find("short-period").unwrap();
        let scenario: Scenario = toml::from_str(include_str!("../../data/elevator.toml")).unwrap();
        let maneuver = Arc::new(scenario.fly(&Model::compile(&model).unwrap()).unwrap());
        let spec: JobSpec = serde_json::from_value(serde_json::json!({
            "model": "short-period",
            "maneuvers": [{"id": "elevator"}],
            "options": {"tolerance": 1e-300, "max_iterations": 1000},
        }))
        .unwrap();
        let stop = Stop::default();
        // a log that holds one event: the solver is never further ahead than that
        let (log, mut events) = mpsc::channel(1);
        std::thread::scope(|scope| {
            let solver = scope.spawn({
                let stop = &stop;
                let spec = &spec;
                let model = &model;
                move || solve(spec, model, &[maneuver], stop, &log).unwrap().outcome
            });
            let mut told = Vec::new();
            let is_iteration = |event: &&EventBody| matches!(event, EventBody::Iteration(_));
            while told.iter().filter(is_iteration).count() < iterations {
                told.push(events.blocking_recv().expect("it runs"));
            }
            stop.ask(Reason::Cancel);
            let mut behind = Vec::new();
            while let Some(event) = events.blocking_recv() {
                behind.push(event);
            }
            (behind, solver.join().unwrap())
        })
    }

    #[test]
    fn a_solver_stops_at_the_iteration_after_it_is_asked() {
        for iterations in 1..=4 {
            let (behind, outcome) = stopped_after(iterations);
            assert_eq!(outcome, Outcome::Cancelled);
            // one that was in the log and one that was on its way there
            assert!(behind.len() <= 2, "{behind:?}");
        }
    }
}
