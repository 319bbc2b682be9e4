//! Designs as they are told.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::simulate::Scenario;

/// One input of a designed maneuver.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct DesignedInput {
    /// As the model calls it.
    #[schema(example = "de")]
    pub name: String,
    /// That of the scenario.
    #[schema(example = "deg")]
    pub unit: String,
    /// The deflection at each time, trim included.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub values: Vec<f64>,
    /// The largest deflection from trim.
    pub peak: f64,
    /// Root mean square of the deflection from trim, over the maneuver.
    pub rms: f64,
    /// Integral of the square of the deflection from trim, unit² s.
    pub energy: f64,
    /// The largest rate, per second, from trim one step before the first sample on.
    pub rate: f64,
    /// (largest − smallest)/(2 √2 rms): 1 of a sine, and what a low one costs for the same power. Absent where it does not move.
    pub relative_peak_factor: Option<f64>,
    /// Of a multisine: its harmonics of the period.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub harmonics: Vec<usize>,
}

/// How far an output moves.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct DesignedResponse {
    /// As the model calls it.
    #[schema(example = "alpha")]
    pub name: String,
    /// That of the scenario.
    #[schema(example = "deg")]
    pub unit: String,
    /// The largest departure from its first value.
    pub departure: f64,
}

/// What a maneuver will tell of a parameter.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct PredictedBound {
    /// As the model calls it.
    #[schema(example = "Ma")]
    pub name: String,
    /// Its own.
    #[schema(example = "1/s^2")]
    pub unit: String,
    /// The a priori value.
    pub value: f64,
    /// Cramér-Rao bound: the least standard error of an unbiased estimate from this maneuver alone, all free parameters estimated
    /// with it. Absent where the maneuver does not tell it, or not from others.
    pub standard_error: Option<f64>,
    /// As a share of the value.
    pub relative: Option<f64>,
    /// The parameter whose error is most correlated with its own, and the correlation, where that is above 0.9.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub correlated: Option<CorrelatedBound>,
}

/// Another parameter whose errors go with those of one.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct CorrelatedBound {
    /// The other parameter.
    #[schema(example = "Zq")]
    pub name: String,
    /// From -1 to 1.
    pub correlation: f64,
}

/// A maneuver, ready to be flown, and what it will tell.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct DesignedManeuver {
    /// As it was asked for.
    pub name: String,
    /// Seconds from its start.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub time: Vec<f64>,
    /// All inputs of the model.
    pub inputs: Vec<DesignedInput>,
    /// All outputs.
    pub responses: Vec<DesignedResponse>,
    /// All free parameters.
    pub parameters: Vec<PredictedBound>,
    /// ln det of the covariance of the parameters that maneuvers share, SI; absent where the maneuver does not tell all of them.
    pub ln_det_covariance: Option<f64>,
    /// Of a multistep: the natural frequency that it was scaled to, rad/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub natural_frequency: Option<f64>,
    /// Of a multistep: its unit of time, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit_time: Option<f64>,
    /// What its amplitudes were multiplied by, so that responses keep within their limits; 1: as asked for.
    pub reduced_to: f64,
    /// Of an optimal design: how many patterns were simulated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub simulations: Option<usize>,
    /// The maneuver as a scenario, to be simulated.
    #[schema(value_type = Object)]
    pub scenario: Scenario,
}

/// What all maneuvers tell of a parameter together.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct SharedBound {
    /// As the model calls it.
    #[schema(example = "Ma")]
    pub name: String,
    /// Its own.
    #[schema(example = "1/s^2")]
    pub unit: String,
    /// Cramér-Rao bound of an estimate from all maneuvers in one job.
    pub standard_error: Option<f64>,
    /// The maneuver that tells it best by itself.
    pub best: Option<String>,
    /// By maneuver: its bound alone as a share of the a priori value, or absent; see [`PredictedBound`].
    pub relative: IndexMap<String, Option<f64>>,
}

/// All maneuvers of a plan.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Designs {
    /// In the order of the plan.
    pub maneuvers: Vec<DesignedManeuver>,
    /// Parameters that maneuvers share: which maneuver tells which, and all together.
    pub together: Vec<SharedBound>,
}

impl DesignedManeuver {
    /// Time and inputs as CSV with names and units in the header, for the computer that flies them.
    pub fn to_csv(&self) -> String {
        let mut text = String::from("t[s]");
        for input in &self.inputs {
            text += &format!(",{}[{}]", input.name, input.unit);
        }
        text.push('\n');
        for (k, time) in self.time.iter().enumerate() {
            // times are multiples of a step: digits of rounding are not shown
            text += &format!("{}", (time * 1e9).round() / 1e9);
            for input in &self.inputs {
                text += &format!(",{}", input.values[k]);
            }
            text.push('\n');
        }
        text
    }
}
