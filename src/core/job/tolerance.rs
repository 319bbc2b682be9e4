//! What simulators are qualified by: how far a response may deviate from that of the aircraft.
//!
//! 14 CFR Part 60, Appendix A, Table A2A, entries 2.c.10, 2.d.2, 2.d.4 and 2.d.6, checked against the edition of 2014-01-01;
//! EASA's CS-FSTD(A) was not to be had. Entries that compare periods and damping ratios (2.c.9 phugoid, 2.d.7 Dutch roll)
//! are not among them: what is compared here is a response over time.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::flight::{Dimension, PhysicalQuantity, Unit};

/// What a response may deviate by.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Tolerance {
    /// Of which quantity.
    pub quantity: PhysicalQuantity,
    /// SI
    pub absolute: f64,
    /// Share of the measured value, whichever of the two is larger; 0: none.
    pub relative: f64,
    /// The entry of Table A2A.
    pub entry: &'static str,
    /// The test, and the tolerance in words.
    pub words: &'static str,
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;
/// m/s²
const GRAVITY: f64 = 9.806_65;

const TOLERANCES: [Tolerance; 6] = [
    Tolerance {
        quantity: PhysicalQuantity::PitchRate,
        absolute: 2.0 * DEGREE,
        relative: 0.0,
        entry: "2.c.10",
        words: "short-period dynamics: pitch rate ±2 deg/s",
    },
    Tolerance {
        quantity: PhysicalQuantity::PitchAngle,
        absolute: 1.5 * DEGREE,
        relative: 0.0,
        entry: "2.c.10",
        words: "short-period dynamics: pitch angle ±1.5 deg",
    },
    Tolerance {
        quantity: PhysicalQuantity::AccelerationZ,
        absolute: 0.1 * GRAVITY,
        relative: 0.0,
        entry: "2.c.10",
        words: "short-period dynamics: normal acceleration ±0.1 g",
    },
    Tolerance {
        quantity: PhysicalQuantity::RollRate,
        absolute: 2.0 * DEGREE,
        relative: 0.1,
        entry: "2.d.2",
        words: "roll response: roll rate ±2 deg/s or ±10 %",
    },
    Tolerance {
        quantity: PhysicalQuantity::YawRate,
        absolute: 2.0 * DEGREE,
        relative: 0.1,
        entry: "2.d.6",
        words: "rudder response: yaw rate ±2 deg/s or ±10 %",
    },
    Tolerance {
        quantity: PhysicalQuantity::RollAngle,
        absolute: 2.0 * DEGREE,
        relative: 0.1,
        entry: "2.d.4",
        words: "spiral stability: bank angle ±2 deg or ±10 % over 20 s",
    },
];

/// How a response compares with its tolerance, sample by sample; noise of the measurement counts against the model.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ToleranceHeld {
    /// The entry of 14 CFR Part 60, Appendix A, Table A2A.
    #[schema(example = "2.c.10")]
    pub entry: String,
    /// The test, and the tolerance in words.
    #[schema(example = "short-period dynamics: pitch rate ±2 deg/s")]
    pub tolerance: String,
    /// SI
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub largest_deviation: f64,
    /// Share of the samples that are there and within the tolerance.
    #[schema(example = 0.998)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub share_within: f64,
}

impl Tolerance {
    /// That of a quantity in this SI unit; none where there is none.
    pub fn of(quantity: PhysicalQuantity, unit: &str) -> Option<Self> {
        let mut all = TOLERANCES.into_iter();
        let tolerance = all.find(|tolerance| tolerance.quantity == quantity)?;
        let dimension = Unit::parse(unit).ok()?.dimension;
        let is_load_factor =
            quantity == PhysicalQuantity::AccelerationZ && dimension == Dimension::NONE;
        Some(match is_load_factor {
            true => Self {
                absolute: tolerance.absolute / GRAVITY,
                ..tolerance
            },
            false => tolerance,
        })
    }

    /// How measured values and residuals compare with it; missing ones do not count.
    pub fn held(&self, measured: &[f64], residual: &[f64]) -> ToleranceHeld {
        let (mut largest, mut within, mut samples) = (0.0_f64, 0, 0);
        for (residual, measured) in (residual.iter().zip(measured)).filter(|(r, _)| r.is_finite()) {
            let bound = self.absolute.max(self.relative * measured.abs());
            largest = largest.max(residual.abs());
            within += usize::from(residual.abs() <= bound);
            samples += 1;
        }
        ToleranceHeld {
            entry: self.entry.to_string(),
            tolerance: self.words.to_string(),
            largest_deviation: largest,
            share_within: within as f64 / f64::from(samples.max(1)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_beyond_the_tolerance_counts_against_the_model() {
        let roll = Tolerance::of(PhysicalQuantity::RollRate, "rad/s").expect("a tolerance");
        // within by size, within by share, beyond, missing
        let held = roll.held(&[0.0, 1.0, 1.0, f64::NAN], &[0.03, 0.09, -0.2, f64::NAN]);
        assert_eq!(held.largest_deviation, 0.2);
        assert!((held.share_within - 2.0 / 3.0).abs() < 1e-12);
        assert_eq!(held.entry, "2.d.2");
    }

    #[test]
    fn a_load_factor_is_counted_in_g() {
        let az = |unit| Tolerance::of(PhysicalQuantity::AccelerationZ, unit).expect("one");
        assert!((az("m/s^2").absolute - 0.980_665).abs() < 1e-12);
        assert!((az("-").absolute - 0.1).abs() < 1e-12);
        assert_eq!(Tolerance::of(PhysicalQuantity::Airspeed, "m/s"), None);
    }
}
