//! Why there is no linear system.

/// Why there is no linear system, or not of what was asked for.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum NoLinearSystem {
    /// At the start of the segment.
    #[error(
        "a derivative of the equations is not a finite number at the start of {0}, where the model is linearised"
    )]
    NotFinite(String),
    /// No segment, input or output of this name.
    #[error("{what}: there is no '{name}'; there is {known}")]
    Unknown {
        /// `segment`, `input` or `output`.
        what: &'static str,
        /// As it was asked for.
        name: String,
        /// Those there are.
        known: String,
    },
    /// The model has no inputs.
    #[error("the model has no inputs: there is nothing for its outputs to respond to")]
    NoInputs,
    /// Frequencies that cannot be.
    #[error("{0}")]
    Frequencies(String),
    /// With its inputs counted as parameters the model is too large to be compiled.
    #[error("the model is too large to be linearised: {0}")]
    TooLarge(String),
}
