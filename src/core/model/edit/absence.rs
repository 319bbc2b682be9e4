//! Where an effect is absent.

use indexmap::IndexMap;

use super::{Added, Edit, EditKind};
use crate::model::document::{ModelDocument, Start};

impl Edit {
    /// Values of the added parameters, in their units, at which the document after the edit is the model before it:
    /// their starts, but for what is without effect at its upper bound. Parameters that are read off the data may have
    /// any value.
    pub fn absence(&self, before: &ModelDocument, after: &ModelDocument) -> IndexMap<String, f64> {
        let added = Added::between(before, after).parameters;
        let of = |(place, name): (usize, String)| {
            let parameter = after.parameters.get(&name)?;
            let value = match parameter.start {
                _ if place == 0 && self.is_absent_at_upper_bound() => parameter.upper?,
                Start::Value(value) => value,
                Start::FromData(_) => return None,
            };
            Some((name, value))
        };
        added.into_iter().enumerate().filter_map(of).collect()
    }

    /// Of its first parameter: a limit that nothing reaches, an angle at which the flow would separate.
    fn is_absent_at_upper_bound(&self) -> bool {
        use EditKind::{ActuatorRateLimit, StallHysteresis};
        matches!(self.kind, ActuatorRateLimit | StallHysteresis)
    }
}
