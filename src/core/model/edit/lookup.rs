//! Where a document, or else the recording, has a quantity that an effect acts through.

use super::EditError;
use super::sheet::{Sheet, dimension};
use crate::flight::{Dimension, PhysicalQuantity};
use crate::model::Quantities;
use crate::model::document::Input;

/// The quantities that a speed may be read from.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Speed {
    /// A quantity that varies, or the steady flight's.
    Any,
    Varying,
}

impl Sheet<'_> {
    pub(super) fn quantities(&self) -> Quantities {
        Quantities::of(&self.document)
    }

    /// A quantity that varies with time, for an equation: a state, else a definition, else an input, else what an output
    /// says.
    pub(super) fn quantity(&self, wanted: PhysicalQuantity) -> Option<String> {
        let quantities = self.quantities();
        self.varying(&quantities, wanted).or_else(|| {
            let output = quantities.outputs_of(wanted).next()?;
            let output = self.document.outputs.get(output)?;
            Some(format!("({})", output.equation))
        })
    }

    /// The state, else the definition, else the input that is a quantity.
    pub(super) fn varying(
        &self,
        quantities: &Quantities,
        wanted: PhysicalQuantity,
    ) -> Option<String> {
        let document = &self.document;
        let of = |is: &dyn Fn(&str) -> bool| {
            let mut names = quantities.all_of(wanted);
            names.find(|name| is(name)).map(ToString::to_string)
        };
        of(&|name| document.states.contains_key(name))
            .or_else(|| of(&|name| document.definitions.contains_key(name)))
            .or_else(|| of(&|name| document.inputs.contains_key(name)))
    }

    /// An airspeed for an equation. A speed that the document does not have becomes a recorded input.
    pub(super) fn speed(&mut self, speed: Speed) -> Result<String, EditError> {
        if let Some(found) = self.quantity(PhysicalQuantity::Airspeed) {
            return Ok(found);
        }
        if speed == Speed::Any
            && let Some(steady) = self.steady_speed()
        {
            return Ok(steady);
        }
        self.recorded(PhysicalQuantity::Airspeed, "V", "m/s", "true airspeed")
    }

    /// The speed of the steady flight, a parameter or a constant.
    pub(super) fn steady_speed(&self) -> Option<String> {
        let document = &self.document;
        let quantities = self.quantities();
        let mut names = quantities.all_of(PhysicalQuantity::Airspeed);
        let held = |name: &&str| {
            document.parameters.contains_key(*name) || document.constants.contains_key(*name)
        };
        names.find(held).map(ToString::to_string)
    }

    /// The recorded channel that is a quantity, by what the edit says is recorded, else under its usual name.
    pub(super) fn recorded(
        &mut self,
        wanted: PhysicalQuantity,
        usual: &str,
        unit: &str,
        description: &str,
    ) -> Result<String, EditError> {
        let is = |(name, input): &(&String, &Input)| {
            let said = input.quantity;
            said.or_else(|| crate::flight::by_name(name, dimension(&input.unit))) == Some(wanted)
        };
        match self.edit.channels.iter().find(is) {
            Some((name, input)) => self.channel(name, &input.unit, description),
            None => self.channel(usual, unit, description),
        }
    }

    /// A recorded channel as an input, new where the document does not have it.
    pub(super) fn channel(
        &mut self,
        name: &str,
        unit: &str,
        description: &str,
    ) -> Result<String, EditError> {
        if self.document.inputs.contains_key(name) {
            return Ok(name.to_string());
        }
        if self.is_taken(name) || self.document.outputs.contains_key(name) {
            let message = format!(
                "'{name}' is wanted as a recorded input, and is something else in this model"
            );
            return Err(self.unfit(message));
        }
        let told = self.edit.channels.get(name);
        let input = Input {
            unit: unit.to_string(),
            description: description.to_string(),
            ..told.cloned().unwrap_or_default()
        };
        self.document.inputs.insert(name.to_string(), input);
        self.inputs.push(name.to_string());
        Ok(name.to_string())
    }

    /// A name in an equation that is a speed through the air, a wind and the like is measured so.
    pub(super) fn is_speed(&self, name: &str) -> bool {
        self.measures(name) == Some(Dimension::METRE.over(Dimension::SECOND))
    }
}
