//! Missing samples: where an output has no value (NaN) it does not count, neither its residual nor its row of
//! ∂y/∂θ. Channels at different rates are a case of it.

use super::problem::Problem;
use crate::simulate::{Block, Pack, Segment};

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

/// Leaves missing samples out of a block: their residuals and rows become zero, so that sums run over whole
/// blocks all the same. Blocks in which nothing is missing are not touched.
pub(super) struct Missing {
    /// By output: does it lack a value anywhere in the problem?
    incomplete: Vec<bool>,
    /// By output: its rows in this block, zero where it has no value; empty where nothing is missing.
    masked: Vec<Vec<Pack>>,
}

impl Missing {
    pub(super) fn new(problem: &Problem) -> Self {
        let samples = problem.samples();
        let counts = problem.counts.iter();
        Self {
            incomplete: counts.map(|&count| count < samples).collect(),
            masked: vec![Vec::new(); problem.counts.len()],
        }
    }

    pub(super) fn leave_out(
        &mut self,
        block: &Block<'_>,
        segment: &Segment,
        residuals: &mut [Vec<f64>],
    ) {
        let incomplete = (0..self.masked.len()).filter(|&i| self.incomplete[i]);
        for i in incomplete {
            let rows = &mut self.masked[i];
            rows.clear();
            let measured = &segment.measured[i][block.first..block.first + block.len];
            if !measured.iter().any(|z| z.is_nan()) {
                continue;
            }
            rows.extend_from_slice(block.packed_rows(i));
            let stride = rows.len() / block.len;
            for k in (0..block.len).filter(|&k| measured[k].is_nan()) {
                residuals[i][k] = 0.0;
                rows[k * stride..(k + 1) * stride].fill(Pack::default());
            }
        }
    }

    /// The packed rows of an output in the block that was last given to [`Self::leave_out`].
    pub(super) fn rows<'a>(&'a self, block: &'a Block<'_>, output: usize) -> &'a [Pack] {
        if self.masked[output].is_empty() {
            block.packed_rows(output)
        } else {
            &self.masked[output]
        }
    }
}
