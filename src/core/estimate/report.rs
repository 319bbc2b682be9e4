//! What an estimation answers: the outcome, the parameter table, the fit of each output.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::error_bounds::ErrorBoundsKind;
use super::filter_error::FilterEstimate;
use super::identifiability::Identifiability;
use super::modes::Mode;
use super::prediction::Prediction;
use super::role::Role;

/// Why the solver stopped. A result with a reason, apart from the job's own status.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// A further step would move the estimate by less than the tolerance.
    Converged,
    /// As converged, with at least one parameter held at its bound.
    AtBound,
    /// The data cannot tell some parameters apart, or not see them: see `collinear`.
    Singular,
    /// No step lowers the cost any more, before the tolerance was met.
    Stalled,
    /// The simulation left the range of numbers and no smaller step brought it back.
    Diverged,
    /// The budget of iterations is used up.
    Budget,
    /// Stopped on request; the best iterate is kept.
    Cancelled,
}

impl Outcome {
    /// As it is written in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::AtBound => "at_bound",
            Self::Singular => "singular",
            Self::Stalled => "stalled",
            Self::Diverged => "diverged",
            Self::Budget => "budget",
            Self::Cancelled => "cancelled",
        }
    }

    /// Whether the estimate is the minimum that was asked for.
    pub fn is_minimum(self) -> bool {
        matches!(self, Self::Converged | Self::AtBound)
    }
}

/// One iteration, as told to an observer.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Iteration {
    /// 0 is the start value; a second try, from another start, counts on.
    #[schema(example = 3)]
    pub number: usize,
    /// -ln L, the negative log-likelihood J(θ, R), plus ½ Σ ((θ - mean)/sd)² of the parameters' priors.
    #[schema(example = -4821.7)]
    pub cost: f64,
    /// det R, what the field's programs print as cost.
    #[schema(example = 8.9377e-12)]
    #[serde(deserialize_with = "null_as_nan")]
    pub det_r: f64,
    /// Variance of each output's residual, SI units squared (the diagonal of R).
    pub variance: Vec<f64>,
    /// All free parameters in the order of the parameter table, each in its own unit; with filter error the free
    /// process noises follow, in the order of the states.
    pub parameters: Vec<f64>,
    /// Length of the gradient of the cost, each component times the standard error that the parameter
    /// would have if it were the only one.
    #[serde(deserialize_with = "null_as_nan")]
    pub gradient_norm: f64,
    /// Length of the step that led here, in standard errors; 0 for the start.
    pub step: f64,
    /// Levenberg-Marquardt damping λ, relative to the scaled information matrix; 0 for Gauss-Newton.
    pub damping: f64,
    /// How often the step was shortened.
    pub halvings: usize,
}

/// The answer of an estimation job.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Estimate {
    pub outcome: Outcome,
    /// The outcome in a sentence.
    #[schema(
        example = "converged: a further step would move the estimate by 3.1e-7 standard errors"
    )]
    pub reason: String,
    /// The number of the iteration that this is.
    pub iterations: usize,
    /// Simulations with sensitivities, and simulations alone.
    pub evaluations: usize,
    pub simulations: usize,
    /// -ln L at the estimate, plus ½ Σ ((θ - mean)/sd)² of the parameters' priors.
    pub cost: f64,
    #[serde(deserialize_with = "null_as_nan")]
    pub det_r: f64,
    /// R, rows by outputs, SI units squared.
    pub noise_covariance: Vec<Vec<f64>>,
    pub outputs: Vec<OutputFit>,
    pub parameters: Vec<ParameterEstimate>,
    /// What `standard_error` and `correlation` are made from. `null` where they are left out because they would
    /// mean nothing: the model reproduces an output to rounding, which noise is not part of.
    #[serde(default = "conventional")]
    pub error_bounds: Option<ErrorBoundsKind>,
    /// Correlation of the free parameters' errors, in the order of the iterations' `parameters`. Empty when singular.
    pub correlation: Vec<Vec<f64>>,
    /// Sets of parameters that the data cannot tell apart, or cannot see.
    pub collinear: Vec<CollinearSet>,
    /// What the data can tell of the parameters, before and after.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub identifiability: Option<Identifiability>,
    /// Of segments that took no part in the estimation.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub prediction: Vec<Prediction>,
    /// Samples used, over all segments.
    pub samples: usize,
    /// What the filter-error estimator adds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub filter: Option<FilterEstimate>,
    /// Modes of the motion, fastest first; none for reconstruction models.
    #[serde(default)]
    pub modes: Vec<Mode>,
}

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ParameterEstimate {
    #[schema(example = "Malpha")]
    pub name: String,
    #[schema(example = "1/s^2")]
    pub unit: String,
    /// Which segment a per-maneuver parameter belongs to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub segment: Option<String>,
    pub start: f64,
    #[schema(example = -4.9176)]
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
    pub fixed: bool,
    /// The bound at which the parameter is held.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_bound: Option<Bound>,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    Lower,
    Upper,
}

