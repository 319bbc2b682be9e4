//! Everything that a force may depend on, along all flights: what the model computes, and what else was recorded.

use super::flown::Flown;
use crate::diagnose::candidates::Ingredients;
use crate::diagnose::case::{Case, compile};
use crate::flight::{Dimension, Unit};
use crate::model::{Model, ModelDocument, Output};
use crate::simulate::{Segment, simulate};

/// One quantity along all flights.
#[derive(Clone, Debug)]
pub(super) struct Quantity {
    /// `alpha`, `alphadot`, `alpha*q`.
    pub name: String,
    /// Names of what it is a product of.
    pub factors: Vec<String>,
    /// SI
    pub unit: String,
    /// By flight, then sample.
    pub values: Vec<Vec<f64>>,
}

/// Quantities by themselves, and those of which products are looked at, at most.
const MOST: usize = 24;
const MOST_FACTORS: usize = 8;

/// Below this share of its size a quantity does not move.
const STILL: f64 = 1e-6;

/// Two quantities that are as like as this are one.
const ALIKE: f64 = 0.9999;

/// Quantities that move in the flights that were fitted, the usual arguments of aerodynamic terms first, each once.
pub(super) fn all(case: &Case, flown: &Flown, ingredients: &Ingredients<'_>) -> Vec<Quantity> {
    let known = ingredients.variables();
    let mut computed = computed(flown).unwrap_or_default();
    computed.extend(recorded(case, flown, &computed));
    let place = |name: &str| known.iter().position(|v| v == name).unwrap_or(known.len());
    computed.sort_by_key(|quantity| place(&quantity.name));
    let usual = (computed.iter())
        .filter(|q| known.contains(&q.name))
        .count();
    let mut kept: Vec<Quantity> = Vec::new();
    let mut factors = 0;
    for (at, quantity) in computed.into_iter().enumerate() {
        let is_new = !kept
            .iter()
            .any(|k| correlation(k, &quantity, flown.fitted).abs() > ALIKE);
        if kept.len() < MOST && quantity.moves(flown.fitted) && is_new {
            kept.push(quantity);
            if at < usual {
                factors = kept.len();
            }
        }
    }
    let factors = factors.min(MOST_FACTORS);
    for i in 0..factors {
        for j in i + 1..factors {
            let product = kept[i].times(&kept[j], flown.fitted);
            kept.push(product);
        }
    }
    kept
}

impl Quantity {
    fn of(name: &str, unit: String, values: Vec<Vec<f64>>) -> Self {
        Self {
            name: name.to_string(),
            factors: vec![name.to_string()],
            unit,
            values,
        }
    }

    /// Mean over the first flights, those that were fitted.
    pub(super) fn mean(&self, fitted: usize) -> f64 {
        let count: usize = self.values[..fitted].iter().map(Vec::len).sum();
        self.values[..fitted].iter().flatten().sum::<f64>() / count.max(1) as f64
    }

    /// Least and greatest over the first flights.
    pub(super) fn range(&self, flights: usize) -> (f64, f64) {
        let values = self.values[..flights].iter().flatten();
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &v| {
            (least.min(v), most.max(v))
        })
    }

    /// Below each of these lies such a share of its samples in the first flights.
    pub(super) fn quantiles<const N: usize>(&self, flights: usize, shares: [f64; N]) -> [f64; N] {
        let samples = self.values[..flights].iter().flatten();
        let mut sorted: Vec<f64> = samples.copied().collect();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().saturating_sub(1) as f64;
        let at = |share: f64| sorted.get((share * last).round() as usize).copied();
        shares.map(|share| at(share).unwrap_or(0.0))
    }

    fn moves(&self, fitted: usize) -> bool {
        let (least, most) = self.range(fitted);
        let finite = self.values.iter().flatten().all(|value| value.is_finite());
        finite && most - least > STILL * least.abs().max(most.abs())
    }

    /// The product of two, each about its mean: what is not in either alone.
    fn times(&self, other: &Self, fitted: usize) -> Self {
        let (a, b) = (self.mean(fitted), other.mean(fitted));
        let flights = self.values.iter().zip(&other.values);
        let unit = |text: &str| Unit::parse(text).map_or(Dimension::NONE, |u| u.dimension);
        Self {
            name: format!("{}*{}", self.name, other.name),
            factors: vec![self.name.clone(), other.name.clone()],
            unit: unit(&self.unit).times(unit(&other.unit)).to_string(),
            values: flights
                .map(|(x, y)| x.iter().zip(y).map(|(x, y)| (x - a) * (y - b)).collect())
                .collect(),
        }
    }
}

