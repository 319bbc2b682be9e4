//! The part that a maneuver plays in a job.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The part that a maneuver plays in a job.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// The model is fitted to it.
    #[default]
    Estimation,
    /// It takes no part in the fit and is predicted with its result.
    Validation,
    /// As validation, and no decision of a diagnosis looks at it either.
    Final,
}
