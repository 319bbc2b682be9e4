//! Parameters that are free in maneuvers only that a job does not have.

use crate::flight::{Finding, FindingCode, escape};
use crate::model::ModelDocument;

/// `labels` are those of the maneuvers and of their parts.
pub(super) fn findings(document: &ModelDocument, labels: &[String]) -> Vec<Finding> {
    let free = document
        .parameters
        .iter()
        .filter(|(_, p)| !p.only_in.is_empty());
    let lost = free.filter(|(_, p)| !p.only_in.iter().any(|label| labels.contains(label)));
    let of = |(name, parameter): (&String, &crate::model::Parameter)| {
        let message = format!(
            "{name} is free in {} only, which this job does not have: it is zero in all maneuvers",
            parameter.only_in.join(", ")
        );
        let remedy = format!(
            "name maneuvers of this job in \"only_in\": it has {}",
            labels.join(", ")
        );
        let finding = Finding::new(FindingCode::Elsewhere, message, remedy);
        finding.at(format!("/model/parameters/{}/only_in", escape(name)))
    };
    lost.map(of).collect()
}
