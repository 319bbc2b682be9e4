//! What is told about a table: what was left out or read under another name.

use crate::flight::{Fault, Finding, FindingCode};

use super::super::{
    note::{self, absent, listed, note},
    text::quoted,
};
use super::{column::Use, described::Described, plan::Plan, time::Time};

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
    if matches!(plan.time, Time::Week { .. }) {
        let message = "time is that of the satellites: week and seconds of it, which are ahead of UTC by the leap seconds (18 s since 2017); it is left as it is";
        let remedy = "nothing needs to be done within one recording; what another clock recorded beside it has an offset, which a mapping can say";
        findings.push(note(FindingCode::Recognised, message.to_string(), remedy));
    }
    if let Time::Even { step, .. } = plan.time
        && described.mapping.time.step.is_none()
        && let Some(stated) = described.titles.stated
    {
        let message = format!(
            "no column has times: samples are {step} s apart, as line {} says",
            stated.line
        );
        let remedy =
            "give the step in a mapping where it is another: time = {step = 0.02, unit = \"s\"}";
        findings.push(note(FindingCode::Recognised, message, remedy));
    }
    let why = |(title, fault): &(String, Fault)| {
        let why = fault.message.split_once(": ");
        let why = why.map_or(fault.message.as_str(), |(_, why)| why);
        (title.clone(), why.to_string())
    };
    let left_out: Vec<_> = left_out.iter().map(why).collect();
    let remedy = "write a mapping to have them; `trimtab inspect` prints a draft of it";
    findings.extend(note::left_out(&left_out, remedy));
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
    findings.extend(note::renamed(&plan.renamed));
    findings.extend(note::without_unit(&plan.without_unit));
    findings.extend(absent(&plan.absent));
    findings
}
