//! The problem of a prediction: an estimated model with the inputs of other recordings, and what they have of its outputs.

use std::sync::Arc;

use super::{bounds, checks, document, gaps, refuse_if_any, resolve, start};
use crate::estimate::{Estimate, Problem};
use crate::flight::{Fault, Faults, Maneuver};
use crate::job::spec::JobSpec;
use crate::model::{ModelDocument, Per, Start};

/// Meets the model, as it was estimated, with recordings of its inputs. An output that is not recorded has no measured
/// values; parameters that are shared are where the estimate has them, those of a maneuver at their start values.
///
/// # Errors
/// Every fault with its JSON pointer into the spec.
pub(in crate::job) fn prepare_prediction(
    spec: &JobSpec,
    estimated: &ModelDocument,
    estimate: &Estimate,
    maneuvers: &[Arc<Maneuver>],
) -> Result<Problem, Faults> {
    let (mut faults, mut findings) = (Vec::new(), Vec::new());
    let estimated = at_estimate(estimated, estimate);
    let document = document::edited(spec, &estimated, &mut faults);
    checks::check_shape(spec, maneuvers.len(), &mut faults);
    let model = document::compiled(&document, spec, &estimated, &mut faults)?;
    let stretches = gaps::stretches(spec, &model, maneuvers, &mut findings, &mut faults);
    bounds::check_data(&model, &stretches, &mut faults)?;
    let mut resolved = Vec::new();
    for (index, stretches) in stretches.iter().enumerate() {
        if stretches.len() > 1 {
            faults.push(begins_in_motion(index));
        }
        for stretch in stretches {
            let segment = resolve::to_predict(spec, &model, stretch, index, &mut faults);
            resolved.push((segment, stretch));
        }
    }
    refuse_if_any(faults)?;
    let unknowns = start::unknowns(spec, &model, &resolved)?;
    let unknowns = unknowns.with_held(|unknown| unknown.segment.is_some());
    let segments = resolved.into_iter().map(|(segment, _)| segment).collect();
    let problem = Problem::new(model, segments, unknowns, spec.options.clone());
    checks::check_stiffness(&problem)?;
    Ok(problem)
}

/// The document with shared parameters where the estimate has them.
fn at_estimate(document: &ModelDocument, estimate: &Estimate) -> ModelDocument {
    let mut document = document.clone();
    for row in estimate
        .parameters
        .iter()
        .filter(|row| row.segment.is_none())
    {
        if let Some(parameter) = document.parameters.get_mut(&row.name)
            && parameter.per == Per::Job
        {
            parameter.start = Start::Value(row.estimate);
            // a bound at which it is held holds to rounding
            parameter.lower = parameter.lower.map(|lower| lower.min(row.estimate));
            parameter.upper = parameter.upper.map(|upper| upper.max(row.estimate));
        }
    }
    document
}

fn begins_in_motion(index: usize) -> Fault {
    let message = "gaps cut the recording, and what is behind one begins in a motion that inputs alone do not tell; say \"gaps\": \"through\" or \"join\", or choose \"rows\"";
    Fault::new(
        format!("/maneuvers/{index}/gaps"),
        "gap_in_prediction",
        message,
    )
}
