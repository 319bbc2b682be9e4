//! Delayed inputs: what is recorded, as the equations are to see it for a θ.

use std::borrow::Cow;

use super::interpolation::Axis;
use super::segment::Segment;
use crate::model::Model;

/// Most samples that an input or output may be delayed by, either way.
pub(crate) const MOST_DELAY: f64 = 1000.0;

/// The segment with its delayed inputs u replaced by v = u(t - D0) - ρ D0, and the ρ = -du/dt at t - D0 behind all
/// inputs, where D0 = D(θ); see [`crate::model::Delays`]. A model without delayed inputs sees what is recorded.
pub(crate) fn driven<'s>(model: &Model, segment: &'s Segment, delays: &[f64]) -> Cow<'s, Segment> {
    if model.delays.inputs.is_empty() || segment.is_empty() {
        return Cow::Borrowed(segment);
    }
    let axis = Axis::new(segment);
    let mut inputs = segment.inputs.clone();
    for (&input, &delay) in model.delays.inputs.iter().zip(delays) {
        let recorded = &segment.inputs[input];
        let at = |k: usize| {
            let (value, rate) = axis.recorded(recorded, axis.before(k, delay));
            (value + rate * delay, -rate)
        };
        let (values, rates) = (0..segment.len()).map(at).unzip();
        inputs[input] = values;
        inputs.push(rates);
    }
    Cow::Owned(Segment {
        label: String::new(),
        time: segment.time.clone(),
        steps: segment.steps.clone(),
        inputs,
        // nothing that is driven looks at what is measured
        measured: Vec::new(),
    })
}

/// The first delay of `model` that is out of bounds in a segment: none may be longer than [`MOST_DELAY`] samples,
/// or no number. By its place in [`crate::model::Delays::at`].
pub(crate) fn delay_out_of_bounds(
    model: &Model,
    segment: &Segment,
    parameters: &[f64],
) -> Option<usize> {
    if model.delays.is_empty() {
        return None;
    }
    let most = MOST_DELAY * Axis::new(segment).mean_step();
    let delays = model.delays.at(parameters);
    delays
        .iter()
        .position(|delay| delay.is_nan() || delay.abs() > most)
}
