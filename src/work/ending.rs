//! What the end of a run means for its job.

use super::solve::{Answer, Unanswered};
use super::stop::Reason;
use crate::estimate::Outcome;
use crate::job::{EventBody, Fault};
use crate::store::ResultParts;

/// Where a job is left.
pub(super) enum Settled {
    Ended(JobEnd),
    Released,
    Abandoned,
}

pub(super) struct JobEnd {
    /// What was told last and is not written yet: it is, together with the end.
    pub told: Told,
    pub event: EventBody,
    pub result: Option<ResultParts>,
}

impl JobEnd {
    pub(super) fn without_result(event: EventBody) -> Self {
        Self {
            told: Told::default(),
            event,
            result: None,
        }
    }
}

/// What the solver told, behind what is written.
#[derive(Default)]
pub(super) struct Told {
    /// How many events are written.
    pub before: usize,
    pub events: Vec<EventBody>,
}

impl Settled {
    /// The outcome of a job that came to a result; else its last event.
    pub(super) fn how(&self) -> String {
        match self {
            Self::Ended(JobEnd { event, .. }) => match event {
                EventBody::Succeeded { outcome, .. } => outcome.name().to_string(),
                event => event.name().to_string(),
            },
            Self::Released => "released".to_string(),
            Self::Abandoned => "abandoned".to_string(),
        }
    }
}

/// What the run's end means for the job.
pub(super) fn settle(
    answered: Result<Answer, Unanswered>,
    told: Told,
    asked: Option<Reason>,
) -> Settled {
    if asked == Some(Reason::LeaseLost) {
        return Settled::Abandoned;
    }
    let stopped = |answer: &Answer| answer.outcome == Outcome::Cancelled;
    let ending = match answered {
        Ok(answer) if stopped(&answer) && asked == Some(Reason::Shutdown) => {
            return Settled::Released;
        }
        Ok(answer) if stopped(&answer) => JobEnd {
            told,
            event: EventBody::Cancelled {
                has_result: true,
                findings: answer.findings,
            },
            result: Some(answer.parts),
        },
        // asked to stop or not: it finished before it noticed, and finished is finished
        Ok(Answer {
            outcome,
            reason,
            findings,
            parts,
        }) => JobEnd {
            told,
            event: EventBody::Succeeded {
                outcome,
                reason,
                findings,
            },
            result: Some(parts),
        },
        Err(Unanswered::Refused(faults)) => JobEnd {
            told,
            ..JobEnd::without_result(EventBody::Failed {
                faults: faults.into(),
            })
        },
        Err(Unanswered::Store(error)) => failed("store", &error),
        Err(Unanswered::Panicked(text)) => JobEnd {
            told,
            ..failed("solver", &text)
        },
        Err(Unanswered::Dropped) => return Settled::Released,
        Err(Unanswered::Interrupted) => match asked {
            Some(Reason::Shutdown) => return Settled::Released,
            Some(Reason::Budget) => JobEnd {
                told,
                ..JobEnd::without_result(out_of_time())
            },
            _ => JobEnd {
                told,
                ..JobEnd::without_result(EventBody::cancelled_without_result())
            },
        },
    };
    Settled::Ended(ending)
}

pub(super) fn failed(where_: &str, error: &dyn std::fmt::Display) -> JobEnd {
    tracing::error!(%error, "the {where_} failed");
    let message = format!(
        "the {where_} failed, which is a defect of the service and not of the job: {error}"
    );
    let faults = vec![Fault::new("", "internal", message)];
    JobEnd::without_result(EventBody::Failed { faults })
}

/// The end of a job that has taken as long as one may and has come to nothing.
fn out_of_time() -> EventBody {
    let message = "the job took as long as one may (--max-job-seconds) before there was anything to keep; fit fewer \
                   samples, or say with `start` where to begin";
    let faults = vec![Fault::new("", "budget", message)];
    EventBody::Failed { faults }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_job_without_a_result_ends_as_the_reason_for_which_it_was_stopped_says() {
        let end = |reason| settle(Err(Unanswered::Interrupted), Told::default(), reason).how();
        assert_eq!(end(Some(Reason::Cancel)), "cancelled");
        assert_eq!(end(Some(Reason::Shutdown)), "released");
        assert_eq!(end(Some(Reason::LeaseLost)), "abandoned");
        assert_eq!(end(Some(Reason::Budget)), "failed");
        let Settled::Ended(JobEnd { event, .. }) = settle(
            Err(Unanswered::Interrupted),
            Told::default(),
            Some(Reason::Budget),
        ) else {
            panic!("it is over");
        };
        let EventBody::Failed { faults } = event else {
            panic!("{event:?}")
        };
        assert_eq!(faults[0].code, "budget");
    }

    #[tokio::test]
    async fn a_panic_of_the_solver_is_an_end_of_the_job() {
        let solver = tokio::task::spawn_blocking(|| panic!("matrix of {} rows", 3));
        let answered = solver.await.map_err(Unanswered::from);
        let Settled::Ended(ending) = settle(answered, Told::default(), None) else {
            panic!("the job must be over");
        };
        let EventBody::Failed { faults } = ending.event else {
            panic!("{:?}", ending.event)
        };
        assert_eq!(faults[0].code, "internal");
        assert!(
            faults[0].message.contains("matrix of 3 rows"),
            "{}",
            faults[0].message
        );
    }
}
