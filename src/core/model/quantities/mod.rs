//! What the quantities of a document are: what it declares, and otherwise what names, units, equations and descriptions tell.

mod attitude;
mod check;
mod control;
mod equations;
mod flow;
mod identity;
mod known;
mod names;
mod sums;
mod velocity;

pub(super) use check::check;
pub use known::{Quantities, Source, Taken};

use equations::Equations;

use super::document::ModelDocument;

/// Facts are found from facts: so often, no more.
const PASSES: usize = 4;

impl Quantities {
    /// What each name of a document is, declared or guessed.
    pub fn of(document: &ModelDocument) -> Self {
        let mut found = Self::default();
        found.declared(document);
        found.by_names(document);
        let equations = Equations::of(document);
        found.by_equations(&equations);
        found.by_descriptions(document);
        found.by_equations(&equations);
        control::find(&equations, &mut found);
        attitude::only_rate(&equations, &mut found);
        found
    }

    fn by_equations(&mut self, equations: &Equations) {
        for _ in 0..PASSES {
            let before = (self.named.len(), self.outputs.len());
            velocity::find(equations, self);
            identity::find(equations, self);
            flow::find(equations, self);
            attitude::find(equations, self);
            if before == (self.named.len(), self.outputs.len()) {
                break;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::PhysicalQuantity;
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
    fn descriptions_tell_what_names_and_equations_leave_open() {
        use PhysicalQuantity::*;
        let found = quantities(
            r#"
            name = "heave-and-pitch"
            inputs.k1 = { unit = "deg", description = "elevator deflection" }
            parameters.a = { unit = "1/s", start = -1.0 }
            parameters.b = { unit = "1/s^2", start = -1.0 }
            constants.V0 = { unit = "m/s", value = 60.0 }
            definitions.k2 = { unit = "rad", equation = "k3/V0", description = "angle of attack about the steady one" }
            definitions.k5 = { unit = "rad/s^2", equation = "a*k4 + b*k1", description = "pitch acceleration by the air" }
            states.k3 = { unit = "m/s", initial = "0", derivative = "a*k3 + V0*k4", description = "velocity down" }
            states.k4 = { unit = "rad/s", initial = "0", derivative = "k5", description = "pitch rate" }
            outputs.k6 = { unit = "deg", equation = "k2", description = "reading of the vane" }
            outputs.k7 = { unit = "m/s^2", equation = "a*k3", description = "specific force down" }
            "#,
        );
        for (name, quantity) in [
            ("k1", Elevator),
            ("k2", AngleOfAttack),
            ("k3", VelocityZ),
            ("k4", PitchRate),
            ("k5", PitchAcceleration),
        ] {
            assert_eq!(found.get(name), Some(quantity), "{name}");
        }
        assert_eq!(found.output("k6"), Some(AngleOfAttack));
        assert_eq!(found.output("k7"), Some(AccelerationZ));
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
