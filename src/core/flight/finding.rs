//! A finding: what is odd about data, a job or its result, where, and what can be done about it.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::finding_code::FindingCode;
use super::severity::Severity;

/// Something that a reader of the numbers should know: of a recording, of a job's use of it, or of a fit.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Finding {
    /// A stable word; the table of all is part of the documentation.
    #[schema(example = "gap")]
    pub code: String,
    /// Whether it changes results.
    pub severity: Severity,
    /// In a job: the label of the maneuver or segment concerned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "elevator")]
    pub recording: Option<String>,
    /// The channel concerned; absent where it is the time axis, or none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "alpha")]
    pub channel: Option<String>,
    /// The parameters concerned.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(example = json!(["Za"]))]
    pub parameters: Vec<String>,
    /// What of the job is concerned, as a JSON pointer into it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "/options/input_interpolation")]
    pub pointer: Option<String>,
    /// Rows concerned, 1-based, at most the first 20.
    #[serde(default)]
    #[schema(example = json!([752]))]
    pub rows: Vec<usize>,
    /// Recorded time of the first and the last of `rows`, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = json!([110.16, 110.16]))]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub time: Option<[f64; 2]>,
    /// How many rows are concerned in all.
    #[serde(default)]
    #[schema(example = 1)]
    pub count: usize,
    /// What was found.
    #[schema(example = "30.08 s between rows 751 and 752, where samples are 0.04 s apart")]
    pub message: String,
    /// What can be done about it.
    #[schema(
        example = "a job treats the parts as separate segments; say \"gaps\": \"join\" to run them as one"
    )]
    pub remedy: String,
}

impl Finding {
    /// The most rows that [`Self::rows`] lists.
    pub const ROWS_LISTED: usize = 20;

    /// A finding of the severity that its code has, not yet at any place.
    pub fn new(code: FindingCode, message: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            code: code.name().to_string(),
            severity: code.severity(),
            recording: None,
            channel: None,
            parameters: Vec::new(),
            pointer: None,
            rows: Vec::new(),
            time: None,
            count: 0,
            message: message.into(),
            remedy: remedy.into(),
        }
    }

    /// Of another severity than its code usually has.
    #[must_use]
    pub fn with_severity(self, severity: Severity) -> Self {
        Self { severity, ..self }
    }

    /// In the maneuver or segment of this label.
    #[must_use]
    pub fn of_recording(self, label: impl Into<String>) -> Self {
        Self {
            recording: Some(label.into()),
            ..self
        }
    }

    /// On this channel.
    #[must_use]
    pub fn of_channel(self, name: impl Into<String>) -> Self {
        Self {
            channel: Some(name.into()),
            ..self
        }
    }

    /// On these parameters.
    #[must_use]
    pub fn of_parameters(self, names: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self {
            parameters: names.into_iter().map(Into::into).collect(),
            ..self
        }
    }

    /// In this part of the job, a JSON pointer.
    #[must_use]
    pub fn at(self, pointer: impl Into<String>) -> Self {
        Self {
            pointer: Some(pointer.into()),
            ..self
        }
    }

    /// At these rows (indices from 0) of a recording.
    #[must_use]
    pub fn at_rows(self, rows: &[usize]) -> Self {
        let listed = rows.iter().take(Self::ROWS_LISTED);
        Self {
            rows: listed.map(|row| row + 1).collect(),
            count: rows.len(),
            ..self
        }
    }

    /// With the times of its rows, `time` being that of every row of the recording.
    #[must_use]
    pub fn timed(self, time: &[f64]) -> Self {
        let of = |row: Option<&usize>| row.and_then(|row| time.get(row - 1)).copied();
        let (first, last) = (of(self.rows.first()), of(self.rows.last()));
        Self {
            time: first.zip(last).map(|(first, last)| [first, last]),
            ..self
        }
    }

    /// Whether it is more than a note.
    pub fn is_warning(&self) -> bool {
        self.severity > Severity::Note
    }

    /// What it is, where, and what can be done, in one line.
    pub fn sentence(&self) -> String {
        let remedy = match self.remedy.as_str() {
            "" => String::new(),
            remedy => format!("; {remedy}"),
        };
        let place = match (&self.recording, &self.channel) {
            (Some(recording), Some(channel)) => format!("{recording}, {channel}: "),
            (Some(place), None) | (None, Some(place)) => format!("{place}: "),
            (None, None) => String::new(),
        };
        format!("{place}{}{remedy}", self.message)
    }
}

/// How many findings there are of each severity, and which.
#[derive(Clone, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
pub struct FindingTally {
    /// Those that say that the numbers are not what was asked for.
    #[schema(example = 0)]
    pub faults: usize,
    /// Those that change results unless something is done.
    #[schema(example = 1)]
    pub warnings: usize,
    /// Those worth knowing.
    #[schema(example = 2)]
    pub notes: usize,
    /// The codes of faults and warnings, each once, in the order of the findings.
    #[schema(example = json!(["held_channel"]))]
    pub codes: Vec<String>,
}

impl FindingTally {
    /// Of these findings.
    pub fn of(findings: &[Finding]) -> Self {
        let mut tally = Self::default();
        for finding in findings {
            match finding.severity {
                Severity::Fault => tally.faults += 1,
                Severity::Warning => tally.warnings += 1,
                Severity::Note => tally.notes += 1,
            }
            if finding.is_warning() && !tally.codes.contains(&finding.code) {
                tally.codes.push(finding.code.clone());
            }
        }
        tally
    }

    /// Whether nothing was found.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finding_says_where_and_how_many() {
        let rows: Vec<usize> = (0..50).collect();
        let time: Vec<f64> = rows.iter().map(|k| *k as f64 * 0.1).collect();
        let spikes = Finding::new(FindingCode::Spikes, "50 samples", "cut them");
        let spikes = spikes.of_channel("q").at_rows(&rows).timed(&time);
        assert_eq!(
            (spikes.rows.len(), spikes.count),
            (Finding::ROWS_LISTED, 50)
        );
        assert_eq!(spikes.time, Some([0.0, time[19]]));
        assert_eq!(spikes.sentence(), "q: 50 samples; cut them");
        let note = Finding::new(FindingCode::Gap, "", "").with_severity(Severity::Note);
        let tally = FindingTally::of(&[spikes.clone(), note, spikes]);
        assert_eq!((tally.warnings, tally.notes, tally.faults), (2, 1, 0));
        assert_eq!(tally.codes, ["spikes"]);
    }

    #[test]
    fn what_was_kept_before_there_were_places_is_read() {
        let kept = r#"{"code":"gap","severity":"warning","rows":[2],"count":1,"message":"m","remedy":"r"}"#;
        let finding: Finding = serde_json::from_str(kept).unwrap();
        assert_eq!((finding.rows.as_slice(), finding.pointer), (&[2][..], None));
    }
}
