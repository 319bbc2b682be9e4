//! Designed inputs: what a pilot or a flight control computer flies to excite a motion.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

/// The shape of one control input over time.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(tag = "shape", deny_unknown_fields)]
pub enum InputDesign {
    /// Held where it is.
    #[serde(rename = "constant")]
    Constant,
    /// Pulses of 3, 2, 1 and 1 units of time, alternating in sign: flat spectrum over a wide band.
    #[serde(rename = "3-2-1-1")]
    ThreeTwoOneOne {
        /// When the first pulse begins, s.
        start: f64,
        /// The unit of time, the length of the shortest pulse, s.
        unit_time: f64,
        /// Deflection from trim, in the unit of the input; negative begins the other way.
        amplitude: f64,
    },
    /// One pulse each way.
    #[serde(rename = "doublet")]
    Doublet {
        /// When the first pulse begins, s.
        start: f64,
        /// The length of each pulse, s.
        unit_time: f64,
        /// Deflection from trim, in the unit of the input; negative begins the other way.
        amplitude: f64,
    },
    /// Pulses of given length and amplitude, one after the other.
    #[serde(rename = "pulses")]
    Pulses {
        /// When the first pulse begins, s.
        start: f64,
        /// Of each its length, s, and its deflection from trim, in the unit of the input.
        pulses: Vec<[f64; 2]>,
    },
    /// Times, s, and the values held from there on.
    #[serde(rename = "steps")]
    Steps {
        /// By increasing time: seconds from the start, and the deflection from trim, in the unit of the input.
        steps: Vec<[f64; 2]>,
    },
    /// A sum of sines of equal size, of Schroeder's phases where none are said, so that the sum has a low peak: the amplitude
    /// is the sum's root mean square times √2.
    #[serde(rename = "multisine")]
    Multisine {
        /// When it begins, s.
        start: f64,
        /// How long it lasts, s.
        duration: f64,
        /// Hz; multiples of 1/duration make it end where it begins.
        frequencies: Vec<f64>,
        /// In the unit of the input.
        amplitude: f64,
        /// One for each frequency, rad, of a sine that begins at `start`.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        phases: Vec<f64>,
    },
    /// A sine whose frequency grows linearly, Hz.
    #[serde(rename = "sweep")]
    Sweep {
        /// When it begins, s.
        start: f64,
        /// How long it lasts, s.
        duration: f64,
        /// The frequency at its start, Hz.
        from: f64,
        /// The frequency at its end, Hz.
        to: f64,
        /// Of the sine, in the unit of the input.
        amplitude: f64,
    },
    /// As it was recorded: times from the start, s, and values in the unit of the input, linear between them. `file` and
    /// `channel` name a recording instead, a path relative to the scenario; see [`super::Scenario::read_recorded`].
    #[serde(rename = "recorded")]
    Recorded {
        /// A recording, by its path.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        file: Option<String>,
        /// The channel of the recording.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        channel: Option<String>,
        /// Seconds from the start, increasing.
        #[serde(default)]
        time: Vec<f64>,
        /// One for each time, in the unit of the input.
        #[serde(default)]
        values: Vec<f64>,
    },
}

impl InputDesign {
    /// Deviation from trim at time `t`, s, in the unit of the amplitude.
    pub fn at(&self, t: f64) -> f64 {
        let alternating = |start: f64, unit_time: f64, amplitude: f64, units: &[f64]| {
            let signs = [1.0, -1.0].into_iter().cycle();
            pulse(
                t - start,
                units
                    .iter()
                    .zip(signs)
                    .map(|(&units, sign)| [units * unit_time, sign * amplitude]),
            )
        };
        match self {
            Self::Constant => 0.0,
            Self::ThreeTwoOneOne {
                start,
                unit_time,
                amplitude,
            } => alternating(*start, *unit_time, *amplitude, &[3.0, 2.0, 1.0, 1.0]),
            Self::Doublet {
                start,
                unit_time,
                amplitude,
            } => alternating(*start, *unit_time, *amplitude, &[1.0, 1.0]),
            Self::Pulses { start, pulses } => pulse(t - start, pulses.iter().copied()),
            Self::Steps { steps } => {
                let begun = steps.iter().rev().find(|[from, _]| *from <= t + 1e-9);
                begun.map_or(0.0, |[_, value]| *value)
            }
            Self::Multisine {
                start,
                duration,
                frequencies,
                amplitude,
                phases,
            } => {
                let (t, count) = (t - start, frequencies.len() as f64);
                if !(0.0..=*duration).contains(&t) {
                    return 0.0;
                }
                let sine = |(k, frequency): (usize, &f64)| {
                    let place = k as f64;
                    let schroeder = || -(PI * place * (place + 1.0) / count);
                    let phase = phases.get(k).copied().unwrap_or_else(schroeder);
                    (2.0 * PI * frequency * t + phase).sin()
                };
                let sum: f64 = frequencies.iter().enumerate().map(sine).sum();
                amplitude * sum / count.sqrt()
            }
            Self::Sweep {
                start,
                duration,
                from,
                to,
                amplitude,
            } => {
                let t = t - start;
                if !(0.0..=*duration).contains(&t) {
                    return 0.0;
                }
                amplitude * (2.0 * PI * (from + 0.5 * (to - from) * t / duration) * t).sin()
            }
            Self::Recorded { time, values, .. } => interpolated(time, values, t),
        }
    }

