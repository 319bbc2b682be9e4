//! Rows that were written twice: again at once, or as a block later on.

use std::collections::{HashMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::Range;

use crate::flight::{Finding, FindingCode};
use crate::stop;

use super::record::Record;

/// A channel that stands still in more samples than this share tells nothing of whether a row is new.
const AT_REST: f64 = 0.7;
/// As many repeated rows as there are come about by chance once in so many recordings.
const CHANCE: f64 = 1e-3;
/// From median size of a difference to its standard deviation, normally distributed.
const TO_SIGMA: f64 = 1.4826;
/// Blocks of fewer rows, or of fewer different ones, may be rest.
const BLOCK: usize = 20;
const DIFFERENT: usize = 15;

/// Rows that repeat the row before them in every channel that changes at all.
pub(super) struct RepeatedRows {
    is_repeated: Vec<bool>,
}

/// A channel by which rows are told apart.
struct Changing<'a> {
    values: &'a [f64],
    /// The smallest change there is: the resolution.
    quantum: f64,
    /// That a sample of it equals the one before by chance.
    chance: f64,
}

impl<'a> Changing<'a> {
    fn of(values: &'a [f64]) -> Option<Self> {
        let changes = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let moving = super::statistics::sorted(changes.filter(|change| *change > 0.0));
        let quantum = *moving.first()?;
        let rests = 1.0 - moving.len() as f64 / (values.len() - 1) as f64;
        let sigma = TO_SIGMA * moving[moving.len() / 2];
        let chance = match rests > AT_REST {
            true => 1.0,
            // the density of a normal difference at zero
            false => (quantum / (sigma * std::f64::consts::TAU.sqrt())).min(1.0),
        };
        Some(Self {
            values,
            quantum,
            chance,
        })
    }

    fn moves(&self, from: usize, to: usize) -> bool {
        self.chance < 1.0 && (self.values[to] - self.values[from]).abs() > 3.0 * self.quantum
    }
}

impl RepeatedRows {
    pub(super) fn of(record: &Record<'_>, segments: &[Range<usize>]) -> Self {
        let series = record.series.iter();
        let changing: Vec<Changing<'_>> = series.filter_map(|s| Changing::of(&s.values)).collect();
        // one channel alone is stuck, or held
        let telling = changing.iter().filter(|channel| channel.chance < 1.0);
        let mut is_repeated = vec![telling.count() >= 2; record.time.len()];
        for segment in segments {
            is_repeated[segment.start] = false;
        }
        for channel in &changing {
            stop::check();
            for (k, pair) in channel.values.windows(2).enumerate() {
                is_repeated[k + 1] &= pair[0] == pair[1];
            }
        }
        let kept: HashSet<usize> = (segments.iter())
            .flat_map(|segment| runs(&is_repeated, segment))
            .filter(|(segment, run)| is_in_motion(&changing, segment, run))
            .flat_map(|(_, run)| run)
            .collect();
        let chance: f64 = changing.iter().map(|channel| channel.chance).product();
        let expected = chance * record.time.len() as f64;
        let enough = is_no_chance(expected, kept.len());
        Self {
            is_repeated: (0..is_repeated.len())
                .map(|row| enough && kept.contains(&row))
                .collect(),
        }
    }

    /// Whether a stretch of equal values is nothing but repeated rows.
    pub(super) fn cover(&self, stretch: &Range<usize>) -> bool {
        self.is_repeated[stretch.start + 1..stretch.end]
            .iter()
            .all(|&repeated| repeated)
    }

    /// Whether most of a channel's repeated values are those of repeated rows.
    pub(super) fn explain(&self, values: &[f64]) -> bool {
        let equal: Vec<usize> = (1..values.len())
            .filter(|&k| values[k] == values[k - 1])
            .collect();
        let covered = equal.iter().filter(|&&k| self.is_repeated[k]).count();
        covered * 10 > equal.len() * 9
    }

