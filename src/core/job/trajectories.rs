//! Everything along the trajectory of a finished job: its plan is made once more, and simulated at its estimate.

use std::sync::Arc;

use super::plan::Plan;
use super::prepare::prepare;
use super::spec::{JobKind, JobSpec};
use crate::estimate::{Estimate, Trajectory, Unusable, trajectories};
use crate::flight::{Faults, Maneuver};
use crate::model::ModelDocument;

/// Why there is no trajectory.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum NoTrajectory {
    /// The states of a filter follow the measurements.
    #[error(
        "filter error follows the measurements: its states are those of a filter, not of the model alone; estimate by output error for a trajectory"
    )]
    Filter,
    /// A model with controls says what aerodynamics make of them.
    #[error(
        "the model has a control, {0}: it is no reconstruction from what sensors record of the motion alone, and what it says is no correction of a recording; /trajectories has it"
    )]
    NoReconstruction(String),
    /// The job is not what it was: another program made the result.
    #[error("the result has other parameters than this program makes of the job; run it again")]
    OtherParameters,
    /// The job can no longer be prepared.
    #[error("the job cannot be prepared again: {0}")]
    Unprepared(Faults),
    /// The estimate leads nowhere.
    #[error("at the estimate {0}")]
    Unusable(Unusable),
}

/// States, definitions and outputs along the segments that a plan was fitted to.
///
/// # Errors
/// The estimate is a filter's, or none of this plan, or the simulation leaves the range of numbers.
pub fn trajectories_of(plan: &Plan, estimate: &Estimate) -> Result<Vec<Trajectory>, NoTrajectory> {
    if estimate.filter.is_some() {
        return Err(NoTrajectory::Filter);
    }
    check_parameters(plan, estimate)?;
    trajectories(&plan.problem, estimate).map_err(NoTrajectory::Unusable)
}

/// Whether an estimate has the parameters of a plan, in its order.
///
/// # Errors
/// It has others: another program made it.
pub fn check_parameters(plan: &Plan, estimate: &Estimate) -> Result<(), NoTrajectory> {
    let problem = &plan.problem;
    let own = problem.unknowns.all.iter().map(|unknown| {
        let segment = unknown
            .segment
            .map(|segment| problem.segments[segment].label.as_str());
        (
            problem.model.parameters[unknown.parameter].name.as_str(),
            segment,
        )
    });
    let estimated = estimate
        .parameters
        .iter()
        .map(|row| (row.name.as_str(), row.segment.as_deref()));
    match own.eq(estimated) {
        true => Ok(()),
        false => Err(NoTrajectory::OtherParameters),
    }
}

/// The plan of a job of which spec, declared model, data and the model as estimated were kept.
///
/// # Errors
/// The job cannot be prepared again.
pub fn plan_again(
    spec: &JobSpec,
    declared: &ModelDocument,
    maneuvers: &[Arc<Maneuver>],
    estimated: &ModelDocument,
) -> Result<Plan, NoTrajectory> {
    let plan = match spec.kind {
        JobKind::Estimate | JobKind::DerivativeStudy => prepare(spec, declared, maneuvers),
        // the model of a diagnosis has its effects in it, and the job's own edits
        JobKind::Diagnose | JobKind::Structure => {
            let mut spec = spec.clone();
            spec.kind = JobKind::Estimate;
            spec.structure = None;
            spec.edits.clear();
            spec.parameters.clear();
            prepare(&spec, estimated, maneuvers)
        }
    };
    plan.map_err(NoTrajectory::Unprepared)
}
