//! Trim: states and inputs at which a model is in steady flight.
//!
//! ```text
//! F(z) = 0,  z = (x, u),  F = (f_i(x, u, θ) − ẋ_i wanted,  g_j(x, u, θ) − value held)
//! z ← z − (JᵀJ + λ D)⁻¹ Jᵀ F,  D = diag(JᵀJ)        (Marquardt, J. SIAM 11 (1963) 431; z stays within its limits)
//! dz/dθ = −J⁺ ∂F/∂θ,  σ² = dᵀ P d
//! ```
//!
//! Rates of states are zero unless it is said otherwise; what is held is any state, input, definition or output. Derivatives are
//! the exact ones of the compiled model. Where the conditions leave quantities open (the heading, the altitude), these stay
//! where the search began, and are named. Signal paths are left out: in steady flight lags and delays change nothing.

mod conditions;
pub(super) mod equations;
mod report;
mod solver;
mod spec;
mod trimmed;

pub use report::{Trim, TrimCondition, TrimKind, TrimOutcome, TrimQuantity};
pub use spec::{TrimSpec, TrimValue};

use super::linearisation::find_segment;
use super::no_linear_system::NoLinearSystem;
use crate::estimate::{Estimate, Estimated, Problem};
use crate::flight::{Fault, Faults};
use crate::model::Model;
use report::report;
use trimmed::Trimmed;

/// The trim of a model with these parameters, SI.
///
/// # Errors
/// Every name and unit in `spec` that does not fit the model, by its JSON pointer; a start at which the equations give no numbers.
pub fn trim(model: &Model, parameters: &[f64], spec: &TrimSpec) -> Result<Trim, Faults> {
    Ok(report(&Trimmed::find(model, parameters, spec)?, |_| None))
}

/// The trim of an estimate, with the standard errors that the covariance of the parameters carries over; what belongs to
/// a maneuver is as it is in the segment of this label, or in the first.
///
/// # Errors
/// As [`trim`]; there is no such segment.
pub fn trim_of_estimate(
    problem: &Problem,
    estimate: &Estimate,
    label: Option<&str>,
    spec: &TrimSpec,
) -> Result<Trim, Faults> {
    let unknown =
        |why: NoLinearSystem| vec![Fault::new("/segment", "unknown_segment", why.to_string())];
    let segment = find_segment(problem, label).map_err(unknown)?;
    let estimated = Estimated::of(problem, estimate);
    let mut parameters = Vec::new();
    (estimated.unknowns).parameters(segment, &estimated.theta, &mut parameters);
    let trimmed = Trimmed::find(&problem.model, &parameters, spec)?;
    // by parameter of the model to by place of θ
    let error = |slopes: &[f64]| {
        let mut by_place = vec![0.0; estimated.theta.len()];
        for (parameter, slope) in slopes.iter().enumerate() {
            if let Some(place) = estimated.unknowns.place(segment, parameter) {
                by_place[place] += slope;
            }
        }
        estimated.standard_error(&by_place)
    };
    Ok(report(&trimmed, error))
}
