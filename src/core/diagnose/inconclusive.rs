//! Why a diagnosis comes to no conclusion.

use super::case::Unfit;
use super::watch::Stopped;

/// Why there is no conclusion.
#[derive(Debug)]
pub enum Inconclusive {
    /// The declared model cannot be fitted.
    Unfit(Unfit),
    /// It was asked to stop.
    Stopped,
}

impl From<Unfit> for Inconclusive {
    fn from(why: Unfit) -> Self {
        Self::Unfit(why)
    }
}

impl From<Stopped> for Inconclusive {
    fn from(_: Stopped) -> Self {
        Self::Stopped
    }
}
