//! What an estimated model does about its trim: linear system, transfer functions, frequency responses, flying qualities.
//!
//! ```text
//! dx/dt = A x + B u(t − τ_u),  y(t + τ_y) = C x + D u,   H(s) = e^(−(τ_u + τ_y) s) (D + C (s − A)⁻¹ B)
//! ```
//!
//! A, B, C, D are exact derivatives of the model's equations at the start of a segment, where a maneuver is trimmed, and
//! delays and lags of signal paths stand beside them as they are. Each number has the standard error that the covariance P
//! of the parameters carries over to it: σ² = dᵀ P d, with its exact derivatives d by θ (the delta method).
//!
//! ```text
//! signal              an input or output: name, quantity, lag, delay
//! linearisation       A, B, C, D and their derivatives by θ
//! linear_system       the same as a report
//! channel             one input and one output: poles, zeros, gain, H(jω)
//! transfer_function, frequency_response   reports of a channel
//! equivalent_system   a transfer function of low order with a delay, fitted to H(jω)
//! bandwidth           attitude bandwidth and phase delay
//! level               levels of flying qualities
//! flying_qualities    all of these, for the controls and motions that a model has
//! trim                states and inputs of a steady flight
//! ```
//!
//! Invariant: nothing here estimates; an estimate goes in, and numbers with standard errors come out.

mod bandwidth;
mod channel;
mod equivalent_system;
mod flying_qualities;
mod frequency_response;
mod level;
mod linear_system;
mod linearisation;
mod mat;
mod no_linear_system;
mod oscillation;
mod polynomial;
mod root;
mod signal;
mod transfer_function;
mod trim;

pub use bandwidth::Bandwidth;
pub use equivalent_system::{EquivalentForm, EquivalentSystem};
pub use flying_qualities::{FlyingQualities, FlyingQualityQuestion, flying_qualities};
pub use frequency_response::{
    FrequencyQuestion, FrequencyResponse, FrequencyUnit, frequency_responses,
};
pub use level::{AirplaneClass, Criterion, FlightPhaseCategory};
pub use linear_system::{
    LinearSignal, LinearState, LinearSystem, MatrixEstimate, NamedMatrix, linear_system,
};
pub use mat::linear_system_as_mat;
pub use no_linear_system::NoLinearSystem;
pub(crate) use oscillation::{Oscillation, oscillations};
pub use transfer_function::{Root, TransferFunction};
pub use trim::{
    Trim, TrimCondition, TrimKind, TrimOutcome, TrimQuantity, TrimSpec, TrimValue, trim,
    trim_of_estimate,
};
