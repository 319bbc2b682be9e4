//! What a job is, without saying where it is kept or who runs it: its spec, its log of events, its
//! status, and the pure function from a spec and its data to a result.
//!
//! Invariant: spec and data alone decide the result; all that bad input could break is found by [`prepare()`].

mod corrected;
mod event;
mod no_start;
mod one_call;
mod plan;
mod prepare;
mod provenance;
mod result;
mod run;
mod spec;
mod status;
mod strict;
mod term_search;
mod trajectories;

pub use crate::flight::{Fault, Faults};
pub use corrected::corrected;
pub use event::{Event, EventBody, Prepared};
pub use one_call::{diagnose, fit};
pub use plan::Plan;
pub use prepare::{MOST_MANEUVERS, prepare};
pub use provenance::Maker;
pub use result::JobResult;
pub use run::{StudyProgress, run, run_diagnosis, run_structure, run_study};
pub use spec::{
    Candidate, Gaps, HIGHEST_PRIORITY, JobKind, JobSpec, ManeuverUse, ModelSource,
    ParameterOverride,
};
pub use status::Status;
pub use strict::Strict;
pub use term_search::TermSearch;
pub use trajectories::{NoTrajectory, plan_again, trajectories_of};
