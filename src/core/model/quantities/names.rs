//! What a document declares, and what its names and units say.

use super::equations::dimension;
use super::known::{Quantities, Source, Taken};
use crate::flight::{
    Family, PhysicalQuantity, by_description, by_name, coefficient, steady_speed, wind,
};
use crate::model::document::ModelDocument;

impl Quantities {
    pub(super) fn declared(&mut self, document: &ModelDocument) {
        let taken = |quantity: &PhysicalQuantity| Taken {
            quantity: *quantity,
            from: Source::Declared,
            reason: "the model says so".to_string(),
        };
        let inputs = (document.inputs.iter()).map(|(name, x)| (name, x.quantity));
        let states = (document.states.iter()).map(|(name, x)| (name, x.quantity));
        let definitions = (document.definitions.iter()).map(|(name, x)| (name, x.quantity));
        let parameters = (document.parameters.iter()).map(|(name, x)| (name, x.quantity));
        let constants = (document.constants.iter()).map(|(name, x)| (name, x.quantity));
        let varying = inputs.chain(states).chain(definitions);
        for (name, quantity) in varying.chain(parameters).chain(constants) {
            if let Some(quantity) = &quantity {
                self.named.insert(name.clone(), taken(quantity));
            }
        }
        for (name, output) in &document.outputs {
            if let Some(quantity) = &output.quantity {
                self.outputs.insert(name.clone(), taken(quantity));
            }
        }
    }

    /// What descriptions say, of what names and equations leave open.
    pub(super) fn by_descriptions(&mut self, document: &ModelDocument) {
        let inputs = (document.inputs.iter()).map(|(name, x)| (name, &x.unit, &x.description));
        let states = (document.states.iter()).map(|(name, x)| (name, &x.unit, &x.description));
        let definitions =
            (document.definitions.iter()).map(|(name, x)| (name, &x.unit, &x.description));
        let reason = || "by its description and unit".to_string();
        let drives = |name: &str| document.inputs.contains_key(name);
        for (name, unit, description) in inputs.chain(states).chain(definitions) {
            let found = by_description(description, dimension(unit));
            let found = found.filter(|q| drives(name) || q.family() != Family::Control);
            if let Some(quantity) = found {
                self.note(name, quantity, reason);
            }
        }
        for (name, output) in &document.outputs {
            if let Some(quantity) = by_description(&output.description, dimension(&output.unit)) {
                self.note_output(name, quantity, reason);
            }
        }
    }

    pub(super) fn by_names(&mut self, document: &ModelDocument) {
        let inputs = (document.inputs.iter()).map(|(name, x)| (name, &x.unit));
        let states = (document.states.iter()).map(|(name, x)| (name, &x.unit));
        let definitions = (document.definitions.iter()).map(|(name, x)| (name, &x.unit));
        let varying = |name: &str, unit: &str, is_input: bool| {
            let dimension = dimension(unit);
            let found = by_name(name, dimension).or_else(|| match is_input {
                true => None,
                false => coefficient(name, dimension),
            });
            // a force is no throttle, an elastic coordinate no elevator
            found.filter(|quantity| is_input || quantity.family() != Family::Control)
        };
        let reason = || "by its name and unit".to_string();
        let drives = |name: &str| document.inputs.contains_key(name);
        for (name, unit) in inputs.chain(states).chain(definitions) {
            if let Some(quantity) = varying(name, unit, drives(name)) {
                self.note(name, quantity, reason);
            }
        }
        for (name, output) in &document.outputs {
            if let Some(quantity) = varying(name, &output.unit, false) {
                self.note_output(name, quantity, reason);
            }
        }
        let parameters = (document.parameters.iter()).map(|(name, x)| (name, &x.unit));
        let constants = (document.constants.iter()).map(|(name, x)| (name, &x.unit));
        for (name, unit) in parameters.chain(constants) {
            let dimension = dimension(unit);
            if let Some(quantity) = wind(name, dimension) {
                self.note(name, quantity, reason);
            } else if steady_speed(name, dimension) {
                self.note(name, PhysicalQuantity::Airspeed, reason);
            }
        }
    }
}
