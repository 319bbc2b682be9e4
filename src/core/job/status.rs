//! Status: a reading of the log.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::event::EventBody;

/// Where a job stands.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Waiting for a worker.
    Queued,
    /// A worker has it.
    Running,
    /// Running, and asked to stop.
    Cancelling,
    /// The solver ended and there is a result.
    Succeeded,
    /// There is no result, and faults that say why.
    Failed,
    /// Ended on request; the best iterate is kept if there was one.
    Cancelled,
}

impl Status {
    /// All of them, in the order of a job's life.
    pub const ALL: [Self; 6] = [
        Self::Queued,
        Self::Running,
        Self::Cancelling,
        Self::Succeeded,
        Self::Failed,
        Self::Cancelled,
    ];

    /// Status after `event`, given the status before it (`None` before the first).
    pub fn after(before: Option<Self>, event: &EventBody) -> Self {
        match (event, before) {
            (EventBody::Queued, _) => Self::Queued,
            (EventBody::Claimed { .. }, Some(Self::Cancelling)) => Self::Cancelling,
            (EventBody::Claimed { .. }, _) => Self::Running,
            // what was asked to stop stays asked, whoever takes it over
            (EventBody::Released { .. }, Some(Self::Cancelling)) => Self::Cancelling,
            (EventBody::Released { .. }, _) => Self::Queued,
            (EventBody::CancelRequested, _) => Self::Cancelling,
            (EventBody::Succeeded { .. }, _) => Self::Succeeded,
            (EventBody::Failed { .. }, _) => Self::Failed,
            (EventBody::Cancelled { .. }, _) => Self::Cancelled,
            (
                EventBody::Prepared(_)
                | EventBody::Start(_)
                | EventBody::Iteration(_)
                | EventBody::Finding(_)
                | EventBody::Diagnosis(_),
                before,
            ) => before.unwrap_or(Self::Running),
        }
    }

    /// Whether it never changes again.
    pub fn is_over(self) -> bool {
        matches!(self, Self::Succeeded | Self::Failed | Self::Cancelled)
    }

    /// As it is written in answers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Queued => "queued",
            Self::Running => "running",
            Self::Cancelling => "cancelling",
            Self::Succeeded => "succeeded",
            Self::Failed => "failed",
            Self::Cancelled => "cancelled",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn status_is_a_fold_of_the_log() {
        let claimed = |attempt| EventBody::Claimed {
            worker: "w".into(),
            attempt,
        };
        let released = EventBody::Released {
            reason: "shutdown".into(),
        };
        let fold = |events: &[EventBody]| {
            events
                .iter()
                .fold(None, |status, e| Some(Status::after(status, e)))
        };
        assert_eq!(fold(&[]), None);
        assert_eq!(fold(&[EventBody::Queued]), Some(Status::Queued));
        assert_eq!(
            fold(&[EventBody::Queued, claimed(1), released.clone()]),
            Some(Status::Queued)
        );
        let asked = [
            EventBody::Queued,
            claimed(1),
            EventBody::CancelRequested,
            released,
            claimed(2),
        ];
        assert_eq!(fold(&asked), Some(Status::Cancelling));
        let over = [
            EventBody::Queued,
            claimed(1),
            EventBody::Cancelled { has_result: true },
        ];
        assert!(fold(&over).unwrap().is_over());
    }
}
