//! A start for the iteration.

/// A start for the iteration.
pub(crate) struct Start {
    /// SI, within bounds.
    pub theta: Vec<f64>,
    /// Somebody asked to stop on the way.
    pub stopped: bool,
    /// Multiple shooting has not been tried, and may be where the iteration from here fails.
    pub may_shoot: bool,
}
