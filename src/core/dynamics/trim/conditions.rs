//! The conditions of a trim, in SI, and the names in them.

use nalgebra::DMatrix;

use super::equations::{At, Equations, Rows};
use super::spec::{TrimSpec, TrimValue};
use crate::flight::{Dimension, Fault, Faults, PhysicalQuantity, Unit, escape};
use crate::model::{ChannelFormula, Model, Quantities, Recorded};

/// What is to have a value.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Subject {
    /// The rate of a state.
    Rate(usize),
    /// A state or input.
    Unknown(usize),
    /// A definition or output.
    Quantity(usize),
}

/// One condition.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Condition {
    pub subject: Subject,
    pub name: String,
    /// SI
    pub wanted: f64,
    /// As the field writes it.
    pub si: String,
}

pub(super) struct Conditions {
    pub all: Vec<Condition>,
    /// By state, then input: where the search begins.
    pub start: Vec<f64>,
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
}

impl Conditions {
    pub(super) fn of(
        spec: &TrimSpec,
        model: &Model,
        equations: &Equations,
        parameters: &[f64],
    ) -> Result<Self, Faults> {
        let mut reader = Reader {
            model,
            equations,
            faults: Vec::new(),
        };
        let all = reader.conditions(spec);
        let unknowns = equations.states + equations.inputs;
        let mut start = equations.initial(parameters);
        start.resize(unknowns, 0.0);
        // a state that is held begins there
        for condition in &all {
            if let Subject::Unknown(place) = condition.subject {
                start[place] = condition.wanted;
            }
        }
        begin_in_flight(model, equations, &all, &mut start);
        for (name, value) in &spec.start {
            let pointer = format!("/start/{}", escape(name));
            if let Some((place, value)) = reader.unknown(&pointer, name, value) {
                start[place] = value;
            }
        }
        let mut lower = vec![f64::NEG_INFINITY; unknowns];
        let mut upper = vec![f64::INFINITY; unknowns];
        for (name, [least, most]) in &spec.limits {
            let pointer = format!("/limits/{}", escape(name));
            let least = reader.unknown(&format!("{pointer}/0"), name, least);
            let most = reader.unknown(&format!("{pointer}/1"), name, most);
            if let (Some((place, least)), Some((_, most))) = (least, most) {
                if least > most {
                    let message = "the smaller limit comes first";
                    reader
                        .faults
                        .push(Fault::new(&pointer, "bad_bounds", message));
                } else if let Some(message) = held_outside(&all, place, [least, most]) {
                    reader
                        .faults
                        .push(Fault::new(&pointer, "bad_bounds", message));
                }
                (lower[place], upper[place]) = (least, most);
            }
        }
        match reader.faults.is_empty() {
            true => Ok(Self {
                start: (start.iter().zip(&lower).zip(&upper))
                    .map(|((z, lower), upper)| z.max(*lower).min(*upper))
                    .collect(),
                all,
                lower,
                upper,
            }),
            false => Err(reader.faults.into()),
        }
    }

    /// F with its derivatives, from those of rates and quantities.
    pub(super) fn rows(&self, at: &At) -> Rows {
        let (unknowns, parameters) = (at.rates.by_unknown.ncols(), at.rates.by_parameter.ncols());
        let mut rows = Rows {
            values: Vec::new(),
            by_unknown: DMatrix::zeros(self.all.len(), unknowns),
            by_parameter: DMatrix::zeros(self.all.len(), parameters),
        };
        for (place, condition) in self.all.iter().enumerate() {
            let of = |rows: &Rows, row: usize| {
                (
                    rows.values[row],
                    rows.by_unknown.row(row).into_owned(),
                    rows.by_parameter.row(row).into_owned(),
                )
            };
            let (value, by_unknown, by_parameter) = match condition.subject {
                Subject::Rate(state) => of(&at.rates, state),
                Subject::Quantity(quantity) => of(&at.quantities, quantity),
                // it is put there, and stays
                Subject::Unknown(_) => {
                    rows.values.push(0.0);
                    continue;
                }
            };
            rows.values.push(value - condition.wanted);
            rows.by_unknown.set_row(place, &by_unknown);
            rows.by_parameter.set_row(place, &by_parameter);
        }
        rows
    }
}

