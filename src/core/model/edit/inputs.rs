//! Effects between a recorded input and the control surface.

use super::edited::AddedRole;
use super::error::EditError;
use super::sensors::{DELAY, LAG, SCALE, add_to};
use super::sheet::{Sheet, of_a_difference, per_second, unknown};
use crate::model::document::{Parameter, Start};

/// Bounds of a rate limit, SI: above what any recorder shows from one sample to the next, of forces too.
const RATE_LIMIT: (f64, f64) = (1e-3, 1e9);

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
            add_to(&mut input.delay, &name);
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

/// Joins a lag that is there already: two in a row are, but for their second order, one of the sum of both times.
pub(super) fn lag(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    sheet.input(target)?;
    let name = sheet.name(&format!("{target}_lag"))?;
    if let Some(input) = sheet.document.inputs.get_mut(target) {
        add_to(&mut input.lag, &name);
    }
    let words = format!("time constant of the actuator of {target}");
    sheet.add(
        &name,
        AddedRole::TimeConstant,
        unknown("s", 0.0, Some(LAG), words),
    );
    Ok(())
}

/// Without effect at its upper bound, which is beyond what can be recorded; it starts below the largest rate that is:
/// above it nothing would tell which way to go. Of two limits in a row the lower one counts.
pub(super) fn rate_limit(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let unit = per_second(&sheet.input(target)?);
    let name = sheet.name(&format!("{target}_rate_limit"))?;
    if let Some(input) = sheet.document.inputs.get_mut(target) {
        input.rate_limit = Some(match &input.rate_limit {
            Some(before) => format!("min({before}, {name})"),
            None => name.clone(),
        });
    }
    let words = format!("largest rate of {target}");
    let parameter = Parameter {
        start: Start::FromData(format!("0.6*largest_rate({target})")),
        ..unknown(unit, 0.0, Some(RATE_LIMIT), words)
    };
    sheet.add(&name, AddedRole::Limit, parameter);
    Ok(())
}

/// Half the width of the dead band. Two in a row are one of the sum of both.
pub(super) fn backlash(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let unit = of_a_difference(&sheet.input(target)?);
    let name = sheet.name(&format!("{target}_backlash"))?;
    if let Some(input) = sheet.document.inputs.get_mut(target) {
        add_to(&mut input.play, &name);
    }
    let words = format!("half the width of the dead band of {target}");
    let parameter = Parameter {
        lower: Some(0.0),
        ..unknown(unit, 0.0, None, words)
    };
    sheet.add(&name, AddedRole::Size, parameter);
    Ok(())
}
