//! Sensors: outputs, and inputs that are measured motion, as the accelerometers and gyros of a reconstruction.

use super::Subject;
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
                .filter_map(|arm| subject.position(sensor, arm)),
        );
    }
    effects
}

impl<'c> Subject<'c> {
    /// Inputs that a sensor records of the motion: they come through no actuator.
    pub(super) fn measured_inputs(&self) -> Vec<&'c String> {
        let inputs = self.document.inputs.keys();
        inputs.filter(|name| self.is_measured(name)).collect()
    }

    pub(super) fn is_measured(&self, input: &str) -> bool {
        (self.quantities.get(input)).is_some_and(|quantity| quantity.is_motion())
    }

    /// Only sensors that a lever arm changes take it; what it needs and the model has not may be recorded.
    fn position(&self, sensor: &str, arm: &str) -> Option<Effect> {
        let edit = Edit {
            channels: self.channel_inputs(),
            ..Edit::new(EditKind::SensorPosition, sensor).with_term(arm)
        };
        self.fit(edit)
    }

    /// All recorded channels as inputs of the model.
    pub(super) fn channel_inputs(&self) -> indexmap::IndexMap<String, crate::model::Input> {
        let all = self.channels.iter();
        all.map(|channel| (channel.name.clone(), channel.input.clone()))
            .collect()
    }

    /// The effect of an edit that the document takes, with the channels that it uses and no others.
    pub(super) fn fit(&self, mut edit: Edit) -> Option<Effect> {
        let edited = edit.apply(self.document).ok()?;
        edit.channels
            .retain(|name, _| edited.inputs.contains_key(name));
        Some(Effect::of(edit))
    }
}
