//! What a job is, without saying where it is kept or who runs it: its spec, its log of events, its
//! status, and the pure function from a spec and its data to a result.
//!
//! Invariant: spec and data alone decide the result; all that bad input could break is found by [`prepare()`].

mod campaign;
mod compare;
mod constant;
mod corrected;
mod event;
mod no_start;
mod one_call;
mod plan;
mod planned;
mod predicted;
mod prepare;
mod provenance;
mod result;
mod run;
mod simulation;
mod source_code;
mod spec;
mod status;
mod strict;
mod term_search;
mod tolerance;
mod trajectories;
mod trim;

pub use crate::flight::{Fault, Faults};
pub use campaign::{
    Campaign, CampaignCurve, CampaignPoint, CampaignQuestion, CampaignTerm, Flown, LeftOut,
    UsedRecording, campaign, channel_of, conditions_of, mean_over, part_in_use,
};
pub use compare::{ComparedJob, ComparedParameter, ComparedValue, Comparison, compare};
pub use constant::ConstantValue;
pub use corrected::{Corrected, corrected};
pub use event::{Event, EventBody, Prepared};
pub use one_call::{diagnose, fit};
pub use plan::Plan;
pub use planned::{NoDesign, PlannedDesign};
pub use predicted::{PredictedOutput, PredictedSegment, PredictionSpec, predicted};
pub use prepare::{MOST_MANEUVERS, prepare};
pub use provenance::Maker;
pub use result::JobResult;
pub use run::{StructureProgress, StudyProgress, run, run_diagnosis, run_structure, run_study};
pub use simulation::{NoSimulatedManeuver, SimulationSpec};
pub use source_code::{NoSourceCode, SimulatorFormat, simulator_model, source_code};
pub use spec::{
    Candidate, Gaps, HIGHEST_PRIORITY, JobKind, JobSpec, ManeuverUse, ModelSource,
    ParameterOverride,
};
pub use status::Status;
pub use strict::Strict;
pub use term_search::TermSearch;
pub use tolerance::{Tolerance, ToleranceHeld};
pub use trajectories::{NoTrajectory, check_parameters, plan_again, trajectories_of};
pub use trim::ModelTrimSpec;
