//! What the quantities of a document are: what it declares, and otherwise what names, units and equations tell.

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