fn correlation(a: &Quantity, b: &Quantity, fitted: usize) -> f64 {
    let (mean_a, mean_b) = (a.mean(fitted), b.mean(fitted));
    let pairs = a.values[..fitted].iter().zip(&b.values[..fitted]);
    let pairs = pairs.flat_map(|(a, b)| a.iter().zip(b));
    let (mut aa, mut bb, mut ab) = (0.0, 0.0, 0.0);
    for (a, b) in pairs {
        let (a, b) = (a - mean_a, b - mean_b);
        aa += a * a;
        bb += b * b;
        ab += a * b;
    }
    ab / (aa * bb).sqrt().max(f64::MIN_POSITIVE)
}

/// States, inputs and definitions, and the rates of states, as the model has them: its outputs, for once.
fn computed(flown: &Flown) -> Option<Vec<Quantity>> {
    let document = &flown.problem.model.document;
    let mut told = document.clone();
    told.outputs.clear();
    let mut names = Vec::new();
    // no output may be called as an input is
    let mut add = |name: &str, unit: &str, equation: &str| {
        let output = Output {
            unit: unit.to_string(),
            equation: equation.to_string(),
            ..Output::default()
        };
        told.outputs.insert(format!("told_{}", names.len()), output);
        names.push(name.to_string());
    };
    for (name, state) in &document.states {
        add(name, &state.unit, name);
    }
    for (name, input) in &document.inputs {
        add(name, &input.unit, name);
    }
    for (name, definition) in &document.definitions {
        add(name, &definition.unit, name);
    }
    for (name, state) in &document.states {
        let rate = format!("{name}dot");
        if !is_taken(document, &rate) {
            let unit = Unit::parse(&state.unit).map_or(Dimension::NONE, |u| u.dimension);
            add(
                &rate,
                &unit.over(Dimension::SECOND).to_string(),
                &state.derivative,
            );
        }
    }
    let model = compile(&told).ok()?;
    let mut values = vec![Vec::new(); model.outputs.len()];
    for (index, segment) in flown.problem.segments.iter().enumerate() {
        let histories = along(flown, &model, segment, index);
        values
            .iter_mut()
            .zip(histories)
            .for_each(|(to, from)| to.push(from));
    }
    let all = names.iter().zip(&model.outputs).zip(values);
    Some(
        all.map(|((name, output), values)| Quantity::of(name, output.si.clone(), values))
            .collect(),
    )
}

fn along(flown: &Flown, model: &Model, segment: &Segment, index: usize) -> Vec<Vec<f64>> {
    let options = &flown.problem.options;
    let mut histories = vec![Vec::with_capacity(segment.len()); model.outputs.len()];
    simulate(
        model,
        options.integrator,
        options.input_interpolation,
        segment,
        &flown.parameters(index),
        |_, outputs: &[f64]| {
            let pairs = histories.iter_mut().zip(outputs);
            pairs.for_each(|(history, &value)| history.push(value));
        },
    );
    histories
}

fn is_taken(document: &ModelDocument, name: &str) -> bool {
    document.states.contains_key(name)
        || document.inputs.contains_key(name)
        || document.definitions.contains_key(name)
        || document.parameters.contains_key(name)
        || document.constants.contains_key(name)
}

/// Channels that all flights have and the model does not use.
fn recorded(case: &Case, flown: &Flown, computed: &[Quantity]) -> Vec<Quantity> {
    let label = |segment: &Segment| {
        let mut flights = case.flights.iter();
        flights.find(|flight| flight.label == segment.label)
    };
    let flights: Option<Vec<_>> = flown.problem.segments.iter().map(label).collect();
    let Some(flights) = flights.filter(|flights| !flights.is_empty()) else {
        return Vec::new();
    };
    let outputs = &flown.problem.model.document.outputs;
    let is_new = |name: &String| {
        !outputs.contains_key(name)
            && !computed.iter().any(|quantity| quantity.name == *name)
            && !case.consumed.contains(name)
    };
    let channel = |name: &String| {
        let values = flights.iter().map(|flight| {
            let (values, _) = flight.channels.get(name)?;
            values.iter().all(|v| v.is_finite()).then(|| values.clone())
        });
        let (_, dimension) = flights[0].channels.get(name)?;
        let values = values.collect::<Option<Vec<_>>>()?;
        Some(Quantity::of(name, dimension.to_string(), values))
    };
    let names = flights[0].channels.keys().filter(|name| is_new(name));
    names.filter_map(channel).collect()
}
