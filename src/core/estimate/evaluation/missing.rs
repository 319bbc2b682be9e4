//! Missing samples: where an output has no value (NaN) it does not count, neither its residual nor its row of
//! ∂y/∂θ. Channels at different rates are a case of it.

use crate::estimate::problem::Problem;
use crate::simulate::{Block, Pack, Segment};

/// Leaves missing samples out of a block: their residuals and rows become zero, so that sums run over whole
/// blocks all the same. Blocks in which nothing is missing are not touched.
pub(crate) struct Missing {
    /// By output: does it lack a value anywhere in the problem?
    incomplete: Vec<bool>,
    /// By output: its rows in this block, zero where it has no value; empty where nothing is missing.
    masked: Vec<Vec<Pack>>,
}

impl Missing {
    pub(crate) fn new(problem: &Problem) -> Self {
        let samples = problem.samples();
        let counts = problem.counts.iter();
        Self {
            incomplete: counts.map(|&count| count < samples).collect(),
            masked: vec![Vec::new(); problem.counts.len()],
        }
    }

    pub(crate) fn leave_out(
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
    pub(crate) fn rows<'a>(&'a self, block: &'a Block<'_>, output: usize) -> &'a [Pack] {
        if self.masked[output].is_empty() {
            block.packed_rows(output)
        } else {
            &self.masked[output]
        }
    }
}
