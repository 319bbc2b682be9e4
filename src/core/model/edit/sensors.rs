//! Effects of sensors: what is recorded is not what is.
//!
//! The target is an output, or an input that is measured: there the model sees the recorded value less the error.

use super::edited::AddedRole;
use super::error::EditError;
use super::sheet::{Sheet, dimension, of_a_difference, per_second, unknown};
use crate::flight::{Dimension, PhysicalQuantity};
use crate::model::document::Parameter;

/// Usual bounds of a scale factor, less one, of a delay and of the time constant of a lag, s.
pub(super) const SCALE: (f64, f64) = (-0.9, 2.0);
pub(super) const DELAY: (f64, f64) = (-0.2, 0.5);
pub(super) const LAG: (f64, f64) = (0.0, 2.0);

/// A sensor: how a document has it.
pub(super) enum Sensor {
    Output { unit: String },
    Input { unit: String },
}

impl Sensor {
    pub(super) fn find(sheet: &Sheet, target: &str) -> Result<Self, EditError> {
        let document = &sheet.document;
        if let Some(output) = document.outputs.get(target) {
            let unit = output.unit.clone();
            return Ok(Self::Output { unit });
        }
        if let Some(input) = document.inputs.get(target) {
            let unit = input.unit.clone();
            return Ok(Self::Input { unit });
        }
        let known = document.outputs.keys().chain(document.inputs.keys());
        Err(sheet.no_target("output or measured input", target, known))
    }

    pub(super) fn unit(&self) -> &str {
        match self {
            Self::Output { unit } | Self::Input { unit } => unit,
        }
    }

    pub(super) fn quantity(&self, sheet: &Sheet, target: &str) -> Option<PhysicalQuantity> {
        let quantities = sheet.quantities();
        match self {
            Self::Output { .. } => quantities.output(target),
            Self::Input { .. } => quantities.get(target),
        }
    }

    /// Adds an error to what is recorded; `error` can stand behind a plus sign, or a minus sign in brackets.
    pub(super) fn add(&self, sheet: &mut Sheet, target: &str, error: &str) {
        match self {
            Self::Output { .. } => observe(sheet, target, |y| format!("{y} + {error}")),
            Self::Input { .. } => {
                (sheet.document).substitute(target, &format!("({target} - ({error}))"));
            }
        }
    }
}

fn observe(sheet: &mut Sheet, target: &str, change: impl Fn(&str) -> String) {
    if let Some(output) = sheet.document.outputs.get_mut(target) {
        output.equation = change(&output.equation);
    }
}

pub(super) fn bias(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let sensor = Sensor::find(sheet, target)?;
    let name = sheet.name(&format!("{target}_bias"))?;
    sensor.add(sheet, target, &name);
    let unit = of_a_difference(sensor.unit());
    sheet.add(
        &name,
        AddedRole::Size,
        unknown(unit, 0.0, None, format!("bias of {target}")),
    );
    Ok(())
}

pub(super) fn scale(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let sensor = Sensor::find(sheet, target)?;
    let name = sheet.name(&format!("{target}_scale"))?;
    match sensor {
        Sensor::Output { .. } => observe(sheet, target, |y| format!("(1 + {name})*({y})")),
        Sensor::Input { .. } => {
            (sheet.document).substitute(target, &format!("({target}/(1 + {name}))"));
        }
    }
    let words = format!("scale factor, less one, of {target}");
    sheet.add(
        &name,
        AddedRole::Size,
        unknown("-", 0.0, Some(SCALE), words),
    );
    Ok(())
}

pub(super) fn drift(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let sensor = Sensor::find(sheet, target)?;
    let name = sheet.name(&format!("{target}_drift"))?;
    sensor.add(sheet, target, &format!("{name}*t"));
    let unit = per_second(sensor.unit());
    sheet.add(
        &name,
        AddedRole::Size,
        unknown(unit, 0.0, None, format!("drift of {target}")),
    );
    Ok(())
}

