//! What an estimation answers: the outcome, the parameter table, the fit of each output.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::collinear::CollinearSet;
use super::filter::FilterEstimate;
use super::fit::{FitSummary, OutputFit};
use super::frequency::FrequencyEstimate;
use super::identifiability::Identifiability;
use super::integration::Integration;
use super::intervals::ConfidenceIntervals;
use super::iteration::Outcome;
use super::mode::Mode;
use super::parameter::{Bound, ParameterEstimate};
use super::prediction::Prediction;
use crate::estimate::options::error_bounds::ErrorBoundsKind;
use crate::flight::Finding;

/// The answer of an estimation job.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Estimate {
    /// Why the solver stopped.
    pub outcome: Outcome,
    /// The outcome in a sentence.
    #[schema(
        example = "converged: a further step would move the estimate by 3.1e-7 standard errors"
    )]
    pub reason: String,
    /// The number of the iteration that this is.
    pub iterations: usize,
    /// Simulations with sensitivities.
    pub evaluations: usize,
    /// Simulations without sensitivities.
    pub simulations: usize,
    /// -ln L at the estimate, plus ½ Σ ((θ - mean)/sd)² of the parameters' priors.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub cost: f64,
    /// det R, in the product of the outputs' SI units squared; what the field's programs print as cost.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub det_r: f64,
    /// R, rows by outputs, SI units squared.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub noise_covariance: Vec<Vec<f64>>,
    /// How well each output is reproduced.
    pub outputs: Vec<OutputFit>,
    /// The parameter table: free and fixed ones, in the document's order.
    pub parameters: Vec<ParameterEstimate>,
    /// What `standard_error` and `correlation` are made from. `null` where they are left out because they would
    /// mean nothing: the model reproduces an output to rounding, which noise is not part of.
    #[serde(default = "conventional")]
    pub error_bounds: Option<ErrorBoundsKind>,
    /// Correlation of the free parameters' errors, in the order of the iterations' `parameters`. Empty when singular.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
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
    /// How the model was stepped through time; none with equation error, which does not step it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub integration: Option<Integration>,
    /// What the filter-error estimator adds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub filter: Option<FilterEstimate>,
    /// What the frequency-domain estimators add.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequency: Option<FrequencyEstimate>,
    /// Modes of the motion, fastest first; none for reconstruction models.
    #[serde(default)]
    pub modes: Vec<Mode>,
    /// 95 % confidence intervals by several methods, where `confidence_intervals` of the options asked for them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub confidence_intervals: Option<ConfidenceIntervals>,
    /// What a reader of these numbers should know: of the data in use, of the job, of the fit.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub findings: Vec<Finding>,
}

/// What estimates were kept with before there was a choice.
fn conventional() -> Option<ErrorBoundsKind> {
    Some(ErrorBoundsKind::Conventional)
}

impl Estimate {
    /// The fit in a line; nothing where there are no outputs.
    pub fn fit_summary(&self) -> Option<FitSummary> {
        FitSummary::of(&self.outputs, self.samples)
    }

    /// What a reader should know about a row of the parameter table, in words; mostly nothing.
    pub fn remark(&self, row: &ParameterEstimate) -> &'static str {
        match (row.fixed, row.at_bound, row.standard_error) {
            (true, ..) => "fixed",
            _ if row.provisional => "not converged",
            (_, Some(Bound::Lower), _) => "at its lower bound",
            (_, Some(Bound::Upper), _) => "at its upper bound",
            (_, _, None) if self.error_bounds.is_some() => "not determined by the data",
            _ => "",
        }
    }
}