    /// What is wrong with it.
    pub(super) fn fault(&self) -> Option<String> {
        match self {
            Self::Recorded { time, values, .. } => {
                if values.is_empty() {
                    return Some("a recorded input needs its \"time\" and \"values\", or a \"file\" and \"channel\" that was read".into());
                }
                let grows = time.windows(2).all(|pair| pair[0] < pair[1]);
                (time.len() != values.len() || !grows)
                    .then(|| "\"time\" must grow and be as long as \"values\"".into())
            }
            Self::Multisine { frequencies, .. } if frequencies.is_empty() => {
                Some("a multisine needs its \"frequencies\"".into())
            }
            Self::Multisine {
                frequencies,
                phases,
                ..
            } if !phases.is_empty() && phases.len() != frequencies.len() => {
                Some("\"phases\" must be as many as \"frequencies\", or none".into())
            }
            Self::Multisine { frequencies, .. } => too_many("frequencies", frequencies.len()),
            Self::Pulses { pulses, .. } => too_many("pulses", pulses.len()),
            Self::Steps { steps } => too_many("steps", steps.len()),
            _ => None,
        }
    }
}

/// Each is asked at each sample: more than these take longer than anybody waits.
fn too_many(what: &str, count: usize) -> Option<String> {
    const MOST: usize = 1000;
    (count > MOST).then(|| {
        format!(
            "{count} {what} are more than {MOST}; give such an input as it was recorded, by its \"time\" and \"values\""
        )
    })
}

/// Linear between samples, held beyond the ends.
fn interpolated(time: &[f64], values: &[f64], t: f64) -> f64 {
    let after = time.partition_point(|&at| at <= t);
    match (after.checked_sub(1), values.get(after)) {
        (None, _) => values.first().copied().unwrap_or(0.0),
        (Some(before), None) => values.get(before).copied().unwrap_or(0.0),
        (Some(before), Some(next)) => {
            let share = (t - time[before]) / (time[after] - time[before]);
            values[before] + share * (next - values[before])
        }
    }
}

/// The pulse that time `t` since the first one falls into.
fn pulse(t: f64, pulses: impl Iterator<Item = [f64; 2]>) -> f64 {
    // samples fall on the edges of pulses: rounding must not decide on which side
    let t = t + 1e-9;
    if t < 0.0 {
        return 0.0;
    }
    let mut end = 0.0;
    for [length, amplitude] in pulses {
        end += length;
        if t < end {
            return amplitude;
        }
    }
    0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each design with a thousand of its parts, and with one more.
    #[test]
    fn parts_of_a_design_are_limited() {
        let designs = |count: usize| {
            [
                InputDesign::Multisine {
                    start: 0.0,
                    duration: 1.0,
                    frequencies: vec![1.0; count],
                    amplitude: 1.0,
                    phases: Vec::new(),
                },
                InputDesign::Pulses {
                    start: 0.0,
                    pulses: vec![[0.1, 1.0]; count],
                },
                InputDesign::Steps {
                    steps: vec![[0.1, 1.0]; count],
                },
            ]
        };
        assert!(designs(1000).iter().all(|design| design.fault().is_none()));
        for design in designs(1001) {
            let fault = design.fault().expect("a fault");
            assert!(
                fault.starts_with("1001 ") && fault.contains("more than 1000"),
                "{fault}"
            );
        }
    }

    #[test]
    fn a_3211_is_three_two_one_one() {
        let design = InputDesign::ThreeTwoOneOne {
            start: 1.0,
            unit_time: 0.5,
            amplitude: 2.0,
        };
        let values: Vec<f64> = (0..10).map(|k| design.at(f64::from(k) * 0.5)).collect();
        assert_eq!(
            values,
            [0.0, 0.0, 2.0, 2.0, 2.0, -2.0, -2.0, 2.0, -2.0, 0.0]
        );
    }
}
