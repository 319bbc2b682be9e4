//! Findings as lines of the terminal, those that matter most first.

use crate::flight::Finding;

/// A finding in one line.
pub(super) fn line(finding: &Finding) -> String {
    let parameters = match finding.parameters.as_slice() {
        [] => String::new(),
        names => format!(" [{}]", names.join(", ")),
    };
    format!(
        "{}: {} ({}){parameters}",
        finding.severity.name(),
        finding.sentence(),
        finding.code
    )
}

/// A line for each.
pub(super) fn lines(findings: &[Finding]) -> Vec<String> {
    let mut sorted: Vec<&Finding> = findings.iter().collect();
    sorted.sort_by_key(|finding| std::cmp::Reverse(finding.severity));
    sorted.into_iter().map(line).collect()
}

/// Where no table shows them.
pub(super) fn say(findings: &[Finding]) {
    for line in lines(findings) {
        eprintln!("{line}");
    }
}
