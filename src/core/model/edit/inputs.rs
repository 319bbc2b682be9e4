//! Effects between a recorded input and the control surface.

use super::EditError;
use super::edited::AddedRole;
use super::sensors::{DELAY, LAG, LAGS, SCALE, later};
use super::sheet::{Sheet, dimension, of_a_difference, per_second, unknown};
use crate::model::document::Parameter;

pub(super) fn bias(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let unit = of_a_difference(&sheet.input(target)?);
    let name = sheet.name(&format!("{target}_bias"))?;
    (sheet.document).substitute(target, &format!("({target} + {name})"));
    sheet.add(
        &name,
        AddedRole::Size,
        unknown(unit, 0.0, None, format!("bias of {target}")),
    );
    Ok(())
}

pub(super) fn scale(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    sheet.input(target)?;
    let name = sheet.name(&format!("{target}_scale"))?;
    (sheet.document).substitute(target, &format!("((1 + {name})*{target})"));
    let words = format!("scale factor, less one, of {target}");
    sheet.add(
        &name,
        AddedRole::Size,
        unknown("-", 0.0, Some(SCALE), words),
    );
    Ok(())
}

/// One delay for all targets, which share a clock.
pub(super) fn delay(sheet: &mut Sheet) -> Result<(), EditError> {
    let name = sheet.name(&format!("{}_delay", sheet.stem()))?;
    for target in sheet.edit.target.split('+').map(str::trim) {
        sheet.input(target)?;
        if let Some(input) = sheet.document.inputs.get_mut(target) {
            later(&mut input.delay, &name);
        }
    }
    let words = format!("time delay of {}", sheet.edit.target);
    sheet.add(
        &name,
        AddedRole::Delay,
        unknown("s", 0.0, Some(DELAY), words),
    );
    Ok(())
}

/// Puts a state in the place of an input in all equations; it starts at the input's first sample.
fn actuator(sheet: &mut Sheet, derivative: impl Fn(&str) -> String) -> Result<(), EditError> {
    let target = sheet.target();
    let unit = sheet.input(target)?;
    let state = sheet.free(&format!("{target}_actual"));
    sheet.document.substitute(target, &state);
    let initial = sheet.first_of(target);
    let words = format!("{target} behind its actuator");
    sheet.add_state(&state, &unit, initial, derivative(&state), words);
    Ok(())
}

pub(super) fn lag(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    sheet.input(target)?;
    let name = sheet.name(&format!("{target}_lag"))?;
    let words = format!("time constant of the actuator of {target}");
    sheet.add(
        &name,
        AddedRole::TimeConstant,
        unknown("s", LAG, Some(LAGS), words),
    );
    actuator(sheet, |state| format!("({target} - {state})/{name}"))
}

/// A short fixed time constant: how fast a surface follows where nothing holds it back.
fn following(sheet: &mut Sheet) -> String {
    let name = sheet.free(&format!("{}_following", sheet.target()));
    let words = "time constant with which the surface follows where it is free".to_string();
    let fixed = Parameter {
        fixed: true,
        ..unknown("s", LAG, Some(LAGS), words)
    };
    sheet.add(&name, AddedRole::TimeConstant, fixed);
    name
}

/// The limit starts at half a unit per second (29 deg/s of an angle), within 0.001 to 20.
pub(super) fn rate_limit(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let unit = sheet.input(target)?;
    let name = sheet.name(&format!("{target}_rate_limit"))?;
    let words = format!("largest rate of {target}");
    let bounds = if dimension(&unit).is_none() {
        (0.5, Some((1e-3, 20.0)))
    } else {
        (0.5, Some((1e-3, 1e6)))
    };
    sheet.add(
        &name,
        AddedRole::Limit,
        unknown(per_second(&unit), bounds.0, bounds.1, words),
    );
    let time = following(sheet);
    actuator(sheet, |state| {
        format!("{name}*tanh(({target} - {state})/({name}*{time}))")
    })
}

/// Half the width of the dead band starts at 0.
pub(super) fn backlash(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let unit = of_a_difference(&sheet.input(target)?);
    let name = sheet.name(&format!("{target}_backlash"))?;
    let words = format!("half the width of the dead band of {target}");
    let parameter = Parameter {
        lower: Some(0.0),
        ..unknown(unit, 0.0, None, words)
    };
    sheet.add(&name, AddedRole::Size, parameter);
    let time = following(sheet);
    actuator(sheet, |state| {
        format!(
            "(max(0, {target} - {name} - {state}) + min(0, {target} + {name} - {state}))/{time}"
        )
    })
}
