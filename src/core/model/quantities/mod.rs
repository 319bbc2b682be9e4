//! What the quantities of a document are: what it declares, and otherwise what names, units and equations tell.

mod attitude;
mod control;
mod flow;
mod identity;
mod sums;
mod velocity;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::document::ModelDocument;
use super::expression::{self, Expression};
use crate::flight::{
    Dimension, Family, PhysicalQuantity, Unit, by_name, coefficient, steady_speed, wind,
};

pub use sums::{Term, names_of, terms};

/// How it is known what a quantity is.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// The model document or the job says so.
    Declared,
    /// By its name and unit, or by the equations.
    Guessed,
}

/// What something was taken for.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Taken {
    pub quantity: PhysicalQuantity,
    pub from: Source,
    #[schema(example = "alpha is recorded as it")]
    pub reason: String,
}

/// What each name of a document is, as far as it is known.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Quantities {
    /// Inputs, states, definitions, and of parameters and constants the winds and steady values.
    named: IndexMap<String, Taken>,
    outputs: IndexMap<String, Taken>,
}

/// Facts are found from facts: so often, no more.
const PASSES: usize = 4;

impl Quantities {
    pub fn of(document: &ModelDocument) -> Self {
        let mut found = Self::default();
        found.declared(document);
        found.by_names(document);
        let equations = Equations::of(document);
        for _ in 0..PASSES {
            let before = (found.named.len(), found.outputs.len());
            velocity::find(&equations, &mut found);
            identity::find(&equations, &mut found);
            flow::find(&equations, &mut found);
            attitude::find(&equations, &mut found);
            if before == (found.named.len(), found.outputs.len()) {
                break;
            }
        }
        control::find(&equations, &mut found);
        attitude::only_rate(&equations, &mut found);
        found
    }

    /// What a name in equations is.
    pub fn get(&self, name: &str) -> Option<PhysicalQuantity> {
        self.named.get(name).map(|taken| taken.quantity)
    }

    /// What an output measures.
    pub fn output(&self, name: &str) -> Option<PhysicalQuantity> {
        self.outputs.get(name).map(|taken| taken.quantity)
    }

    /// Names in equations that are a quantity, in the order of the document: inputs, states, definitions, then what is held.
    pub fn all_of(&self, quantity: PhysicalQuantity) -> impl Iterator<Item = &str> {
        let is = move |(_, taken): &(&String, &Taken)| taken.quantity == quantity;
        self.named.iter().filter(is).map(|(name, _)| name.as_str())
    }

    pub fn outputs_of(&self, quantity: PhysicalQuantity) -> impl Iterator<Item = &str> {
        let is = move |(_, taken): &(&String, &Taken)| taken.quantity == quantity;
        (self.outputs.iter().filter(is)).map(|(name, _)| name.as_str())
    }

    /// Everything that was taken for something, names in equations before outputs.
    pub fn taken(&self) -> impl Iterator<Item = (&str, &Taken)> {
        let all = self.named.iter().chain(&self.outputs);
        all.map(|(name, taken)| (name.as_str(), taken))
    }

