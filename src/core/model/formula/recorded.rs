//! The recording that a formula looks at.

use crate::flight::Dimension;

/// What a formula is evaluated on: channels in SI, all of one length, on one time axis.
pub trait Recorded {
    /// Time of each sample, s.
    fn time(&self) -> &[f64];
    /// Values and dimension of a channel.
    fn channel(&self, name: &str) -> Option<(&[f64], Dimension)>;
    /// Names of all channels, for messages.
    fn names(&self) -> Vec<String>;
}
