//! When an input moves.

use indexmap::IndexMap;

use super::super::{Channel, Dimension, Fault, Maneuver, PhysicalQuantity, by_name};
use super::range::ranges;

/// An input that is watched.
pub(super) struct Watched {
    pub(super) name: String,
    pub(super) quantity: Option<PhysicalQuantity>,
    /// More than so much within a window is a motion, SI; infinite where it never moves.
    pub(super) threshold: f64,
    /// The window, s.
    width: f64,
    signal: Signal,
}

/// The samples of a channel that there are, single ones that lie apart put back.
pub(super) struct Signal {
    pub(super) time: Vec<f64>,
    pub(super) values: Vec<f64>,
}

/// A window, s; of a slow channel so many of its steps.
const WINDOW: f64 = 0.5;
const STEPS: f64 = 2.5;
/// A motion is more than so many standard deviations of the noise, such a share of the excursion of the input, such a share of
/// the largest excursion of all inputs of its dimension, and so many of its smallest steps.
const NOISE: f64 = 6.0;
const OF_OWN: f64 = 0.06;
const OF_LARGEST: f64 = 0.04;
const QUANTA: f64 = 1.5;
/// An input with less excursion than so many standard deviations of its noise, or so many of its smallest steps, never moves.
const STILL: f64 = 12.0;
const STILL_QUANTA: f64 = 3.0;
/// Steps in such a share of the samples are those of the last digit; so are more than a few between two neighbouring values.
const MANY: f64 = 0.1;
const FEW: usize = 20;

/// # Errors
/// There is no such channel, or no control surface.
pub(super) fn watched(maneuver: &Maneuver, wanted: &[String]) -> Result<Vec<Watched>, Fault> {
    // a name that stands there twice is watched once
    let mut chosen: IndexMap<&String, &Channel> = IndexMap::new();
    for name in wanted {
        let Some((name, channel)) = maneuver.channels().get_key_value(name) else {
            return Err(unknown(maneuver, name));
        };
        chosen.insert(name, channel);
    }
    if wanted.is_empty() {
        let all = maneuver.channels().iter();
        chosen
            .extend(all.filter(|(name, channel)| surface(name, channel.unit.dimension).is_some()));
    }
    if chosen.is_empty() {
        let message = format!(
            "no channel is known as a control surface by its name; say which are the inputs, as inputs=de,dr (--inputs de,dr). There are {}",
            names(maneuver)
        );
        return Err(Fault::new("", "no_inputs", message));
    }
    let signals: Vec<Signal> = chosen
        .iter()
        .map(|(_, channel)| Signal::of(maneuver.time(), channel))
        .collect();
    let excursions: Vec<f64> = signals
        .iter()
        .map(|signal| excursion(&signal.values))
        .collect();
    let alike = |dimension: Dimension| {
        let of_dimension = chosen.iter().zip(&excursions);
        let of_dimension =
            of_dimension.filter(move |((_, channel), _)| channel.unit.dimension == dimension);
        of_dimension
            .map(|(_, excursion)| *excursion)
            .fold(0.0, f64::max)
    };
    let largest: Vec<f64> = chosen
        .iter()
        .map(|(_, channel)| alike(channel.unit.dimension))
        .collect();
    let all = chosen.into_iter().zip(signals).zip(largest);
    Ok(all
        .map(|(((name, channel), signal), largest)| {
            let threshold = signal.threshold(largest);
            Watched {
                name: name.clone(),
                quantity: surface(name, channel.unit.dimension),
                threshold: threshold.unwrap_or(f64::INFINITY),
                width: signal.window(),
                signal,
            }
        })
        .collect())
}

/// Which control surface a name says; power and flaps are set, and not moved in a maneuver.
fn surface(name: &str, dimension: Dimension) -> Option<PhysicalQuantity> {
    use PhysicalQuantity::{Aileron, Canard, Control, Elevator, Rudder};
    let quantity = by_name(name, dimension)?;
    [Elevator, Aileron, Rudder, Canard, Control]
        .contains(&quantity)
        .then_some(quantity)
}

fn unknown(maneuver: &Maneuver, name: &str) -> Fault {
    let name: String = name.chars().take(60).collect();
    let message = format!(
        "there is no channel '{name}'; there are {}",
        names(maneuver)
    );
    Fault::new("", "unknown_channel", message)
}

fn names(maneuver: &Maneuver) -> String {
    let names: Vec<&str> = maneuver.channels().keys().map(String::as_str).collect();
    names.join(", ")
}

impl Watched {
    /// From its least value to its greatest between two times.
    pub(super) fn excursion(&self, from: f64, to: f64) -> f64 {
        excursion(self.signal.between(from, to))
    }

