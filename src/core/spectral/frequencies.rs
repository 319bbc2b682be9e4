//! Evenly spaced frequencies.

use std::f64::consts::TAU;

/// f_k = first + k step, Hz.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Frequencies {
    /// The lowest, Hz.
    pub first: f64,
    /// From one to the next, Hz.
    pub step: f64,
    /// How many there are.
    pub count: usize,
}

/// A share of a step by which a frequency may lie beyond the band: bounds in Hz are rounded.
const ROUNDING: f64 = 1e-6;

impl Frequencies {
    /// The multiples of 1/T within a band: those at which the transforms of white noise over T seconds are independent.
    pub fn harmonics(duration: f64, [from, to]: [f64; 2]) -> Self {
        let first = (from * duration - ROUNDING).ceil().max(1.0);
        let last = (to * duration + ROUNDING).floor();
        Self {
            first: first / duration,
            step: 1.0 / duration,
            count: if last >= first {
                (last - first) as usize + 1
            } else {
                0
            },
        }
    }

    /// From the lower edge of a band to its upper one.
    pub fn spaced(step: f64, [from, to]: [f64; 2]) -> Self {
        Self {
            first: from,
            step,
            count: ((to - from) / step + ROUNDING).floor().max(0.0) as usize + 1,
        }
    }

    /// Hz.
    pub fn hertz(self) -> impl ExactSizeIterator<Item = f64> {
        (0..self.count).map(move |k| self.first + k as f64 * self.step)
    }

    /// ω, rad/s.
    pub fn angular(self) -> impl ExactSizeIterator<Item = f64> {
        self.hertz().map(|frequency| TAU * frequency)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_of_a_band_belong_to_it() {
        let harmonics = Frequencies::harmonics(20.0, [0.1, 0.5]);
        assert_eq!(harmonics.count, 9);
        assert!((harmonics.hertz().last().unwrap() - 0.5).abs() < 1e-12);
        let spaced = Frequencies::spaced(0.04, [0.1, 1.5]);
        assert_eq!(spaced.count, 36);
        assert_eq!(Frequencies::harmonics(2.0, [0.6, 0.9]).count, 0);
        // zero is no frequency of a band
        assert!(Frequencies::harmonics(2.0, [0.0, 0.9]).first > 0.0);
    }
}
