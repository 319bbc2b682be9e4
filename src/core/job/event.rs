//! What happened to a job: an append-only, numbered log. Everything else is a reading of it.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::Fault;
use crate::diagnose::Step;
use crate::estimate::study::StudyStep;
use crate::estimate::{Iteration, Outcome, Progress, StartReport};
use crate::flight::{Finding, FindingTally};

/// One entry of a job's log. `seq` starts at 1 and has no holes.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Event {
    /// Its number in the job's log, from 1.
    #[schema(example = 7)]
    pub seq: u64,
    /// When it was recorded, RFC 3339.
    #[schema(example = "2026-11-21T12:00:00.123Z")]
    pub at: String,
    /// What happened.
    #[serde(flatten)]
    pub body: EventBody,
}

/// What can happen to a job, each with what there is to say of it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum EventBody {
    /// Accepted and stored; from here on the job is never lost.
    Queued,
    /// A worker has it; attempt 2 and later follow a lost or interrupted worker.
    Claimed {
        /// Which worker.
        worker: String,
        /// How often the job has been claimed, this time included.
        attempt: u32,
    },
    /// The worker gave it back unfinished (shutdown); it is queued again.
    Released {
        /// Why it was given back.
        reason: String,
    },
    /// Model compiled, channels resolved, units checked.
    Prepared(Prepared),
    /// The search for start values got on, or ended.
    Start(StartReport),
    /// The solver finished an iteration (number 0: the start value).
    Iteration(Iteration),
    /// A derivative study found something, or the work on confidence intervals got on.
    Finding(StudyStep),
    /// A diagnosis got on: a candidate was tried, refused or accepted.
    Diagnosis(Step),
    /// Somebody asked to cancel.
    CancelRequested,
    /// The solver ended and its result is stored; `outcome` says how good it is.
    Succeeded {
        /// How the solver ended.
        outcome: Outcome,
        /// Why it ended, in a sentence.
        reason: String,
        /// How many findings the result carries, and which.
        #[serde(default, skip_serializing_if = "FindingTally::is_empty")]
        findings: FindingTally,
    },
    /// No result: the faults say why.
    Failed {
        /// All of them; never none.
        faults: Vec<Fault>,
    },
    /// Ended on request; the best iterate is kept if there was one.
    Cancelled {
        /// Whether there is an iterate to look at.
        has_result: bool,
        /// How many findings that iterate carries, and which.
        #[serde(default, skip_serializing_if = "FindingTally::is_empty")]
        findings: FindingTally,
    },
}

/// What the job amounts to, said before the first iteration.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Prepared {
    /// Labels of the segments that are fitted.
    #[schema(example = json!(["elevator"]))]
    pub segments: Vec<String>,
    /// Segments that take no part in the estimation and are predicted with its result.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(example = json!(["doublet"]))]
    pub validation: Vec<String>,
    /// Samples over all segments of the estimation.
    pub samples: usize,
    /// Outputs of the model, in the document's order.
    pub outputs: Vec<String>,
    /// Free parameters, and with filter error the free process noises, in the order of the iterations' `parameters`.
    pub parameters: Vec<String>,
    /// What is odd about the data in use.
    pub findings: Vec<Finding>,
}

impl From<Progress<'_>> for EventBody {
    fn from(progress: Progress<'_>) -> Self {
        match progress {
            Progress::Start(report) => Self::Start(report.clone()),
            Progress::Iteration(iteration) => Self::Iteration(iteration.clone()),
            Progress::Step(step) => Self::Finding(step.clone()),
        }
    }
}

impl EventBody {
    /// The event's name on the wire (the `event:` line of a server-sent event).
    pub fn name(&self) -> &'static str {
        match self {
            Self::Queued => "queued",
            Self::Claimed { .. } => "claimed",
            Self::Released { .. } => "released",
            Self::Prepared(_) => "prepared",
            Self::Start(_) => "start",
            Self::Iteration(_) => "iteration",
            Self::Finding(_) => "finding",
            Self::Diagnosis(_) => "diagnosis",
            Self::CancelRequested => "cancel_requested",
            Self::Succeeded { .. } => "succeeded",
            Self::Failed { .. } => "failed",
            Self::Cancelled { .. } => "cancelled",
        }
    }

    /// The end of a job that was cancelled before there was anything to keep.
    pub fn cancelled_without_result() -> Self {
        Self::Cancelled {
            has_result: false,
            findings: FindingTally::default(),
        }
    }

    /// Whether nothing follows.
    pub fn is_last(&self) -> bool {
        matches!(
            self,
            Self::Succeeded { .. } | Self::Failed { .. } | Self::Cancelled { .. }
        )
    }
}
