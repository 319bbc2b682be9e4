//! What a job is, without saying where it is kept or who runs it: its spec, its log of events, its
//! status, and the pure function from a spec and its data to a result.

mod event;
mod no_start;
mod plan;
mod prepare;
mod provenance;
mod result;
mod run;
mod spec;
mod status;

pub use crate::flight::Fault;
pub use event::{Event, EventBody, Prepared};
pub use plan::Plan;
pub use prepare::{MOST_MANEUVERS, prepare};
pub use provenance::Maker;
pub use result::JobResult;
pub use run::{StudyProgress, run, run_diagnosis, run_study};
pub use spec::{
    Candidate, Gaps, HIGHEST_PRIORITY, JobKind, JobSpec, ManeuverUse, ModelSource,
    ParameterOverride,
};
pub use status::Status;
