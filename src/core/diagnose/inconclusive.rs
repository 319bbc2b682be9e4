//! Why a diagnosis comes to no conclusion.

use super::case::Unfit;
use super::watch::Stopped;
use crate::estimate::Unusable;

/// Why there is no conclusion.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum Inconclusive {
    /// A model does not meet the recordings, or comes to nothing.
    #[error(transparent)]
    Unfit(#[from] Unfit),
    /// The start values of the declared model lead nowhere.
    #[error("the declared model cannot be fitted from its start values: {0}")]
    NoStart(#[from] Unusable),
    /// It was asked to stop.
    #[error("stopped on request")]
    Stopped,
}

impl From<Stopped> for Inconclusive {
    fn from(_: Stopped) -> Self {
        Self::Stopped
    }
}
