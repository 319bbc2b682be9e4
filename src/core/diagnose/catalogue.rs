//! The catalogue: every candidate that makes sense for a model and what was recorded with it.

use std::collections::BTreeSet;

use super::case::Case;
use super::effect::{Effect, Treatment};
use super::terms;
use crate::estimate::Role;
use crate::flight::{is_control, is_flow_angle, is_motion};
use crate::model::{EditKind, Model, ModelDocument};

/// Candidates for a model, in the order of the catalogue: instruments before aerodynamics.
pub fn candidates(case: &Case, model: &Model) -> Vec<Effect> {
    let document = &model.document;
    let mut effects = Vec::new();
    sensors(document, &mut effects);
    inputs(document, &mut effects);
    for (state, term) in terms::of(model) {
        effects.push(Effect::edit(EditKind::MissingTerm, state, Some(&term)));
    }
    let scaled = Effect::edit(EditKind::MissingTerm, "all", Some("qbar"));
    if scaled.apply(document).is_ok() {
        effects.push(scaled);
    }
    unsteady(document, &mut effects);
    unrecorded(case, model, &mut effects);
    surroundings(document, &mut effects);
    effects.extend(case.candidates.iter().cloned());
    effects
}

fn sensors(document: &ModelDocument, effects: &mut Vec<Effect>) {
    use EditKind::{SensorBias, SensorDelay, SensorDrift, SensorLag, SensorPosition, SensorScale};
    let outputs: Vec<&String> = document.outputs.keys().collect();
    for kind in [SensorBias, SensorScale, SensorDrift, SensorDelay, SensorLag] {
        effects.extend(
            outputs
                .iter()
                .map(|output| Effect::edit(kind, output.as_str(), None)),
        );
    }
    // one recorder's clock
    if outputs.len() > 1 {
        let all: Vec<&str> = outputs.iter().map(|output| output.as_str()).collect();
        effects.push(Effect::edit(SensorDelay, all.join("+"), None));
    }
    for output in outputs {
        for arm in ["x", "y", "z"] {
            let effect = Effect::edit(SensorPosition, output.as_str(), Some(arm));
            // only outputs that a lever arm changes take it
            if effect.apply(document).is_ok() {
                effects.push(effect);
            }
        }
    }
}

fn inputs(document: &ModelDocument, effects: &mut Vec<Effect>) {
    use EditKind::{ActuatorLag, ActuatorRateLimit, Backlash, InputBias, InputDelay, InputScale};
    for kind in [InputBias, InputScale, InputDelay] {
        let edits = document.inputs.keys();
        effects.extend(edits.map(|input| Effect::edit(kind, input.as_str(), None)));
    }
    // what a sensor records of the motion comes through no actuator
    for kind in [ActuatorLag, ActuatorRateLimit, Backlash] {
        let driven = (document.inputs.iter()).filter(|(name, input)| !is_motion(name, &input.unit));
        effects.extend(driven.map(|(input, _)| Effect::edit(kind, input.as_str(), None)));
    }
}

fn unsteady(document: &ModelDocument, effects: &mut Vec<Effect>) {
    let known = document.states.keys().chain(document.inputs.keys());
    let flow: Vec<&String> = known.filter(|name| is_flow_angle(name)).collect();
    for target in terms::aerodynamic(document) {
        for angle in flow.iter().filter(|angle| ***angle != target) {
            effects.push(Effect::edit(
                EditKind::UnsteadyAero,
                target.as_str(),
                Some(angle),
            ));
        }
    }
    let lifting = |name: &&str| document.definitions.contains_key(*name);
    let coefficients: Vec<&str> = ["CL", "CD", "Cm"].into_iter().filter(lifting).collect();
    if let (Some(angle), true) = (flow.first(), coefficients.contains(&"CL")) {
        for targets in ["CL", "CL+Cm", "CL+CD", "CL+CD+Cm"] {
            if targets.split('+').all(|name| coefficients.contains(&name)) {
                effects.push(Effect::edit(
                    EditKind::StallHysteresis,
                    targets,
                    Some(angle),
                ));
            }
        }
    }
}

/// Recorded channels that no equation uses: inputs by the look of them, those that are angles and move.
fn unrecorded(case: &Case, model: &Model, effects: &mut Vec<Effect>) {
    let document = &model.document;
    let mut names = BTreeSet::new();
    for flight in case.of_role(Role::Estimation) {
        for (name, (values, dimension)) in &flight.channels {
            let used = document.inputs.contains_key(name)
                || document.outputs.contains_key(name)
                || document.states.contains_key(name);
            let finite = values.iter().all(|value| value.is_finite());
            if !used && finite && dimension.is_none() && is_control(name) {
                names.insert(name.clone());
            }
        }
    }
    for name in names {
        for target in terms::aerodynamic(document) {
            let term = format!("{name}[rad]");
            effects.push(Effect::edit(EditKind::UnrecordedInput, target, Some(&term)));
        }
    }
}

fn surroundings(document: &ModelDocument, effects: &mut Vec<Effect>) {
    for name in ["W_x", "W_y", "W_z", "Wx", "Wy", "Wz"] {
        for term in ["constant", "ramp", "shear"] {
            let effect = Effect::edit(EditKind::Wind, name, Some(term));
            if effect.apply(document).is_ok() {
                effects.push(effect);
            }
        }
    }
    for state in document.states.keys() {
        effects.push(Effect::edit(EditKind::InitialState, state.as_str(), None));
    }
    for state in document.states.keys().filter(|name| is_flow_angle(name)) {
        effects.push(Effect::edit(EditKind::Gust, state.as_str(), None));
        effects.push(Effect::treatment(Treatment::ProcessNoise, state.as_str()));
    }
    for output in document.outputs.keys() {
        for input in document.inputs.keys().filter(|name| is_control(name)) {
            effects.push(Effect::edit(
                EditKind::StructuralMode,
                output.as_str(),
                Some(input),
            ));
        }
    }
}
