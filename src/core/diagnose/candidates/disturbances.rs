//! What comes from outside or was there at the start: wind, gusts, turbulence, initial states, the structure.

use super::subject::Subject;
use crate::diagnose::effect::{Effect, Treatment};
use crate::estimate::Role;
use crate::flight::{Family, PhysicalQuantity};
use crate::model::expression;
use crate::model::{Edit, EditKind, Per};

pub(super) fn candidates(subject: &Subject<'_>) -> Vec<Effect> {
    let mut effects = winds(subject);
    let states = subject.document.states.iter();
    let held = states.filter(|(_, state)| is_held(subject, &state.initial));
    effects.extend(held.map(|(name, _)| Effect::edit(EditKind::InitialState, name.as_str(), None)));
    effects.extend(air(subject));
    effects.extend(modes(subject));
    effects
}

/// Whether a state begins where the model has it: no maneuver has a free start of its own.
fn is_held(subject: &Subject<'_>, initial: &str) -> bool {
    let Ok(initial) = expression::parse(initial) else {
        return false;
    };
    let is_free = |name: &str| {
        let parameter = subject.document.parameters.get(name);
        parameter.is_some_and(|parameter| !parameter.fixed && parameter.per == Per::Maneuver)
    };
    !initial.names().iter().any(|(name, _)| is_free(name))
}

/// One candidate each: a wind is a vector.
fn winds(subject: &Subject<'_>) -> Vec<Effect> {
    use PhysicalQuantity::{WindX, WindY, WindZ};
    let components = [(WindX, "W_x"), (WindY, "W_y"), (WindZ, "W_z")];
    let wind = |term: &str, targets: &[&str]| {
        let mut fitting = targets.to_vec();
        fitting.retain(|target| {
            let edit = Edit::new(EditKind::Wind, *target).with_term(term);
            edit.apply(subject.document).is_ok()
        });
        (!fitting.is_empty()).then(|| Effect::edit(EditKind::Wind, fitting.join("+"), Some(term)))
    };
    let named =
        components.map(|(axis, usual)| subject.quantities.all_of(axis).next().unwrap_or(usual));
    // where each maneuver has a constant wind of its own already, another is the same
    let is_free = |name: &&str| {
        let parameter = subject.document.parameters.get(*name);
        parameter.is_some_and(|parameter| !parameter.fixed && parameter.per == Per::Maneuver)
    };
    let held: Vec<&str> = named.into_iter().filter(|name| !is_free(name)).collect();
    let constant = wind("constant", &held);
    let changing = ["ramp", "shear"]
        .into_iter()
        .filter_map(|term| wind(term, &named));
    constant.into_iter().chain(changing).collect()
}

/// Gusts meet the flow angles, of one flight each. Turbulence disturbs the states that they are, or are made of.
fn air(subject: &Subject<'_>) -> Vec<Effect> {
    use PhysicalQuantity::{AngleOfAttack, AngleOfSideslip, VelocityY, VelocityZ};
    let document = subject.document;
    let mut effects = Vec::new();
    for (angle, velocity) in [(AngleOfAttack, VelocityZ), (AngleOfSideslip, VelocityY)] {
        let mut angles = subject.quantities.all_of(angle);
        let name = angles.find(|name| subject.varies(name) && !document.inputs.contains_key(*name));
        let is_state = |name: &&str| document.states.contains_key(*name);
        let carries = !subject.aerodynamic().is_empty();
        if let Some(name) = name.filter(|name| carries || is_state(name)) {
            let flights = subject.case.of_role(Role::Estimation);
            effects.extend(
                flights.map(|flight| Effect::edit(EditKind::Gust, name, Some(&flight.label))),
            );
        }
        let velocity = || subject.quantities.all_of(velocity).find(is_state);
        let disturbed = name
            .filter(is_state)
            .or_else(|| velocity().filter(|_| carries));
        if let Some(state) = disturbed {
            effects.push(Effect::treatment(Treatment::ProcessNoise, state));
        }
    }
    effects
}

/// Rates, accelerations and vanes feel the structure, which controls of the same motion excite; what is integrated from
/// them hardly does.
fn modes(subject: &Subject<'_>) -> Vec<Effect> {
    let document = subject.document;
    let feels = |name: &&String| {
        let quantity = subject.quantities.output(name);
        quantity.is_none_or(|quantity| {
            quantity.is_flow_angle()
                || matches!(
                    quantity.family(),
                    Family::Gyro | Family::Accelerometer | Family::AngularAcceleration
                )
        })
    };
    let drives = |input: &str, output: &str| {
        let driven = subject
            .quantities
            .output(output)
            .and_then(PhysicalQuantity::motion);
        subject.quantities.get(input).is_some_and(|quantity| {
            let alike = driven.is_none() || quantity.motion().is_none_or(|own| Some(own) == driven);
            quantity.is_control() && quantity != PhysicalQuantity::Thrust && alike
        })
    };
    let of = |output: &String| {
        let inputs = document.inputs.keys().filter(|input| drives(input, output));
        let mode =
            |input: &String| Effect::edit(EditKind::StructuralMode, output.as_str(), Some(input));
        inputs.map(mode).collect::<Vec<_>>()
    };
    document.outputs.keys().filter(feels).flat_map(of).collect()
}
