//! Where a recording comes from that Trimtab made of another.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The job that made a recording, and of what.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct DerivedFrom {
    /// The id of the job.
    #[schema(example = "0193518e-6b6f-7d3c-9c53-b1cbb2b7a1f4")]
    pub job: String,
    /// The id of the recording that it corrected.
    #[schema(example = "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08")]
    pub maneuver: String,
    /// The segment of the job, which is a part of that recording.
    #[schema(example = "elevator")]
    pub segment: String,
}
