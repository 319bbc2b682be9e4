//! Which findings a job does not put up with.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::flight::{Fault, Finding, FindingCode};

/// Which warnings refuse a job: none, all, or those of some codes.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub enum Strict {
    /// `true`: a warning or fault of any code refuses the job; `false`: none does.
    All(bool),
    /// Findings of these codes refuse it, notes included.
    Codes(Vec<String>),
}

impl Default for Strict {
    fn default() -> Self {
        Self::All(false)
    }
}

impl Strict {
    /// Whether it is left out.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    fn refuses(&self, finding: &Finding) -> bool {
        match self {
            Self::All(all) => *all && finding.is_warning(),
            Self::Codes(codes) => codes.contains(&finding.code),
        }
    }

    /// The findings that refuse the job, as its faults; each keeps its code.
    pub(super) fn faults(&self, findings: &[Finding]) -> Vec<Fault> {
        let refused = findings.iter().filter(|finding| self.refuses(finding));
        let fault = |finding: &Finding| Fault {
            pointer: finding
                .pointer
                .clone()
                .unwrap_or_else(|| "/strict".to_string()),
            code: Cow::Owned(finding.code.clone()),
            message: format!("{} (the job is strict)", finding.sentence()),
        };
        refused.map(fault).collect()
    }

    /// Codes that there are not.
    pub(super) fn unknown(&self) -> Vec<Fault> {
        let Self::Codes(codes) = self else {
            return Vec::new();
        };
        let unknown = (codes.iter().enumerate())
            .filter(|(_, code)| FindingCode::find(code).is_none())
            .take(20);
        let fault = |(place, code): (usize, &String)| {
            let known: Vec<&str> = FindingCode::ALL.iter().map(|code| code.name()).collect();
            let code: String = code.chars().take(80).collect();
            let message = format!(
                "there is no finding of the code '{code}'; there are {}",
                known.join(", ")
            );
            Fault::new(format!("/strict/{place}"), "unknown_finding", message)
        };
        unknown.map(fault).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::Severity;

    #[test]
    fn all_means_warnings_and_a_code_means_notes_too() {
        let read = |text: &str| serde_json::from_str::<Strict>(text).unwrap();
        let gap = Finding::new(FindingCode::Gap, "a gap", "join").of_recording("1");
        let note = gap.clone().with_severity(Severity::Note);
        let both = [gap, note];
        assert_eq!(read("false").faults(&both), []);
        let [fault] = &read("true").faults(&both)[..] else {
            panic!("one");
        };
        assert_eq!((fault.pointer.as_str(), &*fault.code), ("/strict", "gap"));
        assert_eq!(fault.message, "1: a gap; join (the job is strict)");
        assert_eq!(read(r#"["gap"]"#).faults(&both).len(), 2);
        assert_eq!(read(r#"["spikes"]"#).faults(&both), []);
        assert_eq!(read(r#"["gap", "gab"]"#).unknown()[0].pointer, "/strict/1");
    }
}
