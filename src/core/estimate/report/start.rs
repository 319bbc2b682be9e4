//! What the search for start values tells.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// How a start was looked for.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum StartKind {
    /// The document's start values.
    Document,
    /// Least squares of the state equations.
    EquationError,
    /// A simplex search.
    NelderMead,
    /// Random starts, each run to its end.
    MultiStart,
    /// Intervals whose jumps are closed step by step.
    MultipleShooting,
}

/// One line of the search for start values.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct StartReport {
    /// How the start was looked for.
    pub method: StartKind,
    /// Evaluations of the model over all data so far.
    pub evaluations: usize,
    /// Lowest -ln L so far; absent while there is none.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub cost: Option<f64>,
    /// What happened, in a sentence.
    #[schema(
        example = "start values from equation error: -ln L -4821.7, with the document's -1203.3"
    )]
    pub text: String,
}
