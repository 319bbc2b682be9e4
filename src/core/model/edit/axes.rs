//! Effects of several sensors at once: one that sees what another measures, and two that were exchanged.

use super::edited::AddedRole;
use super::error::EditError;
use super::sensors::Sensor;
use super::sheet::{Sheet, dimension, unknown};
use crate::flight::Dimension;
use crate::model::document::Parameter;

/// Usual bounds of the share that a sensor sees of another axis, and of the share to which two are exchanged.
const CROSS_AXIS: (f64, f64) = (-0.5, 0.5);
const EXCHANGED: (f64, f64) = (-0.5, 1.5);

/// y + k z, z what another output reads, or another name of the model, or a channel.
pub(super) fn cross_axis(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let sensor = Sensor::find(sheet, target)?;
    let other = (sheet.edit).needed_term("what the sensor sees too, such as \"p\"")?;
    if other == target {
        return Err(sheet
            .edit
            .bad_term("a sensor that sees more of itself is one of another scale"));
    }
    let (seen, measures) = match sheet.document.outputs.get(other) {
        Some(output) => (format!("({})", output.equation), dimension(&output.unit)),
        None => sheet.seen(other)?,
    };
    let name = sheet.name(&format!("{target}_sees_{other}"))?;
    sensor.add(sheet, target, &format!("{name}*{seen}"));
    let share = dimension(sensor.unit()).over(measures);
    let words = format!("share of {other} that the sensor of {target} sees");
    let bounds = share.is_none().then_some(CROSS_AXIS);
    let parameter = unknown(share.to_string(), 0.0, bounds, words);
    sheet.add(&name, AddedRole::Size, parameter);
    Ok(())
}

/// y1 + s (y2 − y1) and y2 + s (y1 − y2): with s = 1 each has the other's name. An angle and a rate are exchanged as numbers
/// in degrees and in degrees per second are.
pub(super) fn swapped(sheet: &mut Sheet) -> Result<(), EditError> {
    let names: Vec<&str> = sheet.edit.target.split('+').map(str::trim).collect();
    let [one, other] = names[..] else {
        return Err(sheet.unfit("two outputs can be exchanged, as in \"p+r\""));
    };
    let of = |name: &str| match sheet.document.outputs.get(name) {
        Some(output) => Ok((output.equation.clone(), dimension(&output.unit))),
        None => Err(sheet.no_target("output", name, sheet.document.outputs.keys())),
    };
    let ((first, measures), (second, also)) = (of(one)?, of(other)?);
    let ratio = measures.over(also);
    if one == other || !ratio.is_of_time() {
        let message = "two outputs of the same dimension can be exchanged, such as two rates, or an angle and a rate";
        return Err(sheet.unfit(message));
    }
    let name = sheet.name(&format!("{one}_{other}_swapped"))?;
    let words = format!("whether {one} and {other} are exchanged: 0 no, 1 yes");
    let parameter = unknown("-", 0.0, Some(EXCHANGED), words);
    sheet.add(&name, AddedRole::Size, parameter);
    let (times, over) = match ratio.is_none() {
        true => (String::new(), String::new()),
        false => {
            let factor = sheet.free(&format!("{one}_per_{other}"));
            let words = format!("a number of {one} for the same number of {other}");
            let fixed = Parameter {
                fixed: true,
                ..unknown(ratio.to_string(), 1.0, None, words)
            };
            sheet.add(&factor, AddedRole::Reference, fixed);
            (format!("{factor}*"), format!("/{factor}"))
        }
    };
    let outputs = &mut sheet.document.outputs;
    outputs[one].equation = format!("{first} + {name}*({times}({second}) - ({first}))");
    outputs[other].equation = format!("{second} + {name}*(({first}){over} - ({second}))");
    Ok(())
}

impl Sheet<'_> {
    /// A name that an equation may use, or one of the edit's channels, and what it measures.
    fn seen(&mut self, name: &str) -> Result<(String, Dimension), EditError> {
        let told = self.edit.channels.get(name).map(|input| input.unit.clone());
        if let (Some(unit), None) = (told, self.measures(name)) {
            let measures = dimension(&unit);
            return Ok((self.channel(name, &unit, "recorded")?, measures));
        }
        match self.measures(name) {
            Some(measures) => Ok((name.to_string(), measures)),
            None => Err(self.edit.bad_term("the model has no output, state, definition or input of this name, and the edit no such channel")),
        }
    }
}