    /// From when to when it moves between two times, s: from the last sample at rest to the first at rest again.
    pub(super) fn motions(&self, from: f64, to: f64) -> Vec<[f64; 2]> {
        if self.threshold.is_infinite() {
            return Vec::new();
        }
        let (first, behind) = self.signal.rows(from, to);
        let time = &self.signal.time[first..behind];
        let values = &self.signal.values[first..behind];
        let moves: Vec<bool> = (ranges(time, values, self.width).into_iter())
            .map(|range| range > self.threshold)
            .collect();
        let mut motions = Vec::new();
        let mut at = 0;
        for run in moves.chunk_by(|a, b| a == b) {
            if run[0] {
                motions.push(self.motion(time, at, at + run.len() - 1));
            }
            at += run.len();
        }
        motions
    }

    /// The motion that windows from one sample to another see. They see it half their width before it begins, and behind it.
    fn motion(&self, time: &[f64], first: usize, last: usize) -> [f64; 2] {
        let half = self.width / 2.0;
        let behind = |at: f64| time.partition_point(|&other| other <= at);
        let ahead = |at: f64| time.partition_point(|&other| other < at);
        // what the window before sees is at rest, and so is what the window behind sees
        let begin = first
            .checked_sub(1)
            .map_or(0, |at| behind(time[at] + half) - 1);
        let end = (last + 1 < time.len()).then(|| ahead(time[last + 1] - half));
        let end = end.unwrap_or(time.len() - 1);
        let narrow = [time[begin], time[end]];
        if begin < end && self.excursion(narrow[0], narrow[1]) > self.threshold {
            return narrow;
        }
        // it goes on as long as the window
        let wide = [ahead(time[first] - half), behind(time[last] + half) - 1];
        wide.map(|at| time[at])
    }
}

impl Signal {
    pub(super) fn of(time: &[f64], channel: &Channel) -> Self {
        let known = time.iter().zip(&channel.values);
        let known = known.filter(|(_, value)| value.is_finite());
        let (time, recorded): (Vec<f64>, Vec<f64>) = known.unzip();
        let mut values = recorded.clone();
        for (at, three) in recorded.windows(3).enumerate() {
            let [a, b, c] = [three[0], three[1], three[2]];
            values[at + 1] = a.min(b).max(a.max(b).min(c));
        }
        Self { time, values }
    }

    pub(super) fn between(&self, from: f64, to: f64) -> &[f64] {
        let (first, behind) = self.rows(from, to);
        &self.values[first..behind]
    }

    /// The first sample between two times, and that behind the last.
    pub(super) fn rows(&self, from: f64, to: f64) -> (usize, usize) {
        let first = self.time.partition_point(|&at| at < from);
        let behind = self.time.partition_point(|&at| at <= to);
        (first, behind.max(first))
    }

    /// The standard deviation of its noise, from second differences, of which motions are few.
    pub(super) fn noise(&self) -> f64 {
        let seconds = self.values.windows(3);
        let mut sizes: Vec<f64> = seconds
            .map(|three| (three[0] - 2.0 * three[1] + three[2]).abs())
            .collect();
        if sizes.is_empty() {
            return 0.0;
        }
        let middle = sizes.len() / 2;
        let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
        // a median of 1.0 at σ = 0.6745⁻¹; the variance of a second difference is six times that of the noise
        *median / 0.6745 / 6f64.sqrt()
    }

    /// `None`: it never moves.
    fn threshold(&self, largest: f64) -> Option<f64> {
        let (own, noise) = (excursion(&self.values), self.noise());
        let steps = self.values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
        let smallest = steps.iter().copied().fold(f64::INFINITY, f64::min);
        // a step now and then is one of the input, many are of the last digit
        let is_digit = steps.len() as f64 > MANY * self.values.len() as f64;
        let quantum = if is_digit { smallest } else { 0.0 };
        let is_flicker = steps.len() > FEW && own < 1.5 * smallest;
        let is_still = own <= STILL * noise || own <= STILL_QUANTA * quantum || is_flicker;
        let threshold = [
            NOISE * noise,
            OF_OWN * own,
            OF_LARGEST * largest,
            QUANTA * quantum,
        ];
        (!is_still && own > 0.0).then(|| threshold.into_iter().fold(0.0, f64::max))
    }

    /// How long a window is, s.
    fn window(&self) -> f64 {
        let mut steps: Vec<f64> = self.time.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if steps.is_empty() {
            return WINDOW;
        }
        let middle = steps.len() / 2;
        let (_, step, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
        WINDOW.max(STEPS * *step)
    }
}

pub(super) fn excursion(values: &[f64]) -> f64 {
    let ends = values.iter().fold(
        (f64::INFINITY, f64::NEG_INFINITY),
        |(least, greatest), value| (least.min(*value), greatest.max(*value)),
    );
    (ends.1 - ends.0).max(0.0)
}
