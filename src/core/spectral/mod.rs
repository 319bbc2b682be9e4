//! Fourier transforms of sampled signals of finite length: at any frequencies, and as integrals over time.
//!
//! ```text
//! X(f) = ∫_0^T x(t) exp(-2πi f t) dt
//! ```
//!
//! [`FourierIntegral`] works it out for a band of evenly spaced frequencies, whatever the length of the record, with what a
//! signal does between its samples taken into account. It rests on the chirp-z transform, which is here too, and
//! this on the fast Fourier transform. Signals are numbers without names or units.
//!
//! Invariant: the same signal gives the same transform to the last bit.

mod chirp_z;
mod frequencies;
mod integral;
mod inverse;
mod moments;
mod running;

pub use chirp_z::ChirpZ;
pub use frequencies::Frequencies;
pub use integral::{Between, FourierIntegral};
pub use inverse::invert;
pub use moments::{line_integral, power_integrals};
pub use running::RunningTransform;
