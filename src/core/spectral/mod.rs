//! Fourier transforms of sampled signals of finite length: at any frequencies, and as integrals over time.
//!
//! ```text
//! X(f) = ∫_0^T x(t) exp(-2πi f t) dt
//! ```
//!
//! [`FourierIntegral`] works it out for a band of evenly spaced frequencies, whatever the length of the record, with what a
//! signal does between its samples taken into account. It rests on the chirp-z transform, and this on the fast Fourier
//! transform, which are here too. Signals are numbers without names or units.
//!
//! Invariant: the same signal gives the same transform to the last bit.

mod chirp_z;
mod fast_transform;
mod frequencies;
mod integral;
mod inverse;
mod moments;

pub use chirp_z::ChirpZ;
pub use fast_transform::FastTransform;
pub use frequencies::Frequencies;
pub use integral::{Between, FourierIntegral};
pub use inverse::invert;
pub use moments::line_integral;
