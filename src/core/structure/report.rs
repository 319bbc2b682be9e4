//! What a structure determination answers.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::options::StructureMethod;

/// Why a search ended that was stopped.
pub(super) const STOPPED: &str = "the search was stopped on request";

/// The terms that an equation needs, and how they were found.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Structure {
    /// The output whose equation it is.
    #[schema(example = "Cm")]
    pub output: String,
    /// How terms were chosen.
    pub method: StructureMethod,
    /// How many terms there were to choose from, the constant not counted.
    #[schema(example = 9)]
    pub candidates: usize,
    /// Samples, over all segments.
    #[schema(example = 501)]
    pub samples: usize,
    /// Each step, from the constant alone on.
    pub steps: Vec<StructureStep>,
    /// Number of the step whose terms were kept.
    #[schema(example = 3)]
    pub kept: usize,
    /// The terms with their estimates by least squares, the constant (`1`) first.
    pub terms: Vec<Term>,
    /// The equation with its parameters by name, as the model has it.
    #[schema(example = "Cm_1 + Cm_alpha*alpha + Cm_de*de")]
    pub equation: String,
    /// Why there are no more terms and no fewer.
    pub reason: String,
    /// Terms that are not numbers everywhere, or one number, and terms that those kept explain: an equation with them in place of
    /// these may fit as well.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<String>,
}

/// One step of a structure determination.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct StructureStep {
    /// From 0.
    #[schema(example = 1)]
    pub number: usize,
    /// What was done.
    pub verdict: StepVerdict,
    /// The term that came in or went out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "alpha")]
    pub term: Option<String>,
    /// Its partial F: of a term that came in, with it in the model; of one that went out, before that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = 812.4)]
    pub partial_f: Option<f64>,
    /// Correlation of the term that came in with what was left of the output, both less what the terms before it explain.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = 0.94)]
    pub partial_correlation: Option<f64>,
    /// Coefficient of determination, R².
    #[schema(example = 0.871)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub r_squared: f64,
    /// Mean squared error of the fit.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub mse: f64,
    /// s², the variance of the residual: Σe²/(N - p).
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub variance: f64,
    /// Predicted squared error.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub pse: f64,
    /// Prediction sum of squares, each sample predicted from all others.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub press: f64,
    /// The terms after the step, the constant (`1`) first.
    pub terms: Vec<Term>,
}

/// What was done in a step.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum StepVerdict {
    /// The model before the first term.
    Start,
    /// A term came in.
    Entered,
    /// A term went out.
    Removed,
}

impl StepVerdict {
    /// As it is written in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Entered => "entered",
            Self::Removed => "removed",
        }
    }
}

/// A term and its parameter.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Term {
    /// As it is written; `1` is the constant.
    #[schema(example = "alpha*de")]
    pub term: String,
    /// The least-squares estimate of its parameter, SI.
    #[schema(example = -0.742)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub estimate: f64,
    /// For white residuals: s √((XᵀX)⁻¹_ii).
    #[schema(example = 0.011)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub standard_error: f64,
    /// (estimate/standard_error)²
    #[schema(example = 4550.1)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub partial_f: f64,
}