/// Why a state or input cannot be held where it is: its limits exclude the value.
fn held_outside(all: &[Condition], place: usize, [least, most]: [f64; 2]) -> Option<String> {
    let held = (all.iter()).find(|one| one.subject == Subject::Unknown(place))?;
    let is_within = (least..=most).contains(&held.wanted);
    (!is_within).then(|| {
        let wanted = held.wanted;
        format!(
            "it is held at {wanted} (SI), outside {least} to {most}: change what is held or the limits"
        )
    })
}

/// Where the airspeed is held and the velocity is a state, the search begins in flight, not at rest.
fn begin_in_flight(model: &Model, equations: &Equations, all: &[Condition], start: &mut [f64]) {
    let quantities = Quantities::of(&model.document);
    let is_airspeed = |condition: &&Condition| {
        let name = condition.name.as_str();
        let declared = quantities.get(name).or_else(|| quantities.output(name));
        !matches!(condition.subject, Subject::Rate(_))
            && declared == Some(PhysicalQuantity::Airspeed)
    };
    let Some(held) = all.iter().find(is_airspeed) else {
        return;
    };
    for (place, state) in model.states.iter().enumerate().take(equations.states) {
        let quantity = quantities.get(&state.name);
        let is_speed = matches!(
            quantity,
            Some(PhysicalQuantity::Airspeed | PhysicalQuantity::VelocityX)
        );
        if is_speed && !start[place].is_normal() {
            start[place] = held.wanted;
        }
    }
}

struct Reader<'m> {
    model: &'m Model,
    equations: &'m Equations,
    faults: Vec<Fault>,
}

/// A name of the model: what it is, and its units.
struct Named {
    subject: Subject,
    unit: Unit,
    si: String,
}

