//! Constants of a catalog model that the job does not give: they are those of another aircraft, or none.

use crate::flight::{Finding, FindingCode, Severity};
use crate::job::spec::{JobSpec, ModelSource};
use crate::model::{Constant, ModelDocument, catalog};

/// The same on every aircraft.
const UNIVERSAL: [&str; 1] = ["g"];

pub(super) fn findings(spec: &JobSpec, declared: &ModelDocument) -> Vec<Finding> {
    let ModelSource::Reference(name) = &spec.model else {
        return Vec::new();
    };
    if catalog::find(name).is_none() {
        return Vec::new();
    }
    let given = |name: &str| {
        let of_each = spec.maneuvers.iter();
        spec.constants.contains_key(name)
            || of_each
                .map(|usage| &usage.constants)
                .all(|own| own.contains_key(name))
    };
    let assumed: Vec<(&String, &Constant)> = (declared.constants.iter())
        .filter(|(name, _)| !UNIVERSAL.contains(&name.as_str()) && !given(name))
        .collect();
    let (nothing, of_another): (Vec<_>, Vec<_>) = assumed
        .into_iter()
        .partition(|(_, constant)| constant.value == 0.0);
    let mut findings = Vec::new();
    if !of_another.is_empty() {
        let message = format!(
            "constants of the catalog model were taken as they stand there, for another aircraft: {}",
            listed(&of_another)
        );
        let remedy = format!(
            "give your aircraft's: \"constants\": {{\"{}\": ...}} (--constant {}=... on the command line)",
            of_another[0].0, of_another[0].0
        );
        let finding = Finding::new(FindingCode::AssumedConstants, message, remedy);
        findings.push(finding.at("/constants"));
    }
    if !nothing.is_empty() {
        let message = format!(
            "constants of the catalog model were taken as zero, as it has them: {}",
            listed(&nothing)
        );
        let remedy = "nothing, where they are zero; else give them under \"constants\"";
        let finding = Finding::new(FindingCode::AssumedConstants, message, remedy);
        findings.push(finding.with_severity(Severity::Note).at("/constants"));
    }
    findings
}

fn listed(constants: &[(&String, &Constant)]) -> String {
    let one = |(name, constant): &(&String, &Constant)| {
        let unit = match constant.unit.as_str() {
            "" | "-" => String::new(),
            unit => format!(" {unit}"),
        };
        format!("{name} = {}{unit}", constant.value)
    };
    let listed: Vec<String> = constants.iter().map(one).collect();
    listed.join(", ")
}
