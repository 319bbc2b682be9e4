//! Frequency responses of recorded signals: what an output does to an input, frequency by frequency, without a model.
//!
//! ```text
//! Y = Σ_j H_j X_j + N,   H = G_xx⁻¹ G_xy,   ε = √0.55 √(1 − γ²) / (|γ| √(2 n_d))
//! ```
//!
//! from cross spectra over windows that overlap by half. Where inputs are correlated, each response is conditioned on all others, and
//! γ² is its partial coherence; ε is the random error, relative, for n_d windows without overlap (Bendat and Piersol, Random
//! Data; Tischler and Remple, Aircraft and Rotorcraft System Identification, ch. 7 to 10). Windows of several lengths are put
//! together, each where its error is small. [`fitted()`] fits a transfer function with delay to a response.
//!
//! Invariant: the same recording gives the same numbers to the last bit.

mod bandwidth;
mod conditioned;
mod cross_spectra;
mod measured;
mod options;
mod report;
mod transfer_function;

pub use measured::frequency_responses;
pub use options::{ResponseOptions, TransferFunctionOrder};
pub use report::{Bandwidth, FrequencyResponse, FrequencyResponses, TransferFunction};
pub use transfer_function::fitted;
