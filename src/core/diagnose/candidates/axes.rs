//! Instruments of several axes: what a sensor sees of another axis, and channels under each other's name.

use super::subject::Subject;
use crate::diagnose::effect::Effect;
use crate::flight::{Dimension, Family, PhysicalQuantity, Unit};
use crate::model::{Edit, EditKind, Input};

pub(super) fn candidates(subject: &Subject<'_>) -> Vec<Effect> {
    let sensors = sensors(subject);
    let mut effects = cross_axis(subject, &sensors);
    effects.extend(swapped(subject, &sensors));
    effects
}

/// Something recorded, and what it is; of a channel that the model does not use, the input that it would be.
struct Recorded<'s> {
    name: &'s str,
    quantity: PhysicalQuantity,
    channel: Option<&'s Input>,
}

/// Outputs and measured inputs.
fn sensors<'s>(subject: &'s Subject<'_>) -> Vec<Recorded<'s>> {
    let outputs = (subject.document.outputs.keys())
        .map(|name| (name.as_str(), subject.quantities.output(name)));
    let measured = (subject.measured_inputs().into_iter())
        .map(|name| (name.as_str(), subject.quantities.get(name)));
    let of = |(name, quantity): (&'s str, Option<PhysicalQuantity>)| {
        Some(Recorded {
            name,
            quantity: quantity?,
            channel: None,
        })
    };
    outputs.chain(measured).filter_map(of).collect()
}

/// Each sensor with each other axis of its instrument.
fn cross_axis(subject: &Subject<'_>, sensors: &[Recorded<'_>]) -> Vec<Effect> {
    let channels = subject.channels.iter().map(|channel| Recorded {
        name: &channel.name,
        quantity: channel.quantity,
        channel: Some(&channel.input),
    });
    let beside: Vec<Recorded<'_>> = channels.collect();
    let mut effects = Vec::new();
    for sensor in sensors {
        let seen = sensors.iter().chain(&beside);
        let seen = seen.filter(|other| are_axes(sensor.quantity, other.quantity));
        effects.extend(seen.filter_map(|other| {
            let mut edit = Edit::new(EditKind::SensorCrossAxis, sensor.name).with_term(other.name);
            if let Some(input) = other.channel {
                edit.channels.insert(other.name.to_string(), input.clone());
            }
            subject.fit(edit)
        }));
    }
    effects
}

/// Whether two quantities are axes of one instrument: gyros, accelerometers, vanes.
fn are_axes(one: PhysicalQuantity, other: PhysicalQuantity) -> bool {
    let families = [Family::Gyro, Family::Accelerometer];
    let is_triad = one.family() == other.family() && families.contains(&one.family());
    let are_vanes = one.is_flow_angle() && other.is_flow_angle();
    one != other && (is_triad || are_vanes)
}

/// Each pair of outputs that could be taken for each other.
fn swapped(subject: &Subject<'_>, sensors: &[Recorded<'_>]) -> Vec<Effect> {
    let mut effects = Vec::new();
    for (place, one) in sensors.iter().enumerate() {
        for other in &sensors[place + 1..] {
            if are_alike(subject, one, other) {
                let pair = format!("{}+{}", one.name, other.name);
                effects.extend(subject.fit(Edit::new(EditKind::SwappedChannels, pair)));
            }
        }
    }
    effects
}

/// Two of one dimension, or an angle and a rate of one motion.
fn are_alike(subject: &Subject<'_>, one: &Recorded<'_>, other: &Recorded<'_>) -> bool {
    let measures = |sensor: &Recorded<'_>| -> Option<Dimension> {
        let output = subject.document.outputs.get(sensor.name)?;
        Some(Unit::parse(&output.unit).ok()?.dimension)
    };
    let Some(ratio) = measures(one).zip(measures(other)).map(|(a, b)| a.over(b)) else {
        return false;
    };
    let are_motion = one.quantity.is_motion() && other.quantity.is_motion();
    let of_one = one.quantity.motion() == other.quantity.motion();
    are_motion && (ratio.is_none() || (ratio.is_of_time() && of_one))
}