/// How well one output is reproduced, over all segments.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct OutputFit {
    #[schema(example = "alpha")]
    pub name: String,
    /// SI unit of `rms` and `bias`.
    #[schema(example = "rad")]
    pub unit: String,
    /// Root mean square of the residual.
    pub rms: f64,
    /// Mean of the residual.
    pub bias: f64,
    /// Coefficient of determination R².
    #[serde(deserialize_with = "null_as_nan")]
    pub r_squared: f64,
    /// Theil's inequality coefficient: 0 perfect, 1 useless.
    #[serde(deserialize_with = "null_as_nan")]
    pub theil: f64,
    /// What the mean squared residual is made of.
    #[serde(default)]
    pub theil_shares: TheilShares,
    /// Autocorrelation of the residual at lag 1: near 0 where it is white.
    #[serde(default)]
    #[schema(example = 0.31)]
    pub autocorrelation: f64,
    /// How many independent values would tell as much of a mean as the residual's samples do.
    #[serde(default)]
    #[schema(example = 310.5)]
    pub effective_samples: f64,
    /// Samples that have a measured value; the others do not count.
    #[serde(default)]
    #[schema(example = 626)]
    pub samples: usize,
}

/// Theil's decomposition of the mean squared residual, shares that add up to 1 (all 0 where there is no residual).
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
pub struct TheilShares {
    /// From different means.
    #[schema(example = 0.01)]
    pub bias: f64,
    /// From different variances: motion that the model has too much or too little of.
    #[schema(example = 0.04)]
    pub variance: f64,
    /// From imperfect correlation; near 1 where only noise is left.
    #[schema(example = 0.95)]
    pub covariance: f64,
}

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct CollinearSet {
    /// One name: the data cannot see it. Several: only a combination of them shows.
    #[schema(example = json!(["a_eq", "de_eq"]))]
    pub parameters: Vec<String>,
    /// The direction in which nothing changes, by parameter, in the parameters' units, largest component 1.
    pub direction: Vec<f64>,
}

/// Measured and modelled time histories of one segment, SI.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct TimeHistory {
    pub segment: String,
    /// Whether the model was fitted to it.
    #[serde(default)]
    pub role: Role,
    /// Seconds of the recording.
    pub time: Vec<f64>,
    pub inputs: Vec<Series>,
    pub outputs: Vec<OutputSeries>,
}

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Series {
    pub name: String,
    pub unit: String,
    /// null where there is no value.
    #[schema(value_type = Vec<Option<f64>>)]
    #[serde(deserialize_with = "nulls_as_nan")]
    pub values: Vec<f64>,
}

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct OutputSeries {
    pub name: String,
    pub unit: String,
    /// null where the output has no value.
    #[schema(value_type = Vec<Option<f64>>)]
    #[serde(deserialize_with = "nulls_as_nan")]
    pub measured: Vec<f64>,
    pub model: Vec<f64>,
    /// Of a diagnosis: the declared model, without the effects that were found; empty otherwise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub declared: Vec<f64>,
    /// measured - model; null where nothing was measured.
    #[schema(value_type = Vec<Option<f64>>)]
    #[serde(deserialize_with = "nulls_as_nan")]
    pub residual: Vec<f64>,
}

