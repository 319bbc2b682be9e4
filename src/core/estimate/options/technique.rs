//! Which technique a job asks for.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// How derivatives are worked out. All of them differentiate the same discretised model.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(
    tag = "technique",
    rename_all = "snake_case",
    deny_unknown_fields,
    expecting = "an object with \"technique\""
)]
pub enum Derivatives {
    /// ∂y/∂θ by the sensitivities of the integration scheme, exact but for rounding.
    ForwardSensitivities {},
    /// ∂y/∂θ by one more simulation for each parameter; about half of the digits.
    ForwardDifference {
        /// Relative to the parameter's size; absent: √ε, about 1.5e-8.
        #[serde(default = "forward_step")]
        #[schema(
            default = 1.5e-8,
            example = 1.5e-8,
            exclusive_minimum = 0.0,
            maximum = 1.0
        )]
        step: f64,
    },
    /// ∂y/∂θ by two more simulations for each parameter; about two thirds of the digits.
    CentralDifference {
        /// Relative to the parameter's size; absent: ∛ε, about 6.1e-6.
        #[serde(default = "central_step")]
        #[schema(
            default = 6.1e-6,
            example = 6.1e-6,
            exclusive_minimum = 0.0,
            maximum = 1.0
        )]
        step: f64,
    },
    /// ∂y/∂θ by one simulation in complex numbers for each parameter, exact but for rounding.
    ComplexStep {
        /// Imaginary part, relative to the parameter's size (at least 1); anything small enough will do.
        #[serde(default = "complex_step")]
        #[schema(
            default = 1e-20,
            example = 1e-20,
            exclusive_minimum = 0.0,
            maximum = 1.0
        )]
        step: f64,
    },
    /// The gradient of the cost alone, by the adjoint of the integration scheme, exact but for rounding. Steps
    /// are those of a quasi-Newton method (BFGS), whatever `method` says; error bounds are taken from one
    /// evaluation with forward sensitivities at the end.
    Adjoint {
        /// What the first inverse Hessian is.
        #[serde(default)]
        scaling: Scaling,
    },
}

impl Default for Derivatives {
    fn default() -> Self {
        Self::ForwardSensitivities {}
    }
}

/// Where the quasi-Newton method has its first idea of the Hessian from. A gradient says nothing of how far
/// to go, and parameters differ in size and in how well the data see them.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scaling {
    /// The information matrix at the start values, by one evaluation with forward sensitivities.
    #[default]
    Information,
    /// The sizes of the parameters.
    Sizes,
    /// None: all parameters alike. For comparison only.
    None,
}

/// √ε, where the errors of cutting off and of rounding are alike for a y of the size of its derivatives.
fn forward_step() -> f64 {
    f64::EPSILON.sqrt()
}

/// ∛ε, where both errors are alike for a y of the size of its derivatives.
fn central_step() -> f64 {
    f64::EPSILON.cbrt()
}

/// Its square is nothing beside ε.
fn complex_step() -> f64 {
    1e-20
}

/// Least relative step: an imaginary part below this leaves the range of normal numbers.
const LEAST_STEP: f64 = 1e-300;

impl Derivatives {
    /// By the name that a job gives it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::ForwardSensitivities {} => "forward_sensitivities",
            Self::ForwardDifference { .. } => "forward_difference",
            Self::CentralDifference { .. } => "central_difference",
            Self::ComplexStep { .. } => "complex_step",
            Self::Adjoint { .. } => "adjoint",
        }
    }

    /// The adjoint with its usual scaling.
    pub fn adjoint() -> Self {
        Self::Adjoint {
            scaling: Scaling::default(),
        }
    }

    /// Each technique as it is when no more is said.
    pub fn all() -> [Self; 5] {
        [
            Self::ForwardDifference {
                step: forward_step(),
            },
            Self::CentralDifference {
                step: central_step(),
            },
            Self::ComplexStep {
                step: complex_step(),
            },
            Self::ForwardSensitivities {},
            Self::adjoint(),
        ]
    }

    /// The fault of the step, if it has one.
    pub fn fault(&self) -> Option<String> {
        let step = match *self {
            Self::ForwardDifference { step }
            | Self::CentralDifference { step }
            | Self::ComplexStep { step } => step,
            Self::ForwardSensitivities {} | Self::Adjoint { .. } => return None,
        };
        (!(LEAST_STEP..=1.0).contains(&step)).then(|| {
            format!("the step is relative to the parameter's size and must be from {LEAST_STEP:e} to 1; leave it out for the usual one")
        })
    }
}
