//! An estimation or a diagnosis in one call, for a program that has the core as a library.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::plan::Plan;
use super::prepare::prepare;
use super::result::JobResult;
use super::run::{run, run_diagnosis};
use super::spec::{JobKind, JobSpec, ManeuverUse, ModelSource};
use crate::estimate::Role;
use crate::flight::{Faults, Maneuver};
use crate::model::ModelDocument;

/// Fits a model to maneuvers, to all of them together, with every option at its default.
///
/// # Errors
/// Every fault of the model and of the data that prevents the start, or why the start values lead nowhere.
pub fn fit(
    model: &ModelDocument,
    maneuvers: impl IntoIterator<Item = Maneuver>,
) -> Result<JobResult, Faults> {
    let fitted = maneuvers.into_iter();
    let fitted = fitted.map(|maneuver| (maneuver, Role::Estimation));
    let plan = plan(JobKind::Estimate, model, fitted)?;
    run(&plan, &mut |_| ControlFlow::Continue(()))
}

/// Finds what a model lacks: fits it to the maneuvers of the role `Estimation`, and judges what it finds by those of
/// the others. The result has a `diagnosis`.
///
/// # Errors
/// As [`fit`].
pub fn diagnose(
    model: &ModelDocument,
    maneuvers: impl IntoIterator<Item = (Maneuver, Role)>,
) -> Result<JobResult, Faults> {
    let plan = plan(JobKind::Diagnose, model, maneuvers)?;
    run_diagnosis(&plan, &mut |_| ControlFlow::Continue(()))
}

fn plan(
    kind: JobKind,
    model: &ModelDocument,
    maneuvers: impl IntoIterator<Item = (Maneuver, Role)>,
) -> Result<Plan, Faults> {
    let (maneuvers, roles): (Vec<_>, Vec<_>) = (maneuvers.into_iter())
        .map(|(maneuver, role)| (Arc::new(maneuver), role))
        .unzip();
    let uses = maneuvers.iter().zip(roles);
    let uses = uses.map(|(maneuver, role)| ManeuverUse::new(maneuver.digest(), role));
    let source = ModelSource::Document(Box::new(model.clone()));
    let spec = JobSpec::new(kind, source, uses.collect());
    prepare(&spec, model, &maneuvers)
}
