//! What the way forward of the adjoint keeps for the way back.

/// States on the way forward, one for each block, from which the way back starts anew.
#[derive(Clone, Debug, Default)]
pub(crate) struct Checkpoints {
    pub(super) elapsed: Vec<f64>,
    /// By block, then state.
    pub(super) states: Vec<f64>,
    /// Where outputs have paths, all that went into them: by output, then sample.
    pub(super) outputs: Vec<Vec<f64>>,
}

impl Checkpoints {
    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        let series = std::iter::once(&self.elapsed).chain([&self.states]);
        let series = series.chain(&self.outputs);
        series.map(|series| size_of_val(series.as_slice())).sum()
    }
}
