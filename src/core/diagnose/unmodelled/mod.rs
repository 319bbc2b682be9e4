//! The unmodelled force: what is left of the residual, as an acceleration in one equation (or the increment of a
//! coefficient, or the error of an output) over time, and what it depends on.
//!
//! A force in one equation is a sum of smooth shapes in time. Its sizes are estimated by generalised least squares with
//! all that is free in the model projected out, and a prior of smoothness whose weight the marginal likelihood chooses.
//! How well each equation's force explains the residual says where something is missing, whether or not any
//! catalogue has a name for it: [`left_over`]. [`picture`] shows it.

mod curve;
mod dependence;
mod equations;
mod explained;
mod flown;
mod left_over;
mod metric;
mod normal;
mod parts;
mod picture;
mod proposals;
mod quantities;
mod report;
mod responses;
mod sentence;
mod shapes;
mod smoothness;
mod spectrum;
mod splines;
#[cfg(test)]
mod tests;

pub use report::{
    ForceCurve, ForceDependence, ForceElsewhere, ForceHistory, ForceIn, ForceInterval,
    ForceSpectrum, Unmodelled,
};

pub(super) use picture::{Picture, found, found_beyond};
