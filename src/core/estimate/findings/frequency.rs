//! What a band of frequencies does not show: inputs that move beside it, and what is not linear.

use crate::estimate::frequency::band_frequencies;
use crate::estimate::problem::Problem;
use crate::estimate::report::estimate::Estimate;
use crate::flight::{Finding, FindingCode};
use crate::spectral::{Between, FourierIntegral};

/// An input of whose power less than this share is in the band is hardly seen.
const LEAST_POWER: f64 = 0.02;

pub(super) fn findings(problem: &Problem, found: &Estimate) -> Vec<Finding> {
    let (Some(options), Some(_)) = (problem.options.frequency, &found.frequency) else {
        return Vec::new();
    };
    let mut findings = Vec::new();
    if !problem.model.is_linear() {
        let message = "the model is not linear in its states and inputs: what was compared are its small motions about the first sample of each maneuver";
        let remedy = "see that the motion is small, and the maneuver trimmed at its start; compare with the estimator \"output_error\"";
        let finding = Finding::new(FindingCode::Linearised, message, remedy);
        findings.push(finding.at("/options/estimator"));
    }
    let [from, to] = options.band_hz;
    for (input, quantity) in problem.model.inputs.iter().enumerate() {
        let (mut inside, mut all) = (0.0, 0.0);
        for segment in &problem.segments {
            let samples = &segment.inputs[input];
            let mean = samples.iter().sum::<f64>() / samples.len() as f64;
            let about: Vec<f64> = samples.iter().map(|u| u - mean).collect();
            let step = segment.steps.length(0);
            let band = band_frequencies(segment, &options).frequencies;
            let integral = FourierIntegral::new(samples.len(), step, band);
            // of both signs of the frequency (Parseval)
            let power: f64 = integral
                .of(&about, Between::Line)
                .iter()
                .map(|u| u.norm_sqr())
                .sum();
            inside += 2.0 * power * band.step;
            all += about.iter().map(|u| u * u).sum::<f64>() * step;
        }
        if all > 0.0 && inside < LEAST_POWER * all {
            let message = format!(
                "the input '{}' has {:.1e} of its power between {from} Hz and {to} Hz: what it does is hardly seen there",
                quantity.name,
                inside / all
            );
            let remedy = "choose a band in which the maneuver moves the aircraft";
            let finding = Finding::new(FindingCode::NoPowerInBand, message, remedy);
            findings.push(
                finding
                    .of_channel(&quantity.name)
                    .at("/options/frequency/band_hz"),
            );
        }
    }
    findings
}
