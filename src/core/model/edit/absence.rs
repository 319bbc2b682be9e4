//! Where an effect is absent.

use indexmap::IndexMap;

use super::{Added, Edit, EditKind, Edited};
use crate::model::document::Start;

impl Edit {
    /// Values of the added parameters, in their units, at which the document after the edit is the model before it:
    /// their starts, but for what is without effect at its upper bound. Parameters that are read off the data may have
    /// any value.
    pub fn absence(&self, edited: &Edited) -> IndexMap<String, f64> {
        let of = |(place, added): (usize, &Added)| {
            let parameter = edited.document.parameters.get(&added.name)?;
            let value = match parameter.start {
                _ if place == 0 && self.is_absent_at_upper_bound() => parameter.upper?,
                Start::Value(value) => value,
                Start::FromData(_) => return None,
            };
            Some((added.name.clone(), value))
        };
        edited.added.iter().enumerate().filter_map(of).collect()
    }

    /// Of its first parameter: a limit that nothing reaches, an angle at which the flow would separate.
    fn is_absent_at_upper_bound(&self) -> bool {
        use EditKind::{ActuatorRateLimit, StallHysteresis};
        matches!(self.kind, ActuatorRateLimit | StallHysteresis)
    }
}
