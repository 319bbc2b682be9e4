//! What is offered for which model.

mod instruments;
mod names;
mod terms;

use std::collections::BTreeSet;

use indexmap::IndexMap;

use crate::diagnose::candidates;
use crate::diagnose::case::Case;
use crate::diagnose::effect::Effect;
use crate::diagnose::flight::Flight;
use crate::diagnose::knowledge::Knowledge;
use crate::estimate::{Options, Role};
use crate::flight::{PhysicalQuantity, Unit};
use crate::model::{Model, ModelDocument, catalog};
use crate::simulate::Steps;

/// Channels beside the model: name, unit, what they are.
const BESIDE: [(&str, &str, PhysicalQuantity); 9] = [
    ("alpha", "rad", PhysicalQuantity::AngleOfAttack),
    ("beta", "rad", PhysicalQuantity::AngleOfSideslip),
    ("p", "rad/s", PhysicalQuantity::RollRate),
    ("q", "rad/s", PhysicalQuantity::PitchRate),
    ("r", "rad/s", PhysicalQuantity::YawRate),
    ("V", "m/s", PhysicalQuantity::Airspeed),
    ("mach", "-", PhysicalQuantity::Mach),
    ("da", "rad", PhysicalQuantity::Aileron),
    ("df", "rad", PhysicalQuantity::Flap),
];

/// A flight in which everything moves, each channel in its own way.
fn case(document: &ModelDocument, beside: &[(String, &str, PhysicalQuantity)]) -> Case {
    let of_model = (document
        .inputs
        .iter()
        .map(|(name, x)| (name.clone(), x.unit.as_str())))
    .chain(
        document
            .outputs
            .iter()
            .map(|(name, x)| (name.clone(), x.unit.as_str())),
    );
    let all = of_model.chain(beside.iter().map(|(name, unit, _)| (name.clone(), *unit)));
    let mut channels = IndexMap::new();
    for (i, (name, unit)) in all.enumerate() {
        let dimension = Unit::parse(unit).unwrap().dimension;
        let wave = |k: usize| 1.0 + 0.1 * (0.01 * (i + 3) as f64 * k as f64).sin();
        let values: Vec<f64> = (0..200).map(wave).collect();
        channels.entry(name).or_insert((values, dimension));
    }
    let told = beside
        .iter()
        .map(|(name, _, quantity)| (name.clone(), *quantity));
    Case {
        document: document.clone(),
        flights: vec![Flight {
            label: "1".to_string(),
            role: Role::Estimation,
            time: (0..200).map(|k| 0.02 * k as f64).collect(),
            steps: Steps::Even(0.02),
            channels,
            own: IndexMap::new(),
        }],
        options: Options::default(),
        candidates: Vec::new(),
        knowledge: Knowledge {
            quantities: told.collect(),
            ..Knowledge::default()
        },
        consumed: Vec::new(),
    }
}

fn beside() -> Vec<(String, &'static str, PhysicalQuantity)> {
    BESIDE
        .map(|(name, unit, quantity)| (name.to_string(), unit, quantity))
        .to_vec()
}

fn offered(case: &Case) -> Vec<Effect> {
    let model = Model::compile(&case.document).unwrap_or_else(|faults| panic!("{faults:#?}"));
    candidates(case, &model)
}

fn of(model: &str) -> Vec<Effect> {
    offered(&case(&catalog::find(model).unwrap(), &beside()))
}

fn names(effects: &[Effect]) -> BTreeSet<String> {
    effects.iter().map(Effect::name).collect()
}