    pub(super) fn finding(&self) -> Option<Finding> {
        let rows: Vec<usize> = (0..self.is_repeated.len())
            .filter(|&row| self.is_repeated[row])
            .collect();
        if rows.is_empty() {
            return None;
        }
        let message = format!(
            "{} row(s) repeat the row before them in every channel that changes",
            rows.len()
        );
        let remedy = "if the recorder wrote a sample more than once, keep the first of each; a lower rate may be the true one";
        Some(Finding::new(FindingCode::RepeatedRows, message, remedy).at_rows(&rows))
    }
}

/// Whether so many repetitions, where `expected` come about by chance, are none: the tail of Poisson's distribution.
fn is_no_chance(expected: f64, count: usize) -> bool {
    if count == 0 || expected >= 0.5 * count as f64 {
        return false;
    }
    let logarithm: f64 = (1..=count).map(|k| (expected / k as f64).ln()).sum();
    logarithm < CHANCE.ln()
}

/// The runs of repeated rows in a segment, each with the segment.
fn runs(is_repeated: &[bool], segment: &Range<usize>) -> Vec<(Range<usize>, Range<usize>)> {
    let mut runs = Vec::new();
    let mut start = None;
    for k in segment.clone().chain([segment.end]) {
        let repeated = k < segment.end && is_repeated[k];
        match (repeated, start) {
            (true, None) => start = Some(k),
            (false, Some(first)) => {
                runs.push((segment.clone(), first..k));
                start = None;
            }
            _ => {}
        }
    }
    runs
}

