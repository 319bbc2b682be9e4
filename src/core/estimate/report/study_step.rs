//! News of long work whose results come one by one.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// How far a study, or the work on confidence intervals, is.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct StudyStep {
    /// How many findings there are so far, this one included.
    #[schema(example = 7)]
    pub number: usize,
    /// How many there will be.
    #[schema(example = 19)]
    pub of: usize,
    /// What was found, in a sentence.
    #[schema(
        example = "complex_step: gradient error at most 2.1e-14 for steps from 1e-300 to 1e-8"
    )]
    pub finding: String,
}
