//! Samples at which an output has no value: they do not count, and the job's log says how many they are.

use crate::estimate::{Noise, NoiseStructure, Options, Unknowns};
use crate::flight::{Fault, Finding, FindingCode, Severity};
use crate::model::{Jacobian, Model};
use crate::simulate::Segment;

/// What is missing of each output, in words; with a fault where the outputs' noise is to be correlated and a
/// sample has values of some outputs only.
pub(super) fn check_samples(
    model: &Model,
    segments: &[Segment],
    options: &Options,
    findings: &mut Vec<Finding>,
    faults: &mut Vec<Fault>,
) {
    let samples: usize = segments.iter().map(Segment::len).sum();
    let mut incomplete = Vec::new();
    for (i, output) in model.outputs.iter().enumerate() {
        let missing = |segment: &Segment| segment.measured[i].iter().filter(|z| z.is_nan()).count();
        let count: usize = segments.iter().map(missing).sum();
        if count == 0 {
            continue;
        }
        incomplete.push(output.name.as_str());
        let concerned: Vec<&str> = segments
            .iter()
            .filter(|segment| missing(segment) > 0)
            .map(|segment| segment.label.as_str())
            .collect();
        let message = format!(
            "the output '{}' has no value in {count} of {samples} samples (in {}); they do not count for it, the other {} do",
            output.name,
            listed(&concerned),
            samples - count
        );
        let remedy = "nothing, where the channel is recorded at a lower rate; else see what the recording's findings say of it";
        let missing = Finding::new(FindingCode::MissingValues, message, remedy);
        let missing = missing
            .with_severity(Severity::Note)
            .of_channel(&output.name);
        findings.push(Finding { count, ..missing });
    }
    let full = matches!(
        options.noise,
        Noise::Estimated {
            structure: NoiseStructure::Full
        }
    );
    if full && !incomplete.is_empty() && segments.iter().any(is_patchy) {
        let message = format!(
            "a full covariance of the noise needs values of all outputs at the same samples, and {} lack(s) some; use the structure \"diagonal\", give the variances (\"kind\": \"given\"), or choose \"rows\" without them",
            incomplete.join(", ")
        );
        faults.push(Fault::new("/options/noise", "missing_values", message));
    }
}

/// Whether some sample has values of some outputs only.
fn is_patchy(segment: &Segment) -> bool {
    (0..segment.len()).any(|k| {
        let missing = segment.measured.iter().filter(|z| z[k].is_nan()).count();
        missing > 0 && missing < segment.measured.len()
    })
}

fn listed(labels: &[&str]) -> String {
    const MOST: usize = 5;
    let shown = labels[..labels.len().min(MOST)].join(", ");
    match labels.len() {
        0..=MOST => format!("segment {shown}"),
        more => format!("segments {shown} and {} more", more - MOST),
    }
}

/// Outputs with no samples, or with too few for what only they can tell: a fault for each.
pub(super) fn check_counts(
    model: &Model,
    segments: &[Segment],
    unknowns: &Unknowns,
    options: &Options,
) -> Vec<Fault> {
    let estimated = matches!(options.noise, Noise::Estimated { .. });
    let fault = |(i, output): (usize, &crate::model::Quantity)| {
        let values = segments.iter().flat_map(|segment| &segment.measured[i]);
        let count = values.filter(|z| !z.is_nan()).count();
        // where the variance is estimated, an output that could be fitted perfectly would have none
        let needed = if estimated {
            2 + unknowns
                .free
                .iter()
                .filter(|&&u| only_in(model, unknowns.all[u].parameter, i))
                .count()
        } else {
            1
        };
        (count < needed).then(|| {
            let message = format!(
                "the output '{}' has {count} value(s), at least {needed} are needed; choose other \"rows\", say with \"channels\" how to make it, or leave it out of the model",
                output.name
            );
            Fault::new("/maneuvers", "too_few_samples", message)
        })
    };
    model.outputs.iter().enumerate().filter_map(fault).collect()
}

/// Whether nothing but the equation or the path of this output contains the parameter.
fn only_in(model: &Model, parameter: usize, output: usize) -> bool {
    let has = |jacobian: &Jacobian| jacobian.by_parameter.iter().any(|&(_, p)| p == parameter);
    let seen_by = |output: usize| {
        let entry = (output, parameter);
        model.observation_jacobian.by_parameter.contains(&entry)
            || model.paths.output_depends_on(output, parameter)
    };
    !has(&model.dynamics_jacobian)
        && !has(&model.initial_jacobian)
        && (0..model.outputs.len()).all(|other| seen_by(other) == (other == output))
}
