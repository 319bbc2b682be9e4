//! The source of error bounds.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// What standard errors and correlations are made from.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum ErrorBoundsKind {
    /// Corrected for coloured residuals: F⁻¹ B F⁻¹, B from the autocorrelation of the residuals and of what the fit
    /// absorbed of the noise.
    #[default]
    Corrected,
    /// The Cramér-Rao bound F⁻¹, for white residuals. Spares three looks at the data.
    Conventional,
}

impl ErrorBoundsKind {
    /// As it is written in a job.
    pub fn name(self) -> &'static str {
        match self {
            Self::Corrected => "corrected",
            Self::Conventional => "conventional",
        }
    }
}
