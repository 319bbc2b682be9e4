//! The same samples more than once in a job: as two maneuvers, or as rows of one recording that overlap.

use std::collections::{HashMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};

use super::stretch::Stretch;
use crate::flight::{Finding, FindingCode};
use crate::job::spec::JobSpec;
use crate::simulate::Segment;
use crate::stop;

/// Fewer rows, or fewer different ones, may be alike at rest.
const LEAST: usize = 20;
const DIFFERENT: usize = 15;

/// A segment, and the stretch that it was made of.
pub(super) type Used<'s, 'm> = (&'s Segment, &'s Stretch<'m>);

/// One finding for each pair of maneuvers that have samples in common.
pub(super) fn findings(spec: &JobSpec, used: &[Used<'_, '_>]) -> Vec<Finding> {
    let mut seen: HashMap<u64, usize> = HashMap::new();
    let mut common: HashMap<(usize, usize), HashSet<u64>> = HashMap::new();
    let mut counts: HashMap<(usize, usize), usize> = HashMap::new();
    for (segment, stretch) in used {
        let index = stretch.index;
        for (sample, _) in stretch.recorded() {
            stop::check_sometimes(sample);
            let hash = row_hash(segment, sample);
            let first = *seen.entry(hash).or_insert(index);
            if first != index {
                common.entry((first, index)).or_default().insert(hash);
                *counts.entry((first, index)).or_default() += 1;
            }
        }
    }
    let mut pairs: Vec<(usize, usize)> = (common.iter())
        .filter(|(pair, hashes)| hashes.len() >= DIFFERENT && counts[*pair] >= LEAST)
        .map(|(pair, _)| *pair)
        .collect();
    pairs.sort_unstable();
    let samples = |index: usize| -> usize {
        let own = used.iter().filter(|(_, stretch)| stretch.index == index);
        own.map(|(_, stretch)| stretch.rows.len()).sum()
    };
    pairs
        .into_iter()
        .map(|(first, second)| {
            let count = counts[&(first, second)];
            let whole = count == samples(second) && count == samples(first);
            finding(spec, [first, second], count, whole)
        })
        .collect()
}

fn row_hash(segment: &Segment, sample: usize) -> u64 {
    let mut hash = DefaultHasher::new();
    for series in segment.inputs.iter().chain(&segment.measured) {
        series[sample].to_bits().hash(&mut hash);
    }
    hash.finish()
}

fn finding(spec: &JobSpec, pair: [usize; 2], count: usize, whole: bool) -> Finding {
    let uses = pair.map(|index| &spec.maneuvers[index]);
    let [first, second] = pair.map(|index| spec.label(index));
    let of_one = uses[0].id == uses[1].id;
    let (code, what) = match (whole, of_one) {
        (true, _) => (FindingCode::RepeatedManeuver, "it has the same samples as"),
        (false, true) => (FindingCode::OverlappingRows, "some of its rows are also in"),
        (false, false) => (
            FindingCode::RepeatedManeuver,
            "some of its samples are also in",
        ),
    };
    let harm = match uses[0].role == uses[1].role {
        true => {
            "what is counted twice makes error bounds too small, by the root of two where all is"
        }
        false => "a prediction of what the model was fitted to proves nothing",
    };
    let message = format!("{what} {first} ({count} rows): {harm}");
    let remedy = "leave one of them out, or choose \"rows\" that do not overlap";
    let finding = Finding::new(code, message, remedy);
    let finding = finding
        .of_recording(second)
        .at(format!("/maneuvers/{}", pair[1]));
    Finding { count, ..finding }
}