    fn declared(&mut self, document: &ModelDocument) {
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

    fn by_names(&mut self, document: &ModelDocument) {
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

    /// What is known already stays.
    fn note(&mut self, name: &str, quantity: PhysicalQuantity, reason: impl FnOnce() -> String) {
        if !self.named.contains_key(name) {
            self.named
                .insert(name.to_string(), guess(quantity, reason()));
        }
    }

    fn note_output(
        &mut self,
        name: &str,
        quantity: PhysicalQuantity,
        reason: impl FnOnce() -> String,
    ) {
        if !self.outputs.contains_key(name) {
            self.outputs
                .insert(name.to_string(), guess(quantity, reason()));
        }
    }
}

fn guess(quantity: PhysicalQuantity, reason: String) -> Taken {
    Taken {
        quantity,
        from: Source::Guessed,
        reason,
    }
}

fn dimension(unit: &str) -> Dimension {
    Unit::parse(unit).map_or(Dimension::NONE, |unit| unit.dimension)
}

/// The equations of a document as trees. What cannot be read is left out.
struct Equations<'d> {
    document: &'d ModelDocument,
    states: IndexMap<&'d str, Expression>,
    definitions: IndexMap<&'d str, Expression>,
    outputs: IndexMap<&'d str, Expression>,
}

impl<'d> Equations<'d> {
    fn of(document: &'d ModelDocument) -> Self {
        fn read<'d>(
            texts: impl Iterator<Item = (&'d String, &'d String)>,
        ) -> IndexMap<&'d str, Expression> {
            texts
                .filter_map(|(name, text)| Some((name.as_str(), expression::parse(text).ok()?)))
                .collect()
        }
        Self {
            document,
            states: read((document.states.iter()).map(|(name, x)| (name, &x.derivative))),
            definitions: read((document.definitions.iter()).map(|(name, x)| (name, &x.equation))),
            outputs: read((document.outputs.iter()).map(|(name, x)| (name, &x.equation))),
        }
    }

    /// Whether a name varies along a maneuver.
    fn varies(&self, name: &str) -> bool {
        let document = self.document;
        document.inputs.contains_key(name)
            || document.states.contains_key(name)
            || document.definitions.contains_key(name)
    }

    fn dimension(&self, name: &str) -> Dimension {
        let document = self.document;
        let unit = (document.inputs.get(name).map(|x| &x.unit))
            .or_else(|| document.states.get(name).map(|x| &x.unit))
            .or_else(|| document.definitions.get(name).map(|x| &x.unit));
        unit.map_or(Dimension::NONE, |unit| dimension(unit))
    }

    /// The terms of a sum, definitions that are sums themselves written out.
    fn terms<'e>(&'e self, expression: &'e Expression) -> Vec<Term<'e>> {
        let definition = |name: &str| self.definitions.get(name);
        sums::expanded(expression, &definition)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::catalog;

    fn quantities(text: &str) -> Quantities {
        Quantities::of(&toml::from_str(text).expect("a document"))
    }

    /// The document without its declarations gives the same by names and structure.
    #[test]
    fn guesses_agree_with_what_the_catalog_declares() {
        for mut document in catalog::all() {
            let declared = Quantities::of(&document);
            document.inputs.values_mut().for_each(|x| x.quantity = None);
            document.states.values_mut().for_each(|x| x.quantity = None);
            (document.definitions.values_mut()).for_each(|x| x.quantity = None);
            (document.outputs.values_mut()).for_each(|x| x.quantity = None);
            let guessed = Quantities::of(&document);
            for name in document.inputs.keys().chain(document.states.keys()) {
                assert_eq!(
                    declared.get(name),
                    guessed.get(name),
                    "{name} of {}",
                    document.name
                );
            }
            for name in document.outputs.keys() {
                let (declared, guessed) = (declared.output(name), guessed.output(name));
                assert!(declared.is_some(), "{name} of {}", document.name);
                assert_eq!(declared, guessed, "{name} of {}", document.name);
            }
        }
    }

    #[test]
    fn flow_angles_and_speed_are_told_by_their_formulas() {
        use PhysicalQuantity::*;
        let found = quantities(
            r#"
            name = "body-axes"
            constants.g0.value = 9.81
            constants.g0.unit = "m/s^2"
            inputs.s1.unit = "m/s^2"
            inputs.s2.unit = "m/s^2"
            inputs.s3.unit = "m/s^2"
            inputs.w1.unit = "rad/s"
            inputs.w2.unit = "rad/s"
            inputs.w3.unit = "rad/s"
            definitions.k1 = { unit = "m/s", equation = "sqrt(c1^2 + c2^2 + c3^2)" }
            definitions.k2 = { unit = "rad", equation = "atan2(c3, c1)" }
            definitions.k3 = { unit = "rad", equation = "asin(c2/k1)" }
            states.c1 = { unit = "m/s", initial = "1", derivative = "s1 - w2*c3 + w3*c2 - g0*sin(e2)" }
            states.c2 = { unit = "m/s", initial = "1", derivative = "s2 - w3*c1 + w1*c3 + g0*cos(e2)*sin(e1)" }
            states.c3 = { unit = "m/s", initial = "1", derivative = "s3 + w2*c1 - w1*c2 + g0*cos(e2)*cos(e1)" }
            states.e1 = { unit = "rad", initial = "0", derivative = "w1 + tan(e2)*(w2*sin(e1) + w3*cos(e1))" }
            states.e2 = { unit = "rad", initial = "0", derivative = "w2*cos(e1) - w3*sin(e1)" }
            outputs.o1 = { unit = "rad", equation = "1.1*k2 + 0.01" }
            outputs.o2 = { unit = "m/s", equation = "k1" }
            "#,
        );
        for (name, quantity) in [
            ("c1", VelocityX),
            ("c2", VelocityY),
            ("c3", VelocityZ),
            ("k1", Airspeed),
            ("k2", AngleOfAttack),
            ("k3", AngleOfSideslip),
            ("w1", RollRate),
            ("w2", PitchRate),
            ("w3", YawRate),
            ("s1", AccelerationX),
            ("s3", AccelerationZ),
            ("e1", RollAngle),
            ("e2", PitchAngle),
        ] {
            assert_eq!(found.get(name), Some(quantity), "{name}");
        }
        assert_eq!(found.output("o1"), Some(AngleOfAttack));
        assert_eq!(found.output("o2"), Some(Airspeed));
    }

    #[test]
    fn an_output_says_what_a_state_is_and_an_input_that_a_parameter_multiplies_is_a_control() {
        use PhysicalQuantity::*;
        let found = quantities(
            r#"
            name = "short-period"
            inputs.x1.unit = "rad"
            parameters.a = { unit = "1/s", start = -1.0 }
            parameters.b = { unit = "1/s^2", start = -1.0 }
            parameters.c = { unit = "1/s^2", start = -1.0 }
            parameters.o = { unit = "rad", start = 0.0 }
            parameters.trim = { unit = "rad", start = 0.0 }
            states.x2 = { unit = "rad", initial = "0", derivative = "a*x2 + x3" }
            states.x3 = { unit = "rad/s", initial = "0", derivative = "b*x2 + a*x3 + c*(x1 - trim)" }
            outputs.AoA = { unit = "deg", equation = "x2 + o" }
            outputs.x3 = { unit = "rad/s", equation = "x3" }
            "#,
        );
        assert_eq!(found.get("x2"), Some(AngleOfAttack));
        assert_eq!(found.get("x3"), Some(PitchRate));
        assert_eq!(found.get("x1"), Some(Control));
        assert_eq!(found.output("x3"), Some(PitchRate));
    }

    #[test]
    fn elastic_states_are_no_motion() {
        let found = quantities(
            r#"
            name = "wing-bending"
            inputs.de.unit = "rad"
            parameters.w = { unit = "rad/s", start = 12.0 }
            parameters.z = { unit = "-", start = 0.02 }
            parameters.k = { unit = "-", start = 1.0 }
            states.alpha_w = { unit = "rad", initial = "0", derivative = "b2" }
            states.b2 = { unit = "rad/s", initial = "0", derivative = "w^2*(k*de - alpha_w) - 2*z*w*b2" }
            outputs.y = { unit = "rad", equation = "alpha_w" }
            "#,
        );
        for name in ["alpha_w", "b2"] {
            assert_eq!(
                found.get(name),
                Some(PhysicalQuantity::Structural),
                "{name}"
            );
        }
    }
}
