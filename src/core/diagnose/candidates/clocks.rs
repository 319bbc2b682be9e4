//! Delays of what shares a clock: one acquisition chain, all outputs, and groups that the job names.

use super::subject::Subject;
use crate::diagnose::effect::Effect;
use crate::flight::{Family, PhysicalQuantity};
use crate::model::EditKind;

/// Quantities by the instrument that records them.
const CHAINS: [&[Family]; 5] = [
    &[Family::AirData, Family::Velocity],
    &[Family::Accelerometer],
    &[Family::Gyro, Family::AngularAcceleration],
    &[Family::Attitude],
    &[Family::Position],
];

/// Each group of two or more once; single signals are among the sensors and inputs.
pub(super) fn candidates(subject: &Subject<'_>) -> Vec<Effect> {
    let document = subject.document;
    let outputs: Vec<&str> = document.outputs.keys().map(String::as_str).collect();
    let measured = subject.measured_inputs();
    let sensors: Vec<(&str, Option<PhysicalQuantity>)> = (outputs.iter())
        .map(|name| (*name, subject.quantities.output(name)))
        .chain(
            measured
                .iter()
                .map(|name| (name.as_str(), subject.quantities.get(name))),
        )
        .collect();
    let mut groups: Vec<Vec<&str>> = Vec::new();
    for chain in CHAINS {
        let of_chain = sensors.iter().filter(|(_, quantity)| {
            quantity.is_some_and(|quantity| chain.contains(&quantity.family()))
        });
        groups.push(of_chain.map(|(name, _)| *name).collect());
    }
    groups.push(outputs);
    let told = subject.case.knowledge.clocks.iter();
    groups.extend(told.map(|group| group.iter().map(String::as_str).collect()));
    let mut effects: Vec<Effect> = Vec::new();
    let mut seen: Vec<Vec<&str>> = Vec::new();
    for group in groups {
        let mut sorted = group.clone();
        sorted.sort_unstable();
        if group.len() > 1 && !seen.contains(&sorted) {
            seen.push(sorted);
            effects.push(Effect::edit(EditKind::SensorDelay, group.join("+"), None));
        }
    }
    let inputs = document.inputs.keys().map(String::as_str);
    let commanded: Vec<&str> = inputs.filter(|name| !subject.is_measured(name)).collect();
    if commanded.len() > 1 {
        effects.push(Effect::edit(
            EditKind::InputDelay,
            commanded.join("+"),
            None,
        ));
    }
    effects
}