/// Whether the motion went on before a run of repeated rows and behind it: it did not come to rest there.
fn is_in_motion(changing: &[Changing<'_>], segment: &Range<usize>, run: &Range<usize>) -> bool {
    let moves = |from: usize, to: usize| changing.iter().any(|c| c.moves(from, to));
    // the first of the equal rows is the one before the run
    let before = (run.start >= segment.start + 2).then(|| moves(run.start - 2, run.start - 1));
    let behind = (run.end < segment.end).then(|| moves(run.end - 1, run.end));
    match (before, behind) {
        (Some(before), Some(behind)) => before && behind,
        // at an end of a recording only a short run is no rest
        (None, Some(moves)) | (Some(moves), None) => moves && run.len() <= 2,
        (None, None) => false,
    }
}

/// A stretch of rows that is there a second time, at another place of the recording.
pub(super) fn blocks(record: &Record<'_>) -> Option<Finding> {
    let series = record.series.iter();
    let changing: Vec<&[f64]> = series
        .map(|s| &*s.values)
        .filter(|values| {
            values
                .windows(2)
                .any(|pair| pair[0] != pair[1] && !pair[0].is_nan())
        })
        .collect();
    if changing.len() < 2 {
        return None;
    }
    let hashes: Vec<u64> = (0..record.time.len())
        .map(|k| {
            stop::check_sometimes(k);
            let mut hash = DefaultHasher::new();
            changing
                .iter()
                .for_each(|values| values[k].to_bits().hash(&mut hash));
            hash.finish()
        })
        .collect();
    let (again, first) = longest_block(&hashes)?;
    let message = format!(
        "rows {} to {} repeat rows {} to {} in every channel that changes",
        record.first_row + again.start + 1,
        record.first_row + again.end,
        record.first_row + first + 1,
        record.first_row + first + again.len()
    );
    let remedy =
        "cut one of the two with \"rows\": what is counted twice makes error bounds too small";
    let rows: Vec<usize> = again.collect();
    Some(Finding::new(FindingCode::RepeatedRows, message, remedy).at_rows(&rows))
}

/// The longest run of values that were there before in the same order, and where.
fn longest_block(hashes: &[u64]) -> Option<(Range<usize>, usize)> {
    let mut seen: HashMap<u64, usize> = HashMap::new();
    let mut best: Option<(Range<usize>, usize)> = None;
    let mut run: Option<(usize, usize)> = None;
    let mut end = |run: Option<(usize, usize)>, k: usize| {
        let Some((start, first)) = run else { return };
        let different: HashSet<u64> = hashes[start..k].iter().copied().collect();
        let is_longer = best
            .as_ref()
            .is_none_or(|(range, _)| range.len() < k - start);
        if k - start >= BLOCK && different.len() >= DIFFERENT && is_longer {
            best = Some((start..k, first));
        }
    };
    for (k, hash) in hashes.iter().enumerate() {
        stop::check_sometimes(k);
        run = match run {
            Some((start, first))
                if hashes[first + (k - start)] == *hash && first + (k - start) < start =>
            {
                Some((start, first))
            }
            ended => {
                end(ended, k);
                seen.get(hash).map(|&first| (k, first))
            }
        };
        seen.entry(*hash).or_insert(k);
    }
    end(run, hashes.len());
    best
}

#[cfg(test)]
mod tests {
    use super::super::tests::{maneuver, noise};
    use super::*;
    use crate::flight::Severity;

    /// Channels of noise that count on at each new row; `row(k)` is the row that is written at k.
    fn written(channels: usize, row: impl Fn(usize) -> usize) -> Vec<(&'static str, Vec<f64>)> {
        let names = ["a", "b", "c", "d"];
        let series = |(seed, name): (usize, &&'static str)| {
            let value = |k: usize| (noise(seed * 100_000 + row(k)) * 1000.0).round() / 1000.0;
            (*name, (0..300).map(value).collect())
        };
        names[..channels].iter().enumerate().map(series).collect()
    }

    fn repeated(channels: &[(&str, Vec<f64>)]) -> Option<Finding> {
        let maneuver = maneuver(channels);
        let record = Record::of(&maneuver);
        RepeatedRows::of(&record, &record.segments()).finding()
    }

    #[test]
    fn a_row_written_twice_is_seen_also_where_few_channels_change() {
        for channels in [2, 3, 4] {
            let twice = written(channels, |k| if k >= 50 { k - 1 } else { k });
            let finding = repeated(&twice).unwrap();
            assert_eq!((finding.rows.as_slice(), finding.count), (&[51][..], 1));
            assert_eq!(finding.severity, Severity::Warning);
            assert_eq!(repeated(&written(channels, |k| k)), None, "{channels}");
            let all = repeated(&written(channels, |k| k / 2)).unwrap();
            assert_eq!(all.count, 150);
        }
        let mut at_rest = written(2, |k| if k >= 50 { k - 1 } else { k });
        at_rest.push(("de", vec![0.0; 300]));
        at_rest[2].1[100..120].fill(1.0);
        assert_eq!(repeated(&at_rest).unwrap().rows, [51]);
    }

    #[test]
    fn rest_and_coarse_signals_are_none() {
        let coarse = |seed: usize| (0..300).map(|k| (noise(seed + k) * 2.0).round()).collect();
        assert_eq!(repeated(&[("a", coarse(0)), ("b", coarse(999))]), None);
        // two responses that die away, in four decimals
        let dying = |rate: f64| {
            let value = |k: usize| ((-(k as f64) * rate).exp() * 1e4).round() / 1e4;
            (0..300).map(value).collect::<Vec<f64>>()
        };
        assert_eq!(repeated(&[("a", dying(0.1)), ("b", dying(0.2))]), None);
    }

    #[test]
    fn a_block_that_is_there_twice_is_seen() {
        let twice = written(2, |k| if (150..250).contains(&k) { k - 120 } else { k });
        let maneuver = super::super::tests::maneuver(&twice);
        let finding = blocks(&Record::of(&maneuver)).unwrap();
        assert!(
            finding
                .message
                .starts_with("rows 151 to 250 repeat rows 31 to 130")
        );
        assert_eq!(finding.count, 100);
        let once = written(2, |k| k);
        let maneuver = super::super::tests::maneuver(&once);
        assert_eq!(blocks(&Record::of(&maneuver)), None);
    }
}
