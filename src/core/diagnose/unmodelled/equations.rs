//! Where a force may act that the model does not have: the equations that carry aerodynamics, and the outputs.

use super::report::ForceIn;
use crate::diagnose::candidates::Ingredients;
use crate::flight::{Dimension, Unit};
use crate::model::ModelDocument;

/// An equation that a force may act in.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Equation {
    /// A state, a definition or an output.
    pub name: String,
    pub force_in: ForceIn,
    /// Of the force, SI.
    pub unit: String,
}

impl Equation {
    /// `the equation of q`, `the coefficient Cm`, `the output alpha`.
    pub(super) fn words(&self) -> String {
        let name = &self.name;
        match self.force_in {
            ForceIn::State => format!("the equation of {name}"),
            ForceIn::Coefficient => format!("the coefficient {name}"),
            ForceIn::Output => format!("the output {name}"),
        }
    }
}

/// All of a model's equations that a force may act in, outputs last. An output with derivatives of its own is one of those.
pub(super) fn of(ingredients: &Ingredients<'_>, document: &ModelDocument) -> Vec<Equation> {
    let aerodynamic = ingredients.aerodynamic().into_iter().filter_map(|name| {
        let (force_in, unit) = match document.definitions.get(&name) {
            Some(definition) => (ForceIn::Coefficient, Unit::si_name(&definition.unit)),
            None => {
                let state = document.states.get(&name)?;
                (ForceIn::State, per_second(&Unit::si_name(&state.unit)))
            }
        };
        Some(Equation {
            name,
            force_in,
            unit,
        })
    });
    let outputs = document.outputs.iter().map(|(name, output)| Equation {
        name: name.clone(),
        force_in: ForceIn::Output,
        unit: Unit::si_name(&output.unit),
    });
    aerodynamic.chain(outputs).collect()
}

/// The unit of a rate, as an engineer writes it: `rad/s^2` for `rad/s`.
fn per_second(unit: &str) -> String {
    match unit.strip_suffix("/s") {
        Some(of) if !of.contains('/') => format!("{of}/s^2"),
        _ if unit == "-" => "1/s".to_string(),
        _ if unit.contains('/') => {
            let dimension = Unit::parse(unit).map_or(Dimension::NONE, |unit| unit.dimension);
            dimension.over(Dimension::SECOND).to_string()
        }
        _ => format!("{unit}/s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::{Case, Knowledge};
    use crate::estimate::Options;
    use crate::model::catalog;

    #[test]
    fn a_force_may_act_in_equations_of_motion_and_in_outputs() {
        let document = catalog::find("short-period").unwrap();
        let case = Case {
            document: document.clone(),
            flights: Vec::new(),
            options: Options::default(),
            candidates: Vec::new(),
            knowledge: Knowledge::default(),
            consumed: Vec::new(),
        };
        let found: Vec<(String, String)> = (of(&Ingredients::new(&case, &document), &document)
            .into_iter())
        .map(|equation| (equation.words(), equation.unit))
        .collect();
        let expected = [
            ("the equation of alpha", "rad/s"),
            ("the equation of q", "rad/s^2"),
            ("the output alpha", "rad"),
            ("the output q", "rad/s"),
        ];
        let expected = expected.map(|(words, unit)| (words.to_string(), unit.to_string()));
        assert_eq!(found, expected);
        assert_eq!(per_second("m/s^2"), "m/s^3");
    }
}
