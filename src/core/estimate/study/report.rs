//! The answer of a derivative study.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::estimate::options::technique::Scaling;

/// Derivative techniques compared on one problem, at its start values.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct DerivativeStudy {
    /// The problem that they are compared on.
    pub size: ProblemSize,
    /// Error of the gradient against the step, for each technique that has one.
    pub error_curves: Vec<ErrorCurve>,
    /// Each technique with its usual step.
    pub techniques: Vec<TechniqueResult>,
    /// Cost of one gradient, direct and adjoint, with only some of the parameters free.
    pub costs: Vec<CostPoint>,
    /// Operations by the formulas of Machado 2022, table 11: Euler scheme, every Jacobian full.
    pub formula: FormulaOperations,
    /// How far the same exact gradient gets with one optimiser and another.
    pub descents: Vec<DescentResult>,
}

/// What the cost of a gradient depends on.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ProblemSize {
    /// Samples N over all segments.
    #[schema(example = 751)]
    pub samples: usize,
    /// States of the model, n_x.
    pub states: usize,
    /// Outputs of the model, n_y.
    pub outputs: usize,
    /// Free unknowns n_θ.
    pub unknowns: usize,
    /// Stages of the integration scheme.
    pub stages: usize,
}

/// Error of the gradient of one technique by its step.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ErrorCurve {
    /// The technique's name, as in a job's options.
    #[schema(example = "central_difference")]
    pub technique: String,
    /// From the largest step to the smallest.
    pub points: Vec<ErrorPoint>,
}

/// The error of a gradient at one step.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ErrorPoint {
    /// Relative to each parameter's size.
    #[schema(example = 1e-6)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub step: f64,
    /// Norm of the error over the norm of the gradient, each component in standard errors that its parameter
    /// alone would have; forward sensitivities are the reference. Absent: a simulation left the range of numbers.
    #[schema(example = 3.2e-11)]
    pub error: Option<f64>,
}

/// One technique with its usual step.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct TechniqueResult {
    /// The technique's name, as in a job's options.
    #[schema(example = "adjoint")]
    pub technique: String,
    /// As in the curves; of forward sensitivities absent, since they are the reference.
    pub gradient_error: Option<f64>,
    /// Operations of one gradient: instructions of the compiled equations, and the products and sums around them.
    pub operations: u64,
    /// Simulations of one gradient, complex ones included.
    pub simulations: usize,
    /// Bytes that the technique works in, beside the recording.
    pub bytes: usize,
    /// CPU time of one gradient, s; the least of several.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub cpu_seconds: f64,
    /// Wall time of one gradient, s; the least of several.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub wall_seconds: f64,
    /// Of an estimation with this technique: Levenberg-Marquardt where it gives ∂y/∂θ, else BFGS.
    pub iterations: usize,
    /// How that estimation ended.
    #[schema(example = "converged")]
    pub outcome: String,
    /// Wall time of that estimation, s.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub estimation_wall_seconds: f64,
    /// CPU time of that estimation, s.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub estimation_cpu_seconds: f64,
    /// How much higher than the lowest cost of all techniques it ended; 0.5e-10 is 1e-5 standard errors.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub cost_excess: f64,
}

/// The cost of one gradient with so many parameters free.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct CostPoint {
    /// Free unknowns.
    pub unknowns: usize,
    /// Operations by forward sensitivities.
    pub direct_operations: u64,
    /// Operations by the adjoint.
    pub adjoint_operations: u64,
    /// Wall time by forward sensitivities, s.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub direct_wall_seconds: f64,
    /// Wall time by the adjoint, s.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub adjoint_wall_seconds: f64,
}

/// Machado 2022, table 11.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
pub struct FormulaOperations {
    /// Multiplications of one gradient by forward sensitivities.
    pub direct_multiplications: u64,
    /// Additions of one gradient by forward sensitivities.
    pub direct_additions: u64,
    /// Multiplications of one gradient by the adjoint, the reverse mode.
    pub reverse_multiplications: u64,
    /// Additions of one gradient by the adjoint, the reverse mode.
    pub reverse_additions: u64,
}

/// One descent from the start values until 0.01 standard errors from the minimum, in cost.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct DescentResult {
    /// The optimiser's name.
    #[schema(example = "BFGS")]
    pub optimiser: String,
    /// What it knew of the Hessian at the start; absent where the optimiser has it at every step.
    pub scaling: Option<Scaling>,
    /// Steps taken.
    pub iterations: usize,
    /// Gradients evaluated.
    pub gradients: usize,
    /// Whether it came there within the budget.
    pub reached: bool,
    /// How much higher than the minimum it ended.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub cost_excess: f64,
}

impl ErrorCurve {
    /// Step and error of the best point.
    pub fn best(&self) -> Option<(f64, f64)> {
        let found = self.points.iter().filter_map(|p| Some((p.step, p.error?)));
        found.min_by(|a, b| a.1.total_cmp(&b.1))
    }
}
