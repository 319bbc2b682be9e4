//! Choices that a user has about an estimation. They name no code that carries them out.

pub(super) mod error_bounds;
pub(super) mod estimator;
pub(super) mod frequency;
pub(super) mod intervals;
pub(super) mod process_noise;
pub(super) mod role;
pub(super) mod start;
pub(super) mod steps;
pub(super) mod technique;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::simulate::{InputInterpolation, Integrator};
use error_bounds::ErrorBoundsKind;
use estimator::Estimator;
use frequency::FrequencyOptions;
use intervals::IntervalOptions;
use process_noise::ProcessNoise;
use start::StartMethod;
use steps::StepsPerSample;
use technique::Derivatives;

/// How an estimation goes about it. Each option has a default.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Options {
    /// The principle by which parameters are estimated.
    pub estimator: Estimator,
    /// Where output error starts from.
    pub start: StartMethod,
    /// How output error and filter error step.
    pub method: Method,
    /// How the model is stepped through time.
    pub integrator: Integrator,
    /// How many integration steps lie between two samples.
    pub steps_per_sample: StepsPerSample,
    /// What inputs do between samples.
    pub input_interpolation: InputInterpolation,
    /// What is known of the measurement noise.
    pub noise: Noise,
    /// How standard errors are worked out.
    pub error_bounds: ErrorBoundsKind,
    /// How ∂y/∂θ, or the gradient, is worked out.
    pub derivatives: Derivatives,
    /// By state, for the filter-error estimator; a state that is not named has noise whose intensity is estimated from
    /// a start value of its own.
    #[serde(
        deserialize_with = "crate::model::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    #[schema(example = json!({"theta": {"start": 0.0, "fixed": true}}))]
    pub process_noise: IndexMap<String, ProcessNoise>,
    /// The band of the frequency-domain estimators; they need one, and no other may have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency: Option<FrequencyOptions>,
    /// Confidence intervals by other ways than error bounds, side by side with these; absent: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub confidence_intervals: Option<IntervalOptions>,
    /// Converged when a full step would move the estimate by less than this many standard errors:
    /// √(gᵀ H⁻¹ g), g the gradient and H the Hessian of the cost that the step is made with.
    #[schema(example = 1e-5, exclusive_minimum = 0.0)]
    pub tolerance: f64,
    /// The budget of iterations. With 0 nothing is estimated: the answer is what the data can tell of the parameters
    /// at the start values, see `identifiability`.
    #[schema(example = 50)]
    pub max_iterations: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            estimator: Estimator::default(),
            start: StartMethod::default(),
            method: Method::default(),
            integrator: Integrator::default(),
            steps_per_sample: StepsPerSample::default(),
            input_interpolation: InputInterpolation::default(),
            noise: Noise::default(),
            error_bounds: ErrorBoundsKind::default(),
            derivatives: Derivatives::default(),
            process_noise: IndexMap::new(),
            frequency: None,
            confidence_intervals: None,
            tolerance: 1e-5,
            max_iterations: 50,
        }
    }
}

/// How a step is made from gradient and information matrix. Where one method finds no lower cost, or has not converged
/// when half of at least 20 iterations are used up, the other is tried: from there, or from the start again.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Damped step by singular value decomposition of the scaled, symmetric Hessian (Góes, Hemerly, Maciel
    /// eq. 36-37): directions that the data do not see are left out.
    #[default]
    LevenbergMarquardt,
    /// Full step, halved while the cost rises.
    GaussNewton,
}

impl Method {
    pub(crate) fn other(self) -> Self {
        match self {
            Self::LevenbergMarquardt => Self::GaussNewton,
            Self::GaussNewton => Self::LevenbergMarquardt,
        }
    }
}

/// The covariance R of the measurement noise.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case", tag = "kind", deny_unknown_fields)]
pub enum Noise {
    /// R is estimated from the residuals along with θ (relaxation; the likelihood is concentrated in R).
    Estimated {
        /// `diagonal`: outputs' noises are independent; `full`: correlated.
        #[serde(default)]
        structure: NoiseStructure,
    },
    /// R is known: the variance of each output, in SI units squared, in the order of the model's outputs.
    Given {
        /// One for each output, above 0.
        variance: Vec<f64>,
    },
}

impl Noise {
    /// Whether the noises of the outputs are correlated, so that all pairs of outputs count.
    pub fn is_full(&self) -> bool {
        let full = NoiseStructure::Full;
        matches!(self, Self::Estimated { structure } if *structure == full)
    }
}

impl Default for Noise {
    fn default() -> Self {
        Self::Estimated {
            structure: NoiseStructure::default(),
        }
    }
}

/// Which covariances of an estimated R may differ from zero.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum NoiseStructure {
    /// None: the noises of the outputs are independent.
    #[default]
    Diagonal,
    /// All: the noises of the outputs are correlated.
    Full,
}
