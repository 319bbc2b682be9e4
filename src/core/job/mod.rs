//! What a job is, without saying where it is kept or who runs it: its spec, its log of events, its
//! status, and the pure function from a spec and its data to a result.

mod bounds;
mod checks;
mod diagnosis;
mod event;
mod filter;
mod knowledge;
mod missing;
mod plausible;
mod prepare;
mod provenance;
mod resolve;
mod run;
mod spec;
mod status;
mod study;
mod unknown_name;

pub use crate::flight::Fault;
pub use checks::MOST_MANEUVERS;
pub use diagnosis::run_diagnosis;
pub use event::{Event, EventBody, Prepared};
pub use prepare::{Plan, prepare};
pub use provenance::Maker;
pub use run::{JobResult, run};
pub use spec::{
    Candidate, Gaps, HIGHEST_PRIORITY, JobKind, JobSpec, ManeuverUse, ModelSource,
    ParameterOverride,
};
pub use status::Status;
pub use study::{Progress, run_study};
