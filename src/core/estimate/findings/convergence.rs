//! Whether the numbers are an estimate at all, and whether a bound has made them.

use crate::estimate::report::estimate::Estimate;
use crate::estimate::report::iteration::Outcome;
use crate::flight::{Finding, FindingCode, Severity};

pub(super) fn findings(estimate: &Estimate, estimated: bool) -> Vec<Finding> {
    let mut findings = Vec::new();
    // what is reproduced to rounding has no lower cost to step to
    let is_exact = matches!(estimate.outcome, Outcome::Stalled | Outcome::Budget)
        && estimate.error_bounds.is_none();
    if estimated && estimate.outcome.is_short() && !is_exact {
        findings.push(not_converged(estimate));
    }
    let held = (estimate.parameters.iter()).filter(|row| row.at_bound.is_some());
    let names: Vec<&str> = held.map(|row| row.name.as_str()).collect();
    if !names.is_empty() {
        let message = format!(
            "held at a bound: {}; the data ask for a value beyond it, and their error bounds are left out",
            names.join(", ")
        );
        let remedy =
            "see whether the bound is meant; widen it with \"parameters\", or fix the parameter";
        findings.push(Finding::new(FindingCode::AtBound, message, remedy).of_parameters(names));
    }
    findings
}

fn not_converged(estimate: &Estimate) -> Finding {
    let message = format!(
        "these numbers are not an estimate yet, but the best that was reached before the solver stopped short of a minimum ({}): {}; their standard errors mean little",
        estimate.outcome.name(),
        estimate.reason
    );
    let remedy = match estimate.outcome {
        Outcome::Budget => {
            "give more \"max_iterations\", start values that are nearer, or fix what the data do not show"
        }
        Outcome::Cancelled => "run it again to its end",
        _ => "give other start values, or fix what the data do not show",
    };
    let finding = Finding::new(FindingCode::NotConverged, message, remedy);
    let free = (estimate.parameters.iter()).filter(|row| !row.fixed);
    let finding = finding.of_parameters(free.map(|row| row.name.as_str()));
    match estimate.outcome {
        // near the minimum, but for rounding or the shape of the cost: to be looked at, not to be thrown away
        Outcome::Stalled => finding.with_severity(Severity::Warning),
        _ => finding,
    }
}
