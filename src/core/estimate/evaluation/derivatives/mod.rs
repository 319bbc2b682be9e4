//! Derivative techniques: ∂y/∂θ by differences or complex steps, or the gradient of the cost by the adjoint.
//!
//! The default, forward sensitivities, is `simulate::Sensitivities`. Differences and complex steps give the same
//! rows of ∂y/∂θ, and so the same steps, to their own accuracy; the adjoint gives cost and gradient alone.
//! Machado 2022, chapter 4.

pub(in crate::estimate) mod adjoint;
pub(in crate::estimate) mod central_difference;
pub(in crate::estimate) mod complex_step;
pub(in crate::estimate) mod forward_difference;
pub(in crate::estimate) mod perturbation;

pub use adjoint::CostAndGradient;
