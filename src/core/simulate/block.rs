//! What a run along a segment hands on, a block of samples at a time.

use super::columns::Columns;
use super::pack::{Pack, packs};
use crate::model::BLOCK;

/// Outputs and sensitivities of some consecutive samples.
pub struct Block<'a> {
    /// Index of the first sample.
    pub first: usize,
    /// Number of samples.
    pub len: usize,
    /// By output.
    pub(super) outputs: &'a [[f64; BLOCK]],
    pub(super) columns: &'a Columns,
    pub(super) rows: &'a [&'a [Pack]],
}

impl Block<'_> {
    /// y of one output, sample by sample.
    pub fn output(&self, output: usize) -> &[f64] {
        &self.outputs[output][..self.len]
    }

    /// ∂y/∂θ of one output at sample `k` of the block, in the order of [`Columns::of_output`].
    pub fn row(&self, output: usize, k: usize) -> &[f64] {
        let width = self.columns.of_output(output).len();
        let stride = packs(width);
        &self.rows[output][k * stride..(k + 1) * stride].as_flattened()[..width]
    }

    /// All rows of one output, each padded with zeros to whole packs.
    pub fn packed_rows(&self, output: usize) -> &[Pack] {
        let stride = packs(self.columns.of_output(output).len());
        &self.rows[output][..self.len * stride]
    }
}
