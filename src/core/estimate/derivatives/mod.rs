//! Derivative techniques: ∂y/∂θ by differences or complex steps, or the gradient of the cost by the adjoint.
//!
//! The default, forward sensitivities, is `simulate::Sensitivities`. Differences and complex steps give the same
//! rows of ∂y/∂θ, and so the same steps, to their own accuracy; the adjoint gives cost and gradient alone.
//! Machado 2022, chapter 4.

mod adjoint;
mod central_difference;
mod complex_step;
mod forward_difference;
mod perturbation;
mod technique;

pub use adjoint::CostAndGradient;
pub use central_difference::CentralDifference;
pub use complex_step::ComplexStep;
pub use forward_difference::ForwardDifference;
pub use perturbation::{Perturbation, STRETCH, columns};
pub(super) use perturbation::{size, sums};
pub use technique::{Derivatives, Scaling};
