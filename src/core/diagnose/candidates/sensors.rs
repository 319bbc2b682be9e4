//! Sensors: outputs, and inputs that are measured motion, as the accelerometers and gyros of a reconstruction.

use super::subject::Subject;
use crate::diagnose::effect::Effect;
use crate::model::{Edit, EditKind};

pub(super) fn candidates(subject: &Subject<'_>) -> Vec<Effect> {
    use EditKind::{SensorBias, SensorDelay, SensorDrift, SensorLag, SensorScale};
    let outputs: Vec<&String> = subject.document.outputs.keys().collect();
    let measured = subject.measured_inputs();
    let mut effects = Vec::new();
    for kind in [SensorBias, SensorScale, SensorDrift, SensorDelay, SensorLag] {
        // a lag cannot be undone without the derivative of what was recorded
        let inputs = measured.iter().filter(|_| kind != SensorLag);
        let all = outputs.iter().chain(inputs);
        effects.extend(all.map(|sensor| Effect::edit(kind, sensor.as_str(), None)));
    }
    for sensor in outputs.iter().chain(&measured) {
        effects.extend(
            ["x", "y", "z"]
                .into_iter()
                .filter_map(|arm| position(subject, sensor, arm)),
        );
    }
    effects
}

/// Only sensors that a lever arm changes take it; what it needs and the model has not may be recorded.
fn position(subject: &Subject<'_>, sensor: &str, arm: &str) -> Option<Effect> {
    let edit = Edit {
        channels: subject.channel_inputs(),
        ..Edit::new(EditKind::SensorPosition, sensor).with_term(arm)
    };
    subject.fit(edit)
}
