//! Parts of recordings that jobs were fitted to, and whether two jobs have data in common.

use crate::job::spec::ManeuverUse;

/// A part of a recording.
#[derive(Clone, PartialEq, Debug)]
pub struct UsedRecording {
    /// The same for the same content.
    pub id: String,
    /// First and last row, 1-based; all of it where neither these nor `seconds` are said.
    pub rows: Option<[usize; 2]>,
    /// First and last second.
    pub seconds: Option<[f64; 2]>,
}

impl UsedRecording {
    /// What a job with these maneuvers is fitted to.
    pub fn of(maneuvers: &[ManeuverUse]) -> Vec<Self> {
        let fitted = maneuvers.iter().filter(|usage| usage.is_fitted());
        fitted
            .map(|used| Self {
                id: used.id.clone(),
                rows: used.rows,
                seconds: used.seconds,
            })
            .collect()
    }

    /// Whether two parts have samples in common. Where one is said by rows and the other by seconds they count as such.
    fn overlaps(&self, other: &Self) -> bool {
        let rows = match (self.rows, other.rows) {
            (Some([first, last]), Some([from, to])) => first <= to && from <= last,
            _ => true,
        };
        let seconds = match (self.seconds, other.seconds) {
            (Some([first, last]), Some([from, to])) => first <= to && from <= last,
            _ => true,
        };
        self.id == other.id && rows && seconds
    }
}

/// Whether two jobs were fitted to samples of the same recording.
pub(in crate::job) fn share_data(some: &[UsedRecording], others: &[UsedRecording]) -> bool {
    some.iter()
        .any(|part| others.iter().any(|other| part.overlaps(other)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(id: &str, rows: Option<[usize; 2]>, seconds: Option<[f64; 2]>) -> [UsedRecording; 1] {
        [UsedRecording {
            id: id.to_string(),
            rows,
            seconds,
        }]
    }

    #[test]
    fn parts_of_one_recording_overlap_where_they_have_samples_in_common() {
        let whole = part("a", None, None);
        let first = part("a", Some([1, 100]), None);
        for (other, expected) in [
            (whole.clone(), true),
            (first.clone(), true),
            (part("a", Some([100, 200]), None), true),
            (part("a", Some([101, 200]), None), false),
            (part("a", None, Some([50.0, 60.0])), true),
            (part("b", Some([1, 100]), None), false),
        ] {
            assert_eq!(share_data(&first, &other), expected, "{other:?}");
        }
        let seconds = |from, to| part("a", None, Some([from, to]));
        assert!(share_data(&seconds(0.0, 2.0), &seconds(1.0, 3.0)));
        assert!(!share_data(&seconds(0.0, 2.0), &seconds(2.5, 3.0)));
        assert!(!share_data(&[], &whole));
    }
}
