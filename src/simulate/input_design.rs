//! Designed inputs: what a pilot or a flight control computer flies to excite a motion.

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
        start: f64,
        unit_time: f64,
        amplitude: f64,
    },
    /// One pulse each way.
    #[serde(rename = "doublet")]
    Doublet {
        start: f64,
        unit_time: f64,
        amplitude: f64,
    },
    /// Pulses of given length and amplitude, one after the other.
    #[serde(rename = "pulses")]
    Pulses { start: f64, pulses: Vec<[f64; 2]> },
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
