//! Constants that stand in what is said of the recordings: numbers in their place.

use std::borrow::Cow;

use crate::flight::{Fault, Flown, Unit, escape};
use crate::job::constant::ConstantValue;
use crate::job::spec::{JobSpec, ManeuverUse};
use crate::model::{ModelDocument, Parameter, Per};

/// The spec with a number for every constant. One that is the same in all recordings is one of the job; others are those of
/// each maneuver.
pub(super) fn resolved<'s>(
    spec: &'s JobSpec,
    declared: &ModelDocument,
    faults: &mut Vec<Fault>,
) -> Cow<'s, JobSpec> {
    for (index, usage) in spec.maneuvers.iter().enumerate() {
        let found = usage.flown.iter().flat_map(Flown::faults);
        faults.extend(found.map(|fault| fault.under(&format!("/maneuvers/{index}/flown"))));
    }
    if !spec.refers_to_recordings() {
        return Cow::Borrowed(spec);
    }
    let mut numbers = spec.clone();
    for (name, value) in &spec.constants {
        let (Some(path), Some(unit)) = (value.of_recording(), unit_of(declared, name)) else {
            continue;
        };
        let place = format!("/constants/{}", escape(name));
        // what a maneuver says itself is not asked of its recording
        let asked = spec.maneuvers.iter().enumerate();
        let asked = asked.filter(|(_, usage)| !usage.constants.contains_key(name));
        let of = |(index, usage): (usize, &ManeuverUse)| {
            number(path, usage.flown.as_ref(), unit, &spec.label(index))
        };
        let found: Result<Vec<f64>, Fault> = asked.map(of).collect();
        match found {
            Err(fault) => faults.push(fault.under(&place)),
            Ok(found) => give(&mut numbers, name, &found),
        }
    }
    for (index, usage) in spec.maneuvers.iter().enumerate() {
        for (name, value) in &usage.constants {
            let (Some(path), Some(unit)) = (value.of_recording(), unit_of(declared, name)) else {
                continue;
            };
            let place = format!("/maneuvers/{index}/constants/{}", escape(name));
            match number(path, usage.flown.as_ref(), unit, &spec.label(index)) {
                Ok(number) => {
                    numbers.maneuvers[index]
                        .constants
                        .insert(name.clone(), number.into());
                }
                Err(fault) => faults.push(fault.under(&place)),
            }
        }
    }
    Cow::Owned(numbers)
}

/// The unit of a constant, or of what a constant becomes where each maneuver has a value of its own.
fn unit_of<'d>(declared: &'d ModelDocument, name: &str) -> Option<&'d str> {
    let constant = declared.constants.get(name).map(|constant| &constant.unit);
    let parameter = declared.parameters.get(name);
    let parameter = parameter.filter(|parameter| is_own_constant(parameter));
    constant
        .or(parameter.map(|parameter| &parameter.unit))
        .map(String::as_str)
}

/// Whether a parameter is a value that each maneuver has of its own and nothing is estimated of.
pub(super) fn is_own_constant(parameter: &Parameter) -> bool {
    parameter.fixed && parameter.per == Per::Maneuver
}

fn are_one(values: &[f64]) -> bool {
    values.windows(2).all(|pair| pair[0] == pair[1])
}

/// Gives a constant of the job its values, one for each maneuver that says none itself.
fn give(spec: &mut JobSpec, name: &str, values: &[f64]) {
    if are_one(values)
        && let Some(first) = values.first()
    {
        spec.constants.insert(name.to_string(), (*first).into());
        return;
    }
    spec.constants.shift_remove(name);
    let uses = spec.maneuvers.iter_mut();
    let asked = uses.filter(|usage| !usage.constants.contains_key(name));
    for (usage, value) in asked.zip(values) {
        let number = ConstantValue::Number(*value);
        usage.constants.insert(name.to_string(), number);
    }
}

/// The number of a quantity in a constant's unit.
fn number(
    path: Result<&str, &str>,
    flown: Option<&Flown>,
    unit: &str,
    label: &str,
) -> Result<f64, Fault> {
    let path = path.map_err(|text| {
        let text: String = text.chars().take(40).collect();
        let message = format!("'{text}' is no number and no quantity of a recording; write a number, or recording.mass, recording.centre_of_gravity.x, recording.inertia.Iy, recording.quantities.NAME");
        Fault::new("", "unknown_quantity", message)
    })?;
    let said: Vec<_> = flown.into_iter().flat_map(Flown::quantities).collect();
    let Some((_, quantity)) = said.iter().find(|(name, _)| name == path) else {
        let path: String = path.chars().take(80).collect();
        let names: Vec<&str> = said.iter().map(|(name, _)| name.as_str()).collect();
        let known = match names.is_empty() {
            true => "no quantity at all".to_string(),
            false => names.join(", "),
        };
        let message = format!(
            "nothing is said of '{path}' for the recording of maneuver '{label}', which has {known}; say it with PATCH /v1/maneuvers/{{id}}, as {{\"flown\": {{\"mass\": {{\"value\": 17600, \"unit\": \"kg\"}}}}}}"
        );
        return Err(Fault::new("", "unknown_quantity", message));
    };
    let mismatch = || {
        let message = format!(
            "{path} of the recording of maneuver '{label}' is in {}, and the constant in {}",
            quantity.unit, unit
        );
        Fault::new("", "unit_mismatch", message)
    };
    let (value, dimension) = quantity.in_si().ok_or_else(mismatch)?;
    // a unit of the model that cannot be read is told of the model
    let unit = Unit::parse(unit).unwrap_or(Unit::NONE);
    match unit.dimension == dimension {
        true => Ok(unit.from_si(value)),
        false => Err(mismatch()),
    }
}
