//! Inputs on their paths: what is recorded, as the equations are to see it for a θ.

use std::borrow::Cow;

use super::interpolation::Axis;
use super::method::InputInterpolation;
use super::segment::Segment;
use super::signal::Signal;
use crate::model::{Element, Model};

/// Most samples that an input or output may be delayed by, either way.
pub const MOST_DELAY: f64 = 1000.0;

/// The segment with inputs that have a path replaced by v = y(ψ0) - Σ ρ_i ψ0_i, and the ρ_i = ∂y/∂ψ_i behind all inputs,
/// where ψ0 = ψ(θ); see [`crate::model::Paths`]. A model whose inputs have no paths sees what is recorded.
pub(crate) fn driven<'s>(
    model: &Model,
    interpolation: InputInterpolation,
    segment: &'s Segment,
    sizes: &[f64],
) -> Cow<'s, Segment> {
    let elements = model.paths.of_inputs();
    if elements.is_empty() || segment.is_empty() {
        return Cow::Borrowed(segment);
    }
    let axis = Axis::new(segment);
    let mut inputs = segment.inputs.clone();
    let mut sizes = sizes;
    for passed in elements.chunk_by(|a, b| a.signal == b.signal) {
        let input = passed[0].signal;
        let (own, others) = sizes.split_at(passed.len());
        sizes = others;
        let mut signal = Signal::new(&axis, interpolation, &segment.inputs[input]);
        for (element, &size) in passed.iter().zip(own) {
            signal.pass(element.element, size);
        }
        for (slopes, size) in signal.slopes.iter().zip(own) {
            let values = signal.samples.iter_mut().zip(slopes);
            values.for_each(|(value, slope)| *value -= slope * size);
        }
        inputs[input] = signal.samples;
        inputs.extend(signal.slopes);
    }
    Cow::Owned(Segment {
        label: String::new(),
        time: segment.time.clone(),
        steps: segment.steps.clone(),
        substeps: segment.substeps,
        inputs,
        // nothing that is driven looks at what is measured
        measured: Vec::new(),
    })
}

/// The first element of `model`'s paths whose size is out of bounds in a segment, by its place in
/// [`crate::model::Paths::at`]: no number, a rate limit below 0, or a delay of more than [`MOST_DELAY`] samples.
pub(crate) fn path_out_of_bounds(
    model: &Model,
    segment: &Segment,
    parameters: &[f64],
) -> Option<usize> {
    if model.paths.is_empty() {
        return None;
    }
    let longest = MOST_DELAY * Axis::new(segment).mean_step();
    let sizes = model.paths.at(parameters);
    let mut elements = model.paths.elements().iter().zip(sizes);
    elements.position(|(passed, size)| match passed.element {
        Element::Play | Element::Lag => !size.is_finite(),
        Element::RateLimit => !(size.is_finite() && size >= 0.0),
        Element::Delay => size.is_nan() || size.abs() > longest,
    })
}
