//! Inputs that are commanded: what stands between the recorder and the surface.

use super::subject::Subject;
use crate::diagnose::effect::Effect;
use crate::flight::PhysicalQuantity;
use crate::model::EditKind;

pub(super) fn candidates(subject: &Subject<'_>) -> Vec<Effect> {
    use EditKind::{
        ActuatorLag, ActuatorRateLimit, Backlash, InputBias, InputDelay, InputScale, SensorDrift,
    };
    let inputs = subject.document.inputs.keys();
    let commanded: Vec<&String> = inputs.filter(|name| !subject.is_measured(name)).collect();
    let mut effects = Vec::new();
    for kind in [InputBias, InputScale, SensorDrift, InputDelay] {
        effects.extend(
            commanded
                .iter()
                .map(|input| Effect::edit(kind, input.as_str(), None)),
        );
    }
    // what is no control (a density, a wind) has no actuator either
    let driven = |name: &&&String| {
        let quantity = subject.quantities.get(name);
        quantity.is_none_or(|quantity| quantity.is_control())
    };
    for kind in [ActuatorLag, ActuatorRateLimit, Backlash] {
        let play = |name: &&&String| {
            kind == ActuatorLag || subject.quantities.get(name) != Some(PhysicalQuantity::Thrust)
        };
        let inputs = commanded.iter().filter(driven).filter(play);
        effects.extend(inputs.map(|input| Effect::edit(kind, input.as_str(), None)));
    }
    effects
}
