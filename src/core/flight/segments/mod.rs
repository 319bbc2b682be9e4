//! Where in a recording a maneuver is flown, and where the aircraft is trimmed: a proposal of segments.
//!
//! An input moves where it covers more than a threshold within half a second. Motions with less than some seconds of quiet
//! between them are one maneuver, which begins a little before them, in trim, and ends when the rates have come to rest. What
//! lies between is trim; or quasi-steady, where an input wanders slowly, as in an approach to the stall.

mod motion;
mod proposal;
mod range;
mod response;
mod word;

pub use proposal::{Moved, Proposal, ProposedSegment, SegmentKind};

use super::{Fault, Maneuver};
use motion::Watched;
use response::Rates;

/// How segments are looked for. Times are seconds.
#[derive(Clone, PartialEq, Debug)]
pub struct Wanted {
    /// The inputs that are watched; empty: the control surfaces among the channels, by their names.
    pub inputs: Vec<String>,
    /// So long nothing moves between two maneuvers.
    pub quiet: f64,
    /// Of trim before the first motion.
    pub lead: f64,
    /// Of free response behind the last motion, at most.
    pub response: f64,
}

impl Default for Wanted {
    fn default() -> Self {
        Self {
            inputs: Vec::new(),
            quiet: 5.0,
            lead: 2.0,
            response: 10.0,
        }
    }
}

/// What is between maneuvers and shorter, s, is left out.
const SHORTEST: f64 = 3.0;
/// In a quasi-steady stretch an input wanders by more than so many of its thresholds.
const WANDERS: f64 = 3.0;

/// Looks for segments.
///
/// # Errors
/// There is no channel of a name that is wanted; or none is a control surface, and no name is given.
pub fn segments(maneuver: &Maneuver, wanted: &Wanted) -> Result<Proposal, Fault> {
    let inputs = motion::watched(maneuver, &wanted.inputs)?;
    let rates = Rates::of(maneuver);
    let mut found = Vec::new();
    for rows in maneuver.sampling().segments() {
        let time = &maneuver.time()[rows];
        found.extend(of_stretch(time, &inputs, &rates, wanted));
    }
    let mut proposed: Vec<ProposedSegment> = (found.into_iter())
        .filter_map(|(kind, seconds)| proposed(maneuver, &inputs, kind, seconds))
        .collect();
    word::number(&mut proposed);
    Ok(Proposal {
        inputs: inputs.iter().map(|input| input.name.clone()).collect(),
        segments: proposed,
    })
}

/// What there is between two gaps, in the order of its times.
fn of_stretch(
    time: &[f64],
    inputs: &[Watched],
    rates: &Rates,
    wanted: &Wanted,
) -> Vec<(SegmentKind, [f64; 2])> {
    let (Some(&begin), Some(&end)) = (time.first(), time.last()) else {
        return Vec::new();
    };
    let mut motions: Vec<[f64; 2]> = (inputs.iter())
        .flat_map(|input| input.motions(begin, end))
        .collect();
    motions.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut maneuvers: Vec<[f64; 2]> = Vec::new();
    for [from, to] in motions {
        match maneuvers.last_mut() {
            Some(before) if from - before[1] < wanted.quiet => before[1] = before[1].max(to),
            _ => maneuvers.push([from, to]),
        }
    }
    let mut found = Vec::new();
    let mut at = begin;
    for (number, &[from, to]) in maneuvers.iter().enumerate() {
        let next = maneuvers
            .get(number + 1)
            .map_or(end, |next| next[0] - wanted.lead);
        // no further than to the next: its response is another
        let longest = wanted.response.min((next.min(end) - to).max(0.0));
        let segment = [
            (from - wanted.lead).max(at),
            rates.rest(from, to, longest).min(end),
        ];
        found.extend(between(inputs, at, segment[0]));
        at = segment[1];
        found.push((SegmentKind::Maneuver, segment));
    }
    found.extend(between(inputs, at, end));
    found
}

/// What a stretch without motion is.
fn between(inputs: &[Watched], from: f64, to: f64) -> Option<(SegmentKind, [f64; 2])> {
    let wanders = |input: &Watched| input.excursion(from, to) > WANDERS * input.threshold;
    let kind = match inputs.iter().any(wanders) {
        true => SegmentKind::QuasiSteady,
        false => SegmentKind::Trim,
    };
    (to - from >= SHORTEST).then_some((kind, [from, to]))
}

fn proposed(
    maneuver: &Maneuver,
    inputs: &[Watched],
    kind: SegmentKind,
    seconds: [f64; 2],
) -> Option<ProposedSegment> {
    let time = maneuver.time();
    let first = time.partition_point(|&at| at < seconds[0]);
    let behind = time.partition_point(|&at| at <= seconds[1]);
    if behind <= first {
        return None;
    }
    let seconds = [time[first], time[behind - 1]];
    let moves = (inputs.iter()).map(|input| (input, input.excursion(seconds[0], seconds[1])));
    let mut moves: Vec<(&Watched, f64)> = moves
        .filter(|(input, excursion)| *excursion > input.threshold)
        .collect();
    moves.sort_by(|a, b| b.1.total_cmp(&a.1));
    Some(ProposedSegment {
        name: word::of(kind, &moves),
        kind,
        seconds,
        rows: [first + 1, behind],
        moves: (moves.into_iter())
            .map(|(input, excursion)| Moved {
                channel: input.name.clone(),
                excursion,
            })
            .collect(),
    })
}
