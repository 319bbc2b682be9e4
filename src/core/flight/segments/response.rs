//! How long the aircraft moves on when its inputs have come to rest.

use super::super::{Maneuver, PhysicalQuantity, by_name};
use super::motion::Signal;
use super::range::ranges;

/// A window, s, in which a rate is at rest that covers less than such a share of what it did, or than so many standard
/// deviations of its noise.
const WINDOW: f64 = 1.0;
const AT_REST: f64 = 0.15;
const NOISE: f64 = 6.0;

/// When the rates have come to rest behind inputs from `from` to `to`: at `to` and `longest` at the latest, and there where no
/// rate is recorded.
pub(super) fn rest(maneuver: &Maneuver, from: f64, to: f64, longest: f64) -> f64 {
    let mut rest: Option<f64> = None;
    for (name, channel) in maneuver.channels() {
        use PhysicalQuantity::{PitchRate, RollRate, YawRate};
        let quantity = by_name(name, channel.unit.dimension);
        if !quantity.is_some_and(|quantity| [RollRate, PitchRate, YawRate].contains(&quantity)) {
            continue;
        }
        let signal = Signal::of(maneuver.time(), channel);
        let first = signal.time.partition_point(|&at| at < from);
        let behind = signal.time.partition_point(|&at| at <= to + longest);
        let (Some(time), Some(values)) = (
            signal.time.get(first..behind),
            signal.values.get(first..behind),
        ) else {
            continue;
        };
        let covered = ranges(time, values, WINDOW);
        let most = covered.iter().copied().fold(0.0, f64::max);
        let least = (AT_REST * most).max(NOISE * signal.noise());
        let last = time
            .iter()
            .zip(&covered)
            .rev()
            .find(|(_, covered)| **covered > least);
        let at = last.map_or(to, |(at, _)| *at);
        rest = Some(rest.map_or(at, |rest| rest.max(at)));
    }
    rest.unwrap_or(to + longest).clamp(to, to + longest)
}
