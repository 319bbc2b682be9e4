//! The unmodelled force: what is left of the residual, as an acceleration in one equation (or the increment of a
//! coefficient, or the error of an instrument) over time.
//!
//! A force in one equation is a sum of smooth shapes in time. Its sizes are estimated by generalised least squares with
//! all that is free in the model projected out, and a prior of smoothness whose weight the marginal likelihood chooses.
//! How well each equation's force explains the residual says where something is missing, whether or not any
//! catalogue has a name for it.

mod equations;
mod explained;
mod flown;
mod left_over;
mod metric;
mod responses;
mod shapes;
mod smoothness;
mod splines;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod truth;

#[allow(unused_imports)] // until a diagnosis asks
pub(super) use left_over::{LeftOver, left_over};
