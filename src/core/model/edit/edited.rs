//! A document that was edited, and the role of each parameter that was added.

use crate::model::document::ModelDocument;

/// A document with an effect in it.
#[derive(Clone, PartialEq, Debug)]
pub struct Edited {
    pub document: ModelDocument,
    /// The parameters that were added; what the effect is called after comes first.
    pub added: Vec<Added>,
    /// Channels that a recording must have besides.
    pub inputs: Vec<String>,
}

/// A parameter that an edit added.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Added {
    pub name: String,
    pub role: AddedRole,
}

/// The role of a parameter in the effect that added it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum AddedRole {
    /// How much there is of the effect: a bias, a scale, the factor of a term.
    Size,
    /// Where the effect sets in: the largest rate, the angle of separation.
    Limit,
    TimeConstant,
    Delay,
    /// When it begins, after the start of the maneuver.
    Onset,
    /// How long it takes to pass.
    Duration,
    Frequency,
    Damping,
    Steepness,
    /// The value of something at the start of the maneuver, or in its steady part: read off the recording.
    Reference,
}
