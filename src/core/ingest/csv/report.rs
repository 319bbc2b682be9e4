//! What is told about a table: what was left out or read under another name.

use crate::flight::{Fault, Finding, FindingCode};

use super::super::{
    note::{absent, listed, note},
    text::quoted,
};
use super::{column::Use, described::Described, plan::Plan};

/// What is odd about the columns.
pub(super) fn findings(
    described: &Described,
    plan: &Plan,
    left_out: &[(String, Fault)],
) -> Vec<Finding> {
    let mut findings = Vec::new();
    if let Some(name) = described.recognised {
        let message = format!("the titles are those of the bundled mapping '{name}': it was used");
        let remedy = "give a mapping of your own where it does not fit";
        findings.push(note(FindingCode::Recognised, message, remedy));
    }
    if !left_out.is_empty() {
        let why = |(title, fault): &(String, Fault)| {
            let why = fault
                .message
                .split_once(": ")
                .map_or(fault.message.as_str(), |(_, why)| why);
            let why = why.split(';').next().unwrap_or(why);
            format!("{title} ({why})")
        };
        let message = format!(
            "{} column(s) are left out: {}",
            left_out.len(),
            listed(left_out.iter().map(why))
        );
        let remedy = "write a mapping to have them; `trimtab inspect` prints a draft of it";
        let mut finding = note(FindingCode::LeftOut, message, remedy);
        finding.count = left_out.len();
        findings.push(finding);
    }
    let titles = &described.titles;
    let is_read = |at: usize| {
        plan.columns
            .iter()
            .any(|column| column.at == at && column.used == Use::Channel)
    };
    let others: Vec<String> = (0..titles.width)
        .filter(|&at| is_read(at) && titles.has_other_times(at))
        .map(|at| quoted(titles.title(at)))
        .collect();
    if !others.is_empty() {
        let message = format!(
            "{} has times, too, in fewer rows: the columns that belong to it are read at the times of the first",
            listed(others.into_iter())
        );
        let remedy =
            "say with a mapping which these are: alpha = {from = \"alpha\", time = \"t_air\"}";
        findings.push(note(FindingCode::OtherTimes, message, remedy));
    }
    if !plan.renamed.is_empty() {
        let pairs = plan
            .renamed
            .iter()
            .map(|(title, name)| format!("{} is {name}", quoted(title)));
        let message = format!(
            "{} title(s) are no names for equations: {}",
            plan.renamed.len(),
            listed(pairs)
        );
        findings.push(note(
            FindingCode::Renamed,
            message,
            "other names can be given in a mapping",
        ));
    }
    if !plan.without_unit.is_empty() {
        let message = format!(
            "no unit is said of {}: they are read as pure numbers, angles as radians",
            listed(plan.without_unit.iter().cloned())
        );
        let remedy = "say the unit in the header, as alpha[deg], or in a mapping; [-] is that of a pure number";
        findings.push(note(FindingCode::NoUnit, message, remedy));
    }
    findings.extend(absent(&plan.absent));
    findings
}
