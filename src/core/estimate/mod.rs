//! Estimation by output error, filter error and equation error: start, cost, steps, iterations, error bounds.
//!
//! [`Problem`] is a model with its data, [`estimate`] finds the θ that its options ask for: with [`output_error`], from
//! a start that is found first, the θ of least negative log-likelihood
//!
//! ```text
//! J(θ, R) = ½ Σ_k (z_k − y_k)ᵀ R⁻¹ (z_k − y_k) + (N/2) ln|R| + (N n_y/2) ln 2π
//! ```
//!
//! [`filter_error`] does so with one-step predictions in place of the simulation, for states that are disturbed,
//! and [`Estimate`] is the answer, with the reason why the solver stopped.

mod absorbed;
mod acceleration;
mod answer;
mod autoregression;
mod coefficients;
mod coloured_residuals;
mod definite;
pub mod derivatives;
mod elimination;
mod equation_error;
mod error_bounds;
mod estimator;
mod evaluation;
mod filter_error;
mod fit;
mod identifiability;
mod information;
mod iterate;
mod likelihood;
mod local_sums;
mod missing;
mod modes;
mod options;
mod output_error;
mod prediction;
mod priors;
mod problem;
mod process_noise;
mod products;
pub mod quasi_newton;
mod report;
mod role;
mod search;
mod second_try;
mod shooting;
mod skyline;
mod start;
mod state_matrix;
mod step;
mod stopped;
mod strand;
pub mod study;
mod sums;
mod unknowns;

pub use answer::Solution;
pub use coefficients::{Coefficient, coefficients};
pub use derivatives::{Derivatives, Scaling};
pub use equation_error::{equation_error, has_equation_error};
pub use error_bounds::ErrorBoundsKind;
pub use estimator::{Estimator, Progress, Watcher, estimate};
pub use evaluation::{Evaluator, Unusable};
pub use filter_error::{
    FilterEquations, FilterEstimate, FilterEvaluator, Pole, ProcessNoiseEstimate, SegmentGain,
    filter_error, process_noise_names,
};
pub use identifiability::{CorrelatedPair, DataInformation, Identifiability, NearlyCollinearSet};
pub use likelihood::NormalEquations;
pub use modes::{Measure, Mode};
pub use options::{Method, Noise, NoiseStructure, Options};
pub use output_error::{Observer, output_error};
pub use prediction::{Prediction, Validation, predict};
pub use problem::Problem;
pub use process_noise::ProcessNoise;
pub use report::{
    Bound, CollinearSet, Estimate, Iteration, Outcome, OutputFit, OutputSeries, ParameterEstimate,
    Series, TheilShares, TimeHistory, five_digits,
};
pub use role::Role;
pub use start::{StartKind, StartMethod, StartReport};
pub use unknowns::{Unknown, Unknowns};