/// One delay for all targets, which share a clock.
pub(super) fn delay(sheet: &mut Sheet) -> Result<(), EditError> {
    let name = sheet.name(&format!("{}_delay", sheet.stem()))?;
    for target in sheet.edit.target.split('+').map(str::trim) {
        match Sensor::find(sheet, target)? {
            Sensor::Output { .. } => {
                if let Some(output) = sheet.document.outputs.get_mut(target) {
                    add_to(&mut output.delay, &name);
                }
            }
            // the value that was recorded late is the one to be used earlier
            Sensor::Input { .. } => {
                if let Some(input) = sheet.document.inputs.get_mut(target) {
                    add_to(&mut input.delay, &format!("-{name}"));
                }
            }
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

/// Adds a term to the size of an element of a path.
pub(super) fn add_to(size: &mut Option<String>, term: &str) {
    *size = Some(match size {
        Some(before) => format!("{before} + ({term})"),
        None => term.to_string(),
    });
}

/// Joins a lag that is there already, as that of an actuator does. Of a measured input it would have to be undone, which
/// the noise of the recording does not allow: only outputs have one.
pub(super) fn lag(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    if !sheet.document.outputs.contains_key(target) {
        return Err(sheet.no_target("output", target, sheet.document.outputs.keys()));
    }
    let name = sheet.name(&format!("{target}_lag"))?;
    if let Some(output) = sheet.document.outputs.get_mut(target) {
        add_to(&mut output.lag, &name);
    }
    let words = format!("time constant of the sensor of {target}");
    sheet.add(
        &name,
        AddedRole::TimeConstant,
        unknown("s", 0.0, Some(LAG), words),
    );
    Ok(())
}

/// A lightly damped mode of the structure, driven by an input, on top of what the sensor sees.
pub(super) fn structural_mode(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let driver = (sheet.edit).needed_term("the input that drives the mode, such as \"de\"")?;
    let Some(output) = sheet.document.outputs.get(target) else {
        return Err(sheet.no_target("output", target, sheet.document.outputs.keys()));
    };
    let unit = of_a_difference(&output.unit);
    if !sheet.document.inputs.contains_key(driver) {
        let known: Vec<_> = sheet.document.inputs.keys().map(String::as_str).collect();
        let message = format!("the model has no such input; it has {}", known.join(", "));
        return Err(sheet.edit.bad_term(message));
    }
    let of_gain = dimension(&unit).over(dimension(&sheet.input(driver)?));
    let gain = sheet.name(&format!("{target}_mode_gain"))?;
    let words = format!("static gain of the structural mode from {driver} to {target}");
    sheet.add(
        &gain,
        AddedRole::Size,
        unknown(of_gain.to_string(), 0.0, None, words),
    );
    let frequency = sheet.free(&format!("{target}_mode_frequency"));
    let words = "natural frequency of the structural mode".to_string();
    sheet.add(
        &frequency,
        AddedRole::Frequency,
        unknown("rad/s", 12.0, Some((3.0, 60.0)), words),
    );
    let damping = sheet.free(&format!("{target}_mode_damping"));
    let words = "damping ratio of the structural mode".to_string();
    sheet.add(
        &damping,
        AddedRole::Damping,
        unknown("-", 0.1, Some((0.001, 0.3)), words),
    );
    let first = sheet.first_of(driver);
    let eta = sheet.free(&format!("{target}_mode"));
    let rate = sheet.free(&format!("{target}_mode_rate"));
    let words = format!("structural mode in {target}");
    sheet.add_state(&eta, &unit, "0".into(), rate.clone(), words);
    let derivative = format!(
        "{frequency}^2*({gain}*({driver} - {first}) - {eta}) - 2*{damping}*{frequency}*{rate}"
    );
    let words = format!("rate of the structural mode in {target}");
    sheet.add_state(&rate, &per_second(&unit), "0".into(), derivative, words);
    observe(sheet, target, |y| format!("{y} + {eta}"));
    Ok(())
}

/// A length of a lever arm, m.
pub(super) fn arm(description: String) -> Parameter {
    unknown(
        Dimension::METRE.to_string(),
        0.0,
        Some((-30.0, 30.0)),
        description,
    )
}