impl Reader<'_> {
    /// Rates of all states that are not free, then what is held.
    fn conditions(&mut self, spec: &TrimSpec) -> Vec<Condition> {
        let states = &self.model.states;
        let position = |name: &str| states.iter().position(|state| state.name == name);
        let mut conditions = Vec::new();
        for name in spec.rates.keys().chain(&spec.free_rates) {
            if position(name).is_none() {
                let field = if spec.rates.contains_key(name) {
                    "rates"
                } else {
                    "free_rates"
                };
                let known: Vec<&str> = states.iter().map(|s| s.name.as_str()).collect();
                let message = format!("'{name}' is no state; states are {}", known.join(", "));
                let pointer = format!("/{field}/{}", escape(name));
                self.faults
                    .push(Fault::new(pointer, "unknown_symbol", message));
            }
        }
        for (place, state) in self.model.states.iter().enumerate() {
            if spec.free_rates.contains(&state.name) {
                continue;
            }
            let unit = Unit {
                dimension: state.unit.dimension.over(Dimension::SECOND),
                offset: 0.0,
                ..state.unit
            };
            let pointer = format!("/rates/{}", escape(&state.name));
            let wanted =
                (spec.rates.get(&state.name)).and_then(|value| self.value(&pointer, value, unit));
            conditions.push(Condition {
                subject: Subject::Rate(place),
                name: state.name.clone(),
                wanted: wanted.unwrap_or(0.0),
                si: per_second(&state.si),
            });
        }
        for (name, value) in &spec.hold {
            let pointer = format!("/hold/{}", escape(name));
            let Some(named) = self.named(&pointer, name) else {
                continue;
            };
            if let Some(wanted) = self.value(&pointer, value, named.unit) {
                conditions.push(Condition {
                    subject: named.subject,
                    name: name.clone(),
                    wanted,
                    si: named.si,
                });
            }
        }
        conditions
    }

    /// A state or input and a value of it.
    fn unknown(&mut self, pointer: &str, name: &str, value: &TrimValue) -> Option<(usize, f64)> {
        let named = self.named(pointer, name)?;
        let Subject::Unknown(place) = named.subject else {
            let message = format!("'{name}' is no state or input: only these are searched for");
            self.faults
                .push(Fault::new(pointer, "unknown_symbol", message));
            return None;
        };
        Some((place, self.value(pointer, value, named.unit)?))
    }

    fn named(&mut self, pointer: &str, name: &str) -> Option<Named> {
        let unknowns = self.model.states.iter().chain(&self.model.inputs);
        if let Some((place, of)) = unknowns.enumerate().find(|(_, of)| of.name == name) {
            return Some(Named {
                subject: Subject::Unknown(place),
                unit: of.unit,
                si: of.si.clone(),
            });
        }
        let quantities = &self.equations.quantities;
        if let Some(place) = quantities.iter().position(|(known, ..)| known == name) {
            let text = &quantities[place].1;
            return Some(Named {
                subject: Subject::Quantity(place),
                unit: Unit::parse(text).unwrap_or(Unit::NONE),
                si: Unit::si_name(text),
            });
        }
        let unknowns = self.model.states.iter().chain(&self.model.inputs);
        let known = unknowns.map(|of| of.name.as_str());
        let known = known.chain(quantities.iter().map(|(known, ..)| known.as_str()));
        let message = format!(
            "the model has no '{name}'; it has {}",
            known.collect::<Vec<_>>().join(", ")
        );
        self.faults
            .push(Fault::new(pointer, "unknown_symbol", message));
        None
    }

    /// SI.
    fn value(&mut self, pointer: &str, value: &TrimValue, unit: Unit) -> Option<f64> {
        let found = match value {
            TrimValue::Number(number) => Ok(unit.to_si(*number)),
            TrimValue::Text(text) => with_unit(text, unit),
        };
        let found = found.and_then(|value| match value.is_finite() {
            true => Ok(value),
            false => Err("give a finite number".to_string()),
        });
        match found {
            Ok(value) => Some(value),
            Err(message) => {
                self.faults.push(Fault::new(pointer, "bad_value", message));
                None
            }
        }
    }
}

/// `20[deg]` in SI, where its dimension is that of the unit; a number alone is in the unit, as [`TrimValue::Number`] is.
fn with_unit(text: &str, unit: Unit) -> Result<f64, String> {
    if let Ok(number) = text.trim().parse() {
        return Ok(unit.to_si(number));
    }
    let formula = ChannelFormula::parse(text).map_err(|why| why.to_string())?;
    let value = formula.number(&Nothing).map_err(|why| why.to_string())?;
    let dimension = formula.dimension(&Nothing).map_err(|why| why.to_string())?;
    match dimension {
        Some(dimension) if dimension != unit.dimension => Err(format!(
            "'{text}' is in {dimension} where {} is needed; write its unit in square brackets",
            unit.dimension
        )),
        // arithmetic is in SI: without a unit its meaning is clear only where the model's unit is SI too
        _ if !text.contains('[') && unit.to_si(value) != value => Err(format!(
            "'{text}' has no unit, and arithmetic is in SI: write its unit in square brackets"
        )),
        _ => Ok(value),
    }
}

fn per_second(si: &str) -> String {
    match si {
        "" | "-" => "1/s".to_string(),
        si if si.ends_with("/s") => format!("{si}^2"),
        si => format!("{si}/s"),
    }
}

/// No recording.
struct Nothing;

impl Recorded for Nothing {
    fn time(&self) -> &[f64] {
        &[]
    }

    fn channel(&self, _: &str) -> Option<(&[f64], Dimension)> {
        None
    }

    fn names(&self) -> Vec<String> {
        Vec::new()
    }
}
