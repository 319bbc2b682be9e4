//! Outputs of a model for parameters and a maneuver.
mod method;
pub use method::{InputInterpolation, Integrator};
