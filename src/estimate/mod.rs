//! Estimation by the output-error method: cost, steps, iterations, error bounds.
//!
//! [`Problem`] is a model with its data, [`output_error`] finds the θ of least negative log-likelihood
//!
//! ```text
//! J(θ, R) = ½ Σ_k (z_k − y_k)ᵀ R⁻¹ (z_k − y_k) + (N/2) ln|R| + (N n_y/2) ln 2π
//! ```
//!
//! and [`Estimate`] is the answer, with the reason why the solver stopped.

mod answer;
mod error_bounds;
mod evaluation;
mod fit;
mod information;
mod iterate;
mod likelihood;
mod local_sums;
mod options;
mod output_error;
mod problem;
mod products;
mod report;
mod step;
mod sums;
mod unknowns;

pub use answer::Solution;
pub use evaluation::{Evaluator, Unusable};
pub use likelihood::NormalEquations;
pub use options::{Method, Noise, NoiseStructure, Options};
pub use output_error::{Observer, output_error};
pub use problem::Problem;
pub use report::{
    Bound, CollinearSet, Estimate, Iteration, Outcome, OutputFit, OutputSeries, ParameterEstimate,
    Series, TimeHistory, five_digits,
};
pub use unknowns::{Unknown, Unknowns};
