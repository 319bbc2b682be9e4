//! A trim as it is told.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::conditions::Subject;
use super::trimmed::Trimmed;
use crate::flight::Unit;

/// Whether there is a steady flight of this kind.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum TrimOutcome {
    /// All conditions are met.
    Trimmed,
    /// They are not: the values are those that come nearest.
    NotReached,
}

/// What a quantity of a trim is.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum TrimKind {
    /// x
    State,
    /// u
    Input,
    /// A named intermediate quantity.
    Definition,
    /// y
    Output,
}

/// A quantity in steady flight.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct TrimQuantity {
    /// As the model calls it.
    #[schema(example = "de")]
    pub name: String,
    /// What it is in the model.
    pub kind: TrimKind,
    /// SI
    #[schema(example = "rad")]
    pub unit: String,
    /// In `unit`.
    #[schema(example = -0.031)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub value: f64,
    /// One standard error, from the covariance of the parameters; absent without one.
    #[schema(example = 0.0004)]
    pub standard_error: Option<f64>,
    /// Of a state or input: held, or at a limit that the conditions push it to.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub held: bool,
}

/// A condition and how far it is met.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct TrimCondition {
    /// The quantity, or the state whose rate it is.
    #[schema(example = "theta")]
    pub name: String,
    /// Whether it is the rate.
    pub rate: bool,
    /// SI
    #[schema(example = "rad/s")]
    pub unit: String,
    /// What was asked for.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub wanted: f64,
    /// What it is.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub reached: f64,
}

/// A steady flight, or what comes nearest to it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Trim {
    /// Whether all conditions are met.
    pub outcome: TrimOutcome,
    /// States, inputs, definitions, outputs, in the order of the model.
    pub quantities: Vec<TrimQuantity>,
    /// Rates of states, then what is held.
    pub conditions: Vec<TrimCondition>,
    /// States and inputs that no condition decides, alone or together: they are where the search began.
    #[schema(example = json!([["psi"], ["h"]]))]
    pub undetermined: Vec<Vec<String>>,
}

/// The trim, with the standard error that `error` makes of slopes by parameter.
pub(super) fn report(trimmed: &Trimmed<'_>, error: impl Fn(&[f64]) -> Option<f64>) -> Trim {
    let slopes = trimmed.slopes();
    let error = |row: usize| {
        let slopes = slopes.as_ref()?;
        let row: Vec<f64> = slopes.row(row).iter().copied().collect();
        error(&row)
    };
    let (model, solution) = (trimmed.model, &trimmed.solution);
    let values = trimmed.values();
    let is_open = |place: usize| {
        solution
            .undetermined
            .iter()
            .flatten()
            .any(|&at| at == place)
    };
    let states = model.states.iter().map(|of| (of, TrimKind::State));
    let inputs = model.inputs.iter().map(|of| (of, TrimKind::Input));
    let unknowns = states.chain(inputs).enumerate();
    let mut quantities: Vec<TrimQuantity> = unknowns
        .map(|(place, (of, kind))| TrimQuantity {
            name: of.name.clone(),
            kind,
            unit: of.si.clone(),
            value: values[place],
            standard_error: error(place).filter(|_| !is_open(place)),
            held: solution.is_held[place],
        })
        .collect();
    for (name, unit, is_definition) in &trimmed.equations.quantities {
        let place = quantities.len();
        quantities.push(TrimQuantity {
            name: name.clone(),
            kind: match is_definition {
                true => TrimKind::Definition,
                false => TrimKind::Output,
            },
            unit: Unit::si_name(unit),
            value: values[place],
            standard_error: error(place),
            held: false,
        });
    }
    let name = |place: &usize| quantities[*place].name.clone();
    Trim {
        outcome: match solution.is_reached {
            true => TrimOutcome::Trimmed,
            false => TrimOutcome::NotReached,
        },
        conditions: conditions(trimmed),
        undetermined: (solution.undetermined.iter())
            .map(|places| places.iter().map(name).collect())
            .collect(),
        quantities,
    }
}

fn conditions(trimmed: &Trimmed<'_>) -> Vec<TrimCondition> {
    let all = trimmed
        .conditions
        .all
        .iter()
        .zip(&trimmed.solution.residual);
    all.map(|(condition, residual)| TrimCondition {
        name: condition.name.clone(),
        rate: matches!(condition.subject, Subject::Rate(_)),
        unit: condition.si.clone(),
        wanted: condition.wanted,
        reached: condition.wanted + residual,
    })
    .collect()
}
