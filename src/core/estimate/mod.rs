//! Estimation by output error, filter error and equation error, the first and last in the frequency domain, too: start,
//! cost, steps, iterations, error bounds.
//!
//! [`Problem`] is a model with its data, [`estimate`] finds the θ that its options ask for: with [`output_error()`], from
//! a start that is found first, the θ of least negative log-likelihood
//!
//! ```text
//! J(θ, R) = ½ Σ_k (z_k − y_k)ᵀ R⁻¹ (z_k − y_k) + (N/2) ln|R| + (N n_y/2) ln 2π
//! ```
//!
//! [`filter_error()`] does so with one-step predictions in place of the simulation, for states that are disturbed,
//! and [`Estimate`] is the answer, with the reason why the solver stopped.
//!
//! Rooms stand on floors, each on those before it and none on one behind it:
//!
//! ```text
//! options      what a user may ask of an estimation
//! report       what an estimation answers: types alone
//! problem      a model with its data and unknowns
//! linear       sums of products, and what is solved with them
//! likelihood   R, cost, gradient and information from sums
//! evaluation   one look at the data for a θ; derivatives
//! descent      from one θ to the next until there is a reason to stop
//! accuracy     what the estimate is worth: bounds, colour, identifiability, modes, fit
//! answer       estimate and time histories, put together at the end
//! regression   the problem of equation error
//! start        where to begin; multiple shooting
//! output_error, filter_error, frequency, study
//! intervals    confidence intervals from many refits
//! findings     what a reader of the answer should know beside its numbers
//! ```
//!
//! Invariant: the same problem gives the same estimate to the last bit, and a solver that stops says why.

mod accuracy;
mod answer;
mod coefficients;
mod descent;
mod equation_error;
mod estimator;
mod evaluation;
mod filter_error;
mod findings;
mod frequency;
mod intervals;
mod likelihood;
mod linear;
mod monte_carlo;
mod options;
mod output_error;
mod prediction;
mod problem;
mod regression;
mod report;
mod simulated;
mod start;
pub mod study;
mod trajectory;

pub use crate::flight::five_digits;
pub(crate) use accuracy::covariance::Estimated;
pub(crate) use accuracy::state_matrix::is_kinematic;
pub use answer::Solution;
pub use coefficients::{Coefficient, coefficients};
pub use descent::quasi_newton;
pub use equation_error::equation_error;
pub(crate) use equation_error::has_equation_error;
pub use estimator::estimate;
pub use evaluation::derivatives;
pub use evaluation::evaluator::Evaluator;
pub use evaluation::normal_equations::NormalEquations;
pub(crate) use filter_error::process_noise_names;
pub use filter_error::{FilterEquations, FilterEvaluator, filter_error};
pub(crate) use frequency::{band_frequencies, path_ends};
pub use frequency::{equation_error_frequency, output_error_frequency};
pub use monte_carlo::{DRAWS, MonteCarlo};
pub use options::error_bounds::ErrorBoundsKind;
pub use options::estimator::Estimator;
pub use options::frequency::{Ends, FrequencyOptions, Trend};
pub use options::intervals::IntervalOptions;
pub use options::process_noise::ProcessNoise;
pub use options::role::Role;
pub use options::start::StartMethod;
pub use options::steps::{Auto, StepsPerSample};
pub use options::technique::{Derivatives, Scaling};
pub use options::{Method, Noise, NoiseStructure, Options};
pub use output_error::output_error;
pub use prediction::{Validation, predict};
pub use problem::Problem;
pub(crate) use problem::substeps::REACH;
pub use problem::substeps::TooStiff;
pub use problem::unknowns::{Unknown, Unknowns};
pub use problem::unusable::Unusable;
pub(crate) use regression::local_fit::LocalFit;
pub(crate) use regression::measured::{MeasuredState, measured_states};
pub(crate) use regression::regressed;
pub use report::collinear::CollinearSet;
pub use report::estimate::Estimate;
pub use report::filter::{FilterEstimate, Pole, ProcessNoiseEstimate, SegmentGain};
pub use report::fit::{FitSummary, OutputFit, TheilShares};
pub use report::frequency::{FrequencyEstimate, FrequencyFit, SegmentBand};
pub use report::history::{OutputSeries, Series, TimeHistory};
pub use report::identifiability::{
    CorrelatedPair, DataInformation, Identifiability, NearlyCollinearSet,
};
pub use report::integration::{HalvedSteps, Integration};
pub use report::intervals::{
    Bootstrap, ConfidenceInterval, ConfidenceIntervals, IntervalEnd, IntervalMethod,
    MonteCarloFits, ParameterIntervals,
};
pub use report::iteration::{Iteration, Outcome};
pub(crate) use report::mode::root;
pub use report::mode::{Measure, Mode, ModeName};
pub use report::parameter::{Bound, ParameterEstimate};
pub use report::prediction::Prediction;
pub use report::progress::{Observer, Progress, Watcher};
pub use report::start::{StartKind, StartReport};
pub use simulated::{NoSimulation, SimulatedQuantity, SimulatedSegment, simulate_estimate};
pub use trajectory::{QuantityKind, Trajectory, TrajectorySeries, trajectories};
