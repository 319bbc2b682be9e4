//! How long the aircraft moves on when its inputs have come to rest.

use super::super::{Channel, Maneuver, PhysicalQuantity, by_name};
use super::motion::Signal;
use super::range::ranges;

/// A window, s, in which a rate is at rest that covers less than such a share of what it did, or than so many standard
/// deviations of its noise.
const WINDOW: f64 = 1.0;
const AT_REST: f64 = 0.15;
const NOISE: f64 = 6.0;

/// The rates that are recorded.
pub(super) struct Rates(Vec<Rate>);

struct Rate {
    signal: Signal,
    noise: f64,
}

impl Rates {
    pub(super) fn of(maneuver: &Maneuver) -> Self {
        use PhysicalQuantity::{PitchRate, RollRate, YawRate};
        let is_rate = |(name, channel): &(&String, &Channel)| {
            let quantity = by_name(name, channel.unit.dimension);
            quantity.is_some_and(|quantity| [RollRate, PitchRate, YawRate].contains(&quantity))
        };
        let rates = maneuver.channels().iter().filter(is_rate);
        let rates = rates.map(|(_, channel)| {
            let signal = Signal::of(maneuver.time(), channel);
            let noise = signal.noise();
            Rate { signal, noise }
        });
        Self(rates.collect())
    }

    /// When the rates have come to rest behind inputs from `from` to `to`: at `to` and `longest` at the latest, and there where
    /// no rate is recorded.
    pub(super) fn rest(&self, from: f64, to: f64, longest: f64) -> f64 {
        let rates = self.0.iter();
        let rest = rates.map(|rate| rate.rest(from, to, longest));
        let rest = rest.reduce(f64::max).unwrap_or(to + longest);
        rest.clamp(to, to + longest)
    }
}

impl Rate {
    fn rest(&self, from: f64, to: f64, longest: f64) -> f64 {
        let (first, behind) = self.signal.rows(from, to + longest);
        let time = &self.signal.time[first..behind];
        let covered = ranges(time, &self.signal.values[first..behind], WINDOW);
        let most = covered.iter().copied().fold(0.0, f64::max);
        let least = (AT_REST * most).max(NOISE * self.noise);
        let mut back = time.iter().zip(&covered).rev();
        let last = back.find(|(_, covered)| **covered > least);
        last.map_or(to, |(at, _)| *at)
    }
}