/// What estimates were kept with before there was a choice.
fn conventional() -> Option<ErrorBoundsKind> {
    Some(ErrorBoundsKind::Conventional)
}

impl Estimate {
    /// What a reader of the tables should know beside them.
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        if self.error_bounds.is_none() {
            remarks.push(
                "an output is reproduced to rounding, as data without noise are: error bounds would mean nothing and are left out".to_string(),
            );
        }
        let identifiability = self.identifiability.as_ref();
        let Some(seen) = identifiability.map(|both| both.after.as_ref().unwrap_or(&both.before))
        else {
            return remarks;
        };
        for set in &seen.redundant {
            let names = set.parameters.join(" + ");
            remarks.push(format!("the data cannot tell apart: {names}"));
        }
        if !seen.unseen.is_empty() {
            remarks.push(format!("the data cannot see: {}", seen.unseen.join(", ")));
        }
        for set in &seen.nearly_collinear {
            remarks.push(format!(
                "the data hardly tell apart: {} (condition index {:.0})",
                set.parameters.join(" + "),
                set.condition_index
            ));
        }
        remarks
    }

    /// What a reader should know about a row of the parameter table, in words; mostly nothing.
    pub fn remark(&self, row: &ParameterEstimate) -> &'static str {
        match (row.fixed, row.at_bound, row.standard_error) {
            (true, ..) => "fixed",
            (_, Some(Bound::Lower), _) => "at its lower bound",
            (_, Some(Bound::Upper), _) => "at its upper bound",
            (_, _, None) if self.error_bounds.is_some() => "not determined by the data",
            _ => "",
        }
    }
}

/// JSON has no word for a number out of range: it is written `null`, and read back as NaN.
pub(super) fn null_as_nan<'de, D: serde::Deserializer<'de>>(
    deserializer: D,
) -> Result<f64, D::Error> {
    Option::<f64>::deserialize(deserializer).map(|number| number.unwrap_or(f64::NAN))
}

fn nulls_as_nan<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
    let numbers = Vec::<Option<f64>>::deserialize(deserializer)?;
    Ok(numbers
        .into_iter()
        .map(|number| number.unwrap_or(f64::NAN))
        .collect())
}

/// A number for a table: five digits, as a decimal where that is readable.
pub fn five_digits(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_string()
    } else if (1e-3..1e5).contains(&size) {
        let digits = (4 - size.log10().floor() as i32).max(0) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.4e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_out_of_range_is_read_back() {
        let fit = OutputFit {
            name: "a".into(),
            unit: "-".into(),
            rms: 0.0,
            bias: 0.0,
            r_squared: f64::NAN,
            theil: 0.5,
            theil_shares: TheilShares::default(),
            autocorrelation: 0.0,
            effective_samples: 1.0,
            samples: 3,
        };
        let read: OutputFit = serde_json::from_str(&serde_json::to_string(&fit).unwrap()).unwrap();
        assert!(read.r_squared.is_nan() && read.theil == 0.5);
        let series = OutputSeries {
            name: "a".into(),
            unit: "-".into(),
            measured: vec![1.0, f64::NAN],
            model: vec![0.5, 0.5],
            declared: Vec::new(),
            residual: vec![0.5, f64::NAN],
        };
        let text = serde_json::to_string(&series).unwrap();
        assert!(text.contains("[1.0,null]"), "{text}");
        let read: OutputSeries = serde_json::from_str(&text).unwrap();
        assert!(read.measured[0] == 1.0 && read.measured[1].is_nan());
    }

    #[test]
    fn numbers_have_five_digits() {
        let cases = [
            (-4.917_632, "-4.9176"),
            (0.020_015_48, "0.020015"),
            (130.0, "130.00"),
            (1.5e-9, "1.5000e-9"),
        ];
        for (value, text) in cases {
            assert_eq!(five_digits(value), text);
        }
        assert_eq!(five_digits(0.0), "0");
    }
}
