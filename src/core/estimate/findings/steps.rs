//! Integration steps that are too long for what was estimated.

use crate::estimate::options::steps::StepsPerSample;
use crate::estimate::problem::Problem;
use crate::estimate::report::estimate::Estimate;
use crate::flight::{Finding, FindingCode, five_digits};

/// A shift of an estimate by more, in standard errors, is a warning.
const SHIFT: f64 = 0.1;
/// |λ| h above which a motion is at the edge of what a step can integrate: the classical method is unstable above 2.8.
const EDGE: f64 = 2.0;

pub(super) fn findings(problem: &Problem, found: &Estimate) -> Vec<Finding> {
    let all = [too_long(problem, found), at_edge(found)];
    all.into_iter().flatten().collect()
}

/// Halving the steps would move a parameter.
fn too_long(problem: &Problem, found: &Estimate) -> Option<Finding> {
    let integration = found.integration.as_ref()?;
    let halved = integration
        .halved
        .as_ref()
        .filter(|halved| halved.most > SHIFT)?;
    let size = |shift: &Option<f64>| shift.map_or(0.0, f64::abs);
    let most = (0..halved.shifts.len())
        .max_by(|&a, &b| size(&halved.shifts[a]).total_cmp(&size(&halved.shifts[b])));
    let name = most
        .filter(|&place| place < problem.unknowns.len())
        .map(|place| problem.name(place));
    let what = (name.as_ref()).map_or("a parameter".to_string(), |name| format!("'{name}'"));
    let message = format!(
        "the integration steps are too long for the accuracy of the estimate: with half their length {what} would move by {} of its standard error (steps from one sample to the next: {})",
        five_digits(halved.most),
        integration.most_steps()
    );
    let remedy = match problem.options.steps_per_sample {
        StepsPerSample::Number(_) => {
            "say \"steps_per_sample\" with a larger number, or, in an estimation, \"auto\""
        }
        StepsPerSample::Auto(_) => {
            "use the integrator \"rk4\", say \"steps_per_sample\" with a larger number, or record at a higher rate"
        }
    };
    let finding = Finding::new(FindingCode::StepTooLong, message, remedy);
    Some(finding.of_parameters(name).at("/options/steps_per_sample"))
}

/// A motion is as fast as a step can integrate, or faster.
fn at_edge(found: &Estimate) -> Option<Finding> {
    let integration = found.integration.as_ref()?;
    if integration.fastest < EDGE {
        return None;
    }
    let message = format!(
        "the fastest motion of the estimate turns or decays by {:.2} within one integration step, at the edge of what a step can follow (2.8 with rk4): its parameters may be those of the integrator, not of the aircraft",
        integration.fastest
    );
    let remedy = "say \"steps_per_sample\" with a larger number; look whether the motion is real, and bound its parameters";
    let finding = Finding::new(FindingCode::ModeAtEdge, message, remedy);
    Some(finding.at("/options/steps_per_sample"))
}
