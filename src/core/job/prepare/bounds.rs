//! Bounds on the size of a job: what would take memory or time without end is refused before it begins.

use std::collections::HashSet;

use super::stretch::Stretch;
use crate::estimate::{Derivatives, Noise, NoiseStructure, Options, Unknowns};
use crate::flight::Fault;
use crate::model::Model;
use crate::simulate::Segment;

/// Most values (samples times inputs, outputs and time) that a job is made of.
pub(super) const MOST_VALUES: usize = 50_000_000;
/// Most segments.
pub(super) const MOST_SEGMENTS: usize = 1_000;
/// Most free unknowns, those of each segment counted.
pub(super) const MOST_UNKNOWNS: usize = 1_000;
/// Most entries of normal equations, over all outputs or pairs of outputs.
const MOST_ENTRIES: usize = 50_000_000;

pub(super) const JOB_TOO_LARGE: &str = "job_too_large";

/// Checks what is to be made of the recordings, by maneuver and stretch. What is too much altogether is not looked into.
pub(super) fn check_data(
    model: &Model,
    stretches: &[Vec<Stretch<'_>>],
    faults: &mut Vec<Fault>,
) -> Result<(), Vec<Fault>> {
    let all = || stretches.iter().flatten();
    let segments = all().count();
    if segments > MOST_SEGMENTS {
        let message = format!(
            "gaps cut the recordings into {segments} segments, at most {MOST_SEGMENTS} are allowed; say \"gaps\": \"through\" or \"join\" with the maneuver, or upload it with even sampling"
        );
        faults.push(Fault::new("/maneuvers", JOB_TOO_LARGE, message));
    }
    let samples: usize = all().map(Stretch::len).sum();
    let values = samples * (1 + model.inputs.len() + model.outputs.len());
    if values > MOST_VALUES {
        let message = format!(
            "{samples} samples of {} inputs and {} outputs are {values} values, at most {MOST_VALUES} are allowed; choose \"rows\", or fewer maneuvers",
            model.inputs.len(),
            model.outputs.len()
        );
        faults.push(Fault::new("/maneuvers", JOB_TOO_LARGE, message));
    }
    let mut labels = HashSet::new();
    for (index, stretches) in stretches.iter().enumerate() {
        for stretch in stretches {
            if !labels.insert(stretch.label()) {
                let message = format!(
                    "there is another segment '{}' in this job; give the maneuver a \"label\" of its own",
                    stretch.label()
                );
                faults.push(Fault::new(
                    format!("/maneuvers/{index}/label"),
                    "duplicate_label",
                    message,
                ));
            }
            if stretch.len() < 2 {
                let message = format!(
                    "segment {} is a single sample (row {}) between gaps; leave it out with \"rows\", or say \"gaps\": \"join\" with the maneuver",
                    stretch.label(),
                    stretch.rows.start + 1
                );
                faults.push(Fault::new(
                    format!("/maneuvers/{index}"),
                    "too_few_samples",
                    message,
                ));
            }
        }
    }
    if faults.iter().any(|fault| fault.code == JOB_TOO_LARGE) {
        return Err(std::mem::take(faults));
    }
    Ok(())
}

/// Checks that there is something to estimate, that the data can carry it, and that it fits into memory.
pub(super) fn check_unknowns(
    model: &Model,
    segments: &[Segment],
    unknowns: &Unknowns,
    options: &Options,
) -> Result<(), Vec<Fault>> {
    let fault = |pointer: &str, code: &'static str, message: String| {
        Err(vec![Fault::new(pointer, code, message)])
    };
    let (count, outputs) = (unknowns.len(), model.outputs.len());
    if unknowns.is_empty() {
        let message = "all parameters are fixed: there is nothing to estimate; free one with \"fixed\": false";
        return fault("/parameters", "nothing_to_estimate", message.to_string());
    }
    let samples: usize = segments.iter().map(Segment::len).sum();
    let measured = |segment: &Segment| {
        let values = segment.measured.iter().flatten();
        values.filter(|z| !z.is_nan()).count()
    };
    let values: usize = segments.iter().map(measured).sum();
    let priors = (0..count).filter(|&place| unknowns.at(place).prior.is_some());
    if values + priors.count() <= count {
        let message = format!(
            "{values} measured values for {count} unknowns; more values than unknowns are needed"
        );
        return fault("/maneuvers", "too_few_samples", message);
    }
    let full = matches!(
        options.noise,
        Noise::Estimated {
            structure: NoiseStructure::Full
        }
    );
    if full && values <= count + outputs * outputs {
        let message = format!(
            "{samples} samples are too few for a full covariance of {outputs} outputs beside {count} unknowns; use the structure \"diagonal\""
        );
        return fault("/options/noise", "too_few_samples", message);
    }
    let pairs = if full {
        outputs * (outputs + 1) / 2
    } else {
        outputs
    };
    if count > MOST_UNKNOWNS || count * count * pairs > MOST_ENTRIES {
        let message = format!(
            "{count} unknowns over all segments and {outputs} outputs; at most {MOST_UNKNOWNS} unknowns, and {MOST_ENTRIES} for unknowns squared times {}, are allowed; fix parameters, or fit fewer maneuvers at a time",
            if full { "pairs of outputs" } else { "outputs" }
        );
        return fault("/parameters", JOB_TOO_LARGE, message);
    }
    let perturbs = !matches!(
        options.derivatives,
        Derivatives::ForwardSensitivities {} | Derivatives::Adjoint { .. }
    );
    let longest = segments.iter().map(Segment::len).max().unwrap_or(0);
    if perturbs && !model.paths.is_empty() && longest * outputs * count > MOST_ENTRIES {
        let message = format!(
            "{longest} samples of a segment, {outputs} outputs and {count} unknowns: where inputs or outputs have a play, rate limit, lag or delay, the technique \"{}\" keeps them all, at most {MOST_ENTRIES}; choose \"forward_sensitivities\"",
            options.derivatives.name()
        );
        return fault("/options/derivatives", JOB_TOO_LARGE, message);
    }
    Ok(())
}

/// Checks that a segment to be predicted can carry the unknowns of its own.
pub(super) fn check_validation(
    model: &Model,
    segment: &Segment,
    unknowns: &Unknowns,
) -> Result<(), Vec<Fault>> {
    let is_own = |place: &usize| unknowns.at(*place).segment.is_some();
    let count = (0..unknowns.len()).filter(is_own).count();
    let values = segment.len() * model.outputs.len();
    if values > count {
        return Ok(());
    }
    let message = format!(
        "segment {} has {values} measured values for its own {count} unknowns; more values than unknowns are needed",
        segment.label
    );
    Err(vec![Fault::new("/maneuvers", "too_few_samples", message)])
}
