//! From a spec and its data to a result: pure, synchronous, deterministic.

use std::ops::ControlFlow;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::{Fault, JobSpec, Prepared};
use crate::estimate::{Estimate, Iteration, TimeHistory};
use crate::flight::Maneuver;
use crate::model::ModelDocument;

/// A job whose model is compiled and whose data are resolved: nothing left that bad input could break.
pub struct Plan {
    pub prepared: Prepared,
    /// The model as estimated: the declared one with the job's edits and parameter overrides in it.
    pub model: ModelDocument,
}

/// Everything a finished job answers.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct JobResult {
    pub estimate: Estimate,
    pub model: ModelDocument,
    pub histories: Vec<TimeHistory>,
}

/// Compiles the model, applies edits and overrides, makes inputs and outputs from recorded channels,
/// checks units. `maneuvers` are in the order of `spec.maneuvers`; `declared` is the spec's model, looked up.
///
/// # Errors
/// Every fault that would prevent the start, each with its JSON pointer into the spec.
pub fn prepare(
    spec: &JobSpec,
    declared: &ModelDocument,
    maneuvers: &[Arc<Maneuver>],
) -> Result<Plan, Vec<Fault>> {
    let _ = (spec, declared, maneuvers);
    Err(vec![Fault::new("", "not_built_yet", "stub")])
}

/// Runs a plan; `observer` is told of each iteration and may stop it.
pub fn run(plan: &Plan, observer: &mut dyn FnMut(&Iteration) -> ControlFlow<()>) -> JobResult {
    let _ = observer;
    unimplemented!("{}", plan.model.name)
}
