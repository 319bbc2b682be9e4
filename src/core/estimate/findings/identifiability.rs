//! What the data cannot show, in words.

use crate::estimate::report::estimate::Estimate;
use crate::flight::{Finding, FindingCode};

pub(super) fn findings(estimate: &Estimate) -> Vec<Finding> {
    let mut findings = Vec::new();
    if estimate.error_bounds.is_none() {
        let message = "an output is reproduced to rounding, as data without noise are: error bounds would mean nothing and are left out";
        let remedy = "nothing, where the data are simulated without noise; else see whether an output repeats an input";
        findings.push(Finding::new(FindingCode::NoErrorBounds, message, remedy));
    }
    let identifiability = estimate.identifiability.as_ref();
    let Some(seen) = identifiability.map(|both| both.after.as_ref().unwrap_or(&both.before)) else {
        return findings;
    };
    for set in &seen.redundant {
        let message = format!("the data cannot tell apart: {}", set.parameters.join(" + "));
        let remedy = "fix one of them, or fly a maneuver that tells them apart";
        let finding = Finding::new(FindingCode::RedundantParameters, message, remedy);
        findings.push(finding.of_parameters(&set.parameters));
    }
    if !seen.unseen.is_empty() {
        let message = format!("the data cannot see: {}", seen.unseen.join(", "));
        let remedy = "fix them, or fly a maneuver that shows them";
        let finding = Finding::new(FindingCode::UnseenParameters, message, remedy);
        findings.push(finding.of_parameters(&seen.unseen));
    }
    for set in &seen.nearly_collinear {
        let message = format!(
            "nearly collinear: {} (condition index {:.0})",
            set.parameters.join(" + "),
            set.condition_index
        );
        let remedy = "their sum is known better than each; fix one of them, or fly a maneuver that tells them apart";
        let finding = Finding::new(FindingCode::NearlyCollinear, message, remedy);
        findings.push(finding.of_parameters(&set.parameters));
    }
    findings
}
