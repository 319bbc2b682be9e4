//! Doublets and 3-2-1-1 inputs, their unit of time scaled to a mode.
//!
//! The energy of a doublet with pulses of Δ is largest at ω Δ = 2.33; that of a 3-2-1-1 is above half its largest from 0.3 to
//! 2.6, and a mode at ω Δ = 1.6 is in the upper part of the band (Jategaonkar, Flight Vehicle System Identification, 2nd ed., 2015, eq.
//! 2.8 to 2.11).

use super::flight::Flight;
use super::spec::MultistepShape;
use crate::dynamics::{Oscillation, oscillations};
use crate::flight::Fault;
use crate::simulate::InputDesign;

/// ω Δ of a shape.
fn normalised_frequency(shape: MultistepShape) -> f64 {
    match shape {
        MultistepShape::ThreeTwoOneOne => 1.6,
        MultistepShape::Doublet => 2.3,
    }
}

/// The unit of time for a natural frequency, a whole number of samples.
pub(super) fn unit_time(shape: MultistepShape, natural_frequency: f64, step: f64) -> f64 {
    let wanted = normalised_frequency(shape) / natural_frequency;
    (wanted / step).round().max(1.0) * step
}

/// An input of the shape.
pub(super) fn input(
    shape: MultistepShape,
    start: f64,
    unit_time: f64,
    amplitude: f64,
) -> InputDesign {
    match shape {
        MultistepShape::ThreeTwoOneOne => InputDesign::ThreeTwoOneOne {
            start,
            unit_time,
            amplitude,
        },
        MultistepShape::Doublet => InputDesign::Doublet {
            start,
            unit_time,
            amplitude,
        },
    }
}

/// How many units of time it lasts.
pub(super) fn units(shape: MultistepShape) -> f64 {
    match shape {
        MultistepShape::ThreeTwoOneOne => 7.0,
        MultistepShape::Doublet => 2.0,
    }
}

/// Beside the most that an input moves any oscillation: less is rounding.
const MOVES: f64 = 1e-6;

/// The natural frequency of the fastest oscillation that the input moves, rad/s.
///
/// # Errors
/// There is none.
pub(super) fn fastest(flight: &Flight, input: usize) -> Result<f64, Fault> {
    let found = oscillations(flight.model(), &flight.parameters, &flight.trim);
    let found: Vec<Oscillation> = found.unwrap_or_default();
    let moved = |one: &&Oscillation| one.moved_by[input] > MOVES;
    let first = found.iter().find(moved).map(|one| one.natural_frequency);
    first.ok_or_else(|| {
        let name = &flight.model().inputs[input].name;
        let message = format!(
            "at its a priori values the model has no oscillation that {name} moves: say its \"natural_frequency\", rad/s"
        );
        Fault::new("/natural_frequency", "no_oscillation", message)
    })
}
