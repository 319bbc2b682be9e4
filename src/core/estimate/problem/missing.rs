//! Missing samples: where an output has no value (NaN), nothing of it counts.

use crate::simulate::Segment;

/// How many samples of each output have a value, over all segments.
pub(super) fn counts(outputs: usize, segments: &[Segment]) -> Vec<usize> {
    let present = |output: usize| {
        segments
            .iter()
            .flat_map(|segment| &segment.measured[output])
            .filter(|z| !z.is_nan())
            .count()
    };
    (0..outputs).map(present).collect()
}

/// A residual, or what else is made of a sample; 0 where nothing was measured, whatever the model says there.
pub(crate) fn present(value: f64, measured: f64) -> f64 {
    if measured.is_nan() { 0.0 } else { value }
}
