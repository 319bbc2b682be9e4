//! Delays of what shares a clock: one acquisition chain, all outputs, and groups that the job names.

use super::subject::Subject;
use crate::diagnose::effect::Effect;
use crate::flight::{Family, PhysicalQuantity};
use crate::model::EditKind;

/// Quantities by the instrument that records them: an air data computer; inertial sensors apart, and as one reference
/// system has them; a satellite receiver.
const CHAINS: [&[Family]; 8] = {
    use Family::{Accelerometer, AirData, AngularAcceleration, Attitude, Gyro, Position, Velocity};
    [
        &[AirData, Velocity],
        &[Accelerometer],
        &[Gyro, AngularAcceleration],
        &[Attitude],
        &[Gyro, AngularAcceleration, Attitude],
        &[Gyro, AngularAcceleration, Accelerometer],
        &[Gyro, AngularAcceleration, Accelerometer, Attitude],
        &[Position],
    ]
};

/// Each group of two or more once; single signals are among the sensors and inputs.
pub(super) fn candidates(subject: &Subject<'_>) -> Vec<Effect> {
    let document = subject.document;
    let outputs: Vec<&str> = document.outputs.keys().map(String::as_str).collect();
    let measured = subject.measured_inputs();
    let sensors: Vec<Sensor<'_>> = (outputs.iter())
        .map(|name| (*name, subject.quantities.output(name)))
        .chain(
            measured
                .iter()
                .map(|name| (name.as_str(), subject.quantities.get(name))),
        )
        .collect();
    let mut groups = chains(&sensors);
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

/// A name, and what it measures.
type Sensor<'n> = (&'n str, Option<PhysicalQuantity>);

/// What each instrument records. An altitude is that of the air data, or of the receiver that gives positions.
fn chains<'n>(sensors: &[Sensor<'n>]) -> Vec<Vec<&'n str>> {
    let those = |belongs: &dyn Fn(PhysicalQuantity) -> bool| -> Vec<&'n str> {
        let of = sensors
            .iter()
            .filter(|(_, quantity)| quantity.is_some_and(belongs));
        of.map(|(name, _)| *name).collect()
    };
    let is_altitude = |quantity| quantity == PhysicalQuantity::Altitude;
    let mut groups = Vec::new();
    for chain in CHAINS {
        let of_chain = |quantity: PhysicalQuantity| chain.contains(&quantity.family());
        groups.push(those(&of_chain));
        groups.push(those(&|quantity| {
            of_chain(quantity) && !is_altitude(quantity)
        }));
    }
    let of_receiver = |quantity: PhysicalQuantity| quantity.family() == Family::Position;
    groups.push(those(&|quantity| {
        of_receiver(quantity) || is_altitude(quantity)
    }));
    groups
}
