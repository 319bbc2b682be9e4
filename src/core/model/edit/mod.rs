//! Edits: an effect is a function from a model document to a model document with a few parameters more,
//! which at their values of no effect is the model before.
//!
//! The added parameters carry units, start values and their physical range. Every effect contains its own absence:
//! [`Edited::absence`] says at which values the edited model is the model before. Lags, rate limits, play and delays are
//! elements in the path of a signal (see [`super::Element`]). The time constants of the effects that are states must
//! stay above about 0.4 of the time between samples: what is faster than that an explicit integrator cannot follow.

mod axes;
mod dynamics;
mod edited;
mod error;
mod inputs;
mod lookup;
mod position;
mod pressure;
mod sensors;
mod sheet;
mod stall;
mod text;
mod wind;
mod written;

pub use edited::{Added, AddedRole, Edited};
pub use error::EditError;
pub use written::{Edit, EditKind, Reference};

use super::document::ModelDocument;
use sheet::Sheet;

impl Edit {
    /// The document with the effect in it, and what it has more.
    ///
    /// # Errors
    /// The target is not in the model or not fit for the kind, the term cannot be read, the parameter's name is taken,
    /// or one of them is too long.
    pub fn apply(&self, document: &ModelDocument) -> Result<Edited, EditError> {
        self.check_lengths()?;
        let mut sheet = Sheet::new(self, document);
        match self.kind {
            EditKind::FixedParameter => dynamics::freed(&mut sheet),
            EditKind::SensorBias => sensors::bias(&mut sheet),
            EditKind::SensorScale => sensors::scale(&mut sheet),
            EditKind::SensorDrift => sensors::drift(&mut sheet),
            EditKind::SensorDelay => sensors::delay(&mut sheet),
            EditKind::SensorLag => sensors::lag(&mut sheet),
            EditKind::SensorCrossAxis => axes::cross_axis(&mut sheet),
            EditKind::SwappedChannels => axes::swapped(&mut sheet),
            EditKind::SensorPosition => position::lever_arm(&mut sheet),
            EditKind::InputBias => inputs::bias(&mut sheet),
            EditKind::InputScale => inputs::scale(&mut sheet),
            EditKind::InputDelay => inputs::delay(&mut sheet),
            EditKind::ActuatorLag => inputs::lag(&mut sheet),
            EditKind::ActuatorRateLimit => inputs::rate_limit(&mut sheet),
            EditKind::Backlash => inputs::backlash(&mut sheet),
            EditKind::UnrecordedInput => dynamics::unrecorded_input(&mut sheet),
            EditKind::MissingTerm if self.target == "all" => pressure::scaled(&mut sheet),
            EditKind::MissingTerm => dynamics::missing_term(&mut sheet),
            EditKind::UnsteadyAero => dynamics::unsteady(&mut sheet),
            EditKind::StallHysteresis => stall::hysteresis(&mut sheet),
            EditKind::Gust => wind::gust(&mut sheet),
            EditKind::Wind => wind::wind(&mut sheet),
            EditKind::InitialState => dynamics::initial_state(&mut sheet),
            EditKind::StructuralMode => sensors::structural_mode(&mut sheet),
        }?;
        Ok(Edited {
            document: sheet.document,
            added: sheet.added,
            inputs: sheet.inputs,
        })
    }
}
