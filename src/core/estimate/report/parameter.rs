//! A row of the parameter table.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// One unknown: its start, its estimate, its error bounds, all in its own unit.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ParameterEstimate {
    /// The parameter's name.
    #[schema(example = "Malpha")]
    pub name: String,
    /// The parameter's own unit, as the document writes it.
    #[schema(example = "1/s^2")]
    pub unit: String,
    /// Which segment a per-maneuver parameter belongs to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub segment: Option<String>,
    /// The value that the estimation started from.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub start: f64,
    /// The value at the end.
    #[schema(example = -4.9176)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub estimate: f64,
    /// Standard deviation of the estimate, corrected for coloured residuals unless the job asked otherwise; absent
    /// for fixed parameters, those at a bound, and those the data cannot see.
    #[schema(example = 0.0271)]
    pub standard_error: Option<f64>,
    /// The Cramér-Rao bound: what the standard deviation would be if residuals were white.
    #[schema(example = 0.0200)]
    #[serde(default)]
    pub conventional_standard_error: Option<f64>,
    /// How much of the squared bound stems from the priors, from 0 (all from the data) to 1; absent in a job
    /// without priors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = 0.04)]
    pub prior_share: Option<f64>,
    /// Whether it was held at its start value.
    pub fixed: bool,
    /// The bound at which the parameter is held.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_bound: Option<Bound>,
    /// Whether the solver stopped short of a minimum: neither the value nor its standard error is an estimate.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub provisional: bool,
}

/// One of the two bounds of a parameter.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// The smallest value it may take.
    Lower,
    /// The largest value it may take.
    Upper,
}
