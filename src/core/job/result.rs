//! What a job has come to.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::diagnose::Diagnosis;
use crate::estimate::study::DerivativeStudy;
use crate::estimate::{Estimate, TimeHistory};
use crate::model::ModelDocument;
use crate::structure::Structure;

/// Everything a finished job answers.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct JobResult {
    /// Parameters, error bounds, fit; of a diagnosis, those of the model with its effects.
    pub estimate: Estimate,
    /// The model that was estimated: the declared one with the job's edits, overrides, and of a diagnosis its effects.
    pub model: ModelDocument,
    /// Measured and estimated outputs of each segment.
    pub histories: Vec<TimeHistory>,
    /// Of a derivative study.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub study: Option<DerivativeStudy>,
    /// Of a diagnosis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diagnosis: Option<Diagnosis>,
    /// Of a structure determination.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub structure: Option<Structure>,
}
