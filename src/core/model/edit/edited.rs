//! A document that was edited, and the role of each parameter that was added.

use indexmap::IndexMap;

use crate::model::document::{ModelDocument, Start};

/// A document with an effect in it.
#[derive(Clone, PartialEq, Debug)]
pub struct Edited {
    /// The document, a model as any other.
    pub document: ModelDocument,
    /// The parameters that were added; what the effect is called after comes first.
    pub added: Vec<Added>,
    /// Channels that a recording must have besides.
    pub inputs: Vec<String>,
}

impl Edited {
    /// Values of what was added, in the parameters' units, at which the document is the model before: limits are then
    /// beyond reach, at their upper bounds, all else is at its start. Of what is read off the data any value will do.
    pub fn absence(&self) -> IndexMap<String, f64> {
        let of = |added: &Added| {
            let parameter = self.document.parameters.get(&added.name)?;
            let value = match (added.role, &parameter.start) {
                (AddedRole::Limit, _) => parameter.upper?,
                (_, Start::Value(value)) => *value,
                (_, Start::FromData(_)) => return None,
            };
            Some((added.name.clone(), value))
        };
        self.added.iter().filter_map(of).collect()
    }
}

/// A parameter that an edit added.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Added {
    /// Its name in the edited document.
    pub name: String,
    /// What it is there for.
    pub role: AddedRole,
}

/// The role of a parameter in the effect that added it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum AddedRole {
    /// How much there is of the effect: a bias, a scale, the factor of a term.
    Size,
    /// Where the effect sets in: the largest rate, the angle of separation.
    Limit,
    /// The time in which a lag follows, s.
    TimeConstant,
    /// By how much something comes later, s.
    Delay,
    /// When it begins, after the start of the maneuver.
    Onset,
    /// How long it takes to pass.
    Duration,
    /// The natural frequency of a mode, rad/s.
    Frequency,
    /// The damping ratio of a mode.
    Damping,
    /// How sharply a flow separates with the angle of attack.
    Steepness,
    /// The value of something at the start of the maneuver, or in its steady part: read off the recording.
    Reference,
}
