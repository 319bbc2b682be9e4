//! The lever arm of a sensor that is not where the model has it: a vane or an accelerometer.

use super::edited::AddedRole;
use super::error::EditError;
use super::lookup::Speed;
use super::sensors::{Sensor, arm};
use super::sheet::{Sheet, dimension};
use crate::flight::{Dimension, PhysicalQuantity};

/// Which quantity a sensor measures.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Quantity {
    Alpha,
    Beta,
    Ax,
    Ay,
    Az,
}

impl Quantity {
    fn of(quantity: Option<PhysicalQuantity>, unit: &str) -> Option<Self> {
        let acceleration = Dimension::METRE.over(Dimension::SECOND.times(Dimension::SECOND));
        let (found, measures) = match quantity? {
            PhysicalQuantity::AngleOfAttack => (Self::Alpha, Dimension::NONE),
            PhysicalQuantity::AngleOfSideslip => (Self::Beta, Dimension::NONE),
            PhysicalQuantity::AccelerationX => (Self::Ax, acceleration),
            PhysicalQuantity::AccelerationY => (Self::Ay, acceleration),
            PhysicalQuantity::AccelerationZ => (Self::Az, acceleration),
            _ => return None,
        };
        (dimension(unit) == measures).then_some(found)
    }

    /// What one metre of the arm adds, as terms: a sign and the rates that are multiplied. `V` divides all.
    fn terms(self, axis: Axis) -> &'static [(&'static str, &'static [&'static str])] {
        match (self, axis) {
            (Self::Alpha, Axis::X) => &[("-", &["q"])],
            (Self::Alpha, Axis::Y) => &[("+", &["p"])],
            (Self::Beta, Axis::X) => &[("+", &["r"])],
            (Self::Beta, Axis::Z) => &[("-", &["p"])],
            (Self::Alpha, Axis::Z) | (Self::Beta, Axis::Y) => &[],
            (Self::Ax, Axis::X) => &[("-", &["q", "q"]), ("-", &["r", "r"])],
            (Self::Ax, Axis::Y) => &[("-", &["rdot"]), ("+", &["p", "q"])],
            (Self::Ax, Axis::Z) => &[("+", &["qdot"]), ("+", &["p", "r"])],
            (Self::Ay, Axis::X) => &[("+", &["rdot"]), ("+", &["p", "q"])],
            (Self::Ay, Axis::Y) => &[("-", &["p", "p"]), ("-", &["r", "r"])],
            (Self::Ay, Axis::Z) => &[("-", &["pdot"]), ("+", &["q", "r"])],
            (Self::Az, Axis::X) => &[("-", &["qdot"]), ("+", &["p", "r"])],
            (Self::Az, Axis::Y) => &[("+", &["pdot"]), ("+", &["q", "r"])],
            (Self::Az, Axis::Z) => &[("-", &["p", "p"]), ("-", &["q", "q"])],
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Axis {
    X,
    Y,
    Z,
}

/// α - x q/V + y p/V, β + x r/V - z p/V, a + ω̇ × r + ω × (ω × r). Rates that the document does not have are zero,
/// as in a motion in one plane; one of them must be there.
pub(super) fn lever_arm(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let sensor = Sensor::find(sheet, target)?;
    let (axis, letter) = match sheet.edit.term.as_deref() {
        None | Some("x") => (Axis::X, "x"),
        Some("y") => (Axis::Y, "y"),
        Some("z") => (Axis::Z, "z"),
        Some(_) => return Err(sheet.edit.bad_term("an arm is \"x\", \"y\" or \"z\"")),
    };
    let measured = sensor.quantity(sheet, target);
    let Some(quantity) = Quantity::of(measured, sensor.unit()) else {
        let message = format!(
            "only a flow angle (alpha, beta) or a specific force (ax, ay, az, in m/s^2) depends on a position by these \
             equations, and '{target}' in '{}' is none as far as its name, unit and equation tell; say its \"quantity\"",
            sensor.unit()
        );
        return Err(sheet.unfit(message));
    };
    let mut sum = String::new();
    let mut missing = Vec::new();
    for (sign, rates) in quantity.terms(axis) {
        let mut factors = Vec::new();
        for rate in *rates {
            match rate_in(sheet, rate)? {
                Some(text) => factors.push(text),
                None => missing.push(*rate),
            }
        }
        if factors.len() == rates.len() {
            let sign = if sum.is_empty() && *sign == "+" {
                ""
            } else {
                sign
            };
            sum.push_str(sign);
            sum.push_str(&factors.join("*"));
        }
    }
    if sum.is_empty() {
        let message = if missing.is_empty() {
            format!("it does not depend on the {letter} of its position")
        } else {
            format!("the model has none of {}", missing.join(", "))
        };
        return Err(sheet.unfit(message));
    }
    let name = sheet.name(&format!("{target}_{letter}"))?;
    let error = match quantity {
        Quantity::Alpha | Quantity::Beta => {
            let speed = sheet.speed(Speed::Any)?;
            format!("{name}*({sum})/{speed}")
        }
        _ => format!("{name}*({sum})"),
    };
    sensor.add(sheet, target, &error);
    let words =
        format!("position of the sensor of {target} along {letter}, from where the model has it");
    sheet.add(&name, AddedRole::Size, arm(words));
    Ok(())
}

/// A rate or a rotational acceleration for an equation. Where a rate is recorded only, so is its derivative.
fn rate_in(sheet: &mut Sheet, name: &str) -> Result<Option<String>, EditError> {
    use PhysicalQuantity::{
        PitchAcceleration, PitchRate, RollAcceleration, RollRate, YawAcceleration, YawRate,
    };
    let (rate, acceleration) = match name.chars().next() {
        Some('p') => (RollRate, RollAcceleration),
        Some('q') => (PitchRate, PitchAcceleration),
        _ => (YawRate, YawAcceleration),
    };
    if !name.ends_with("dot") {
        return Ok(sheet.quantity(rate));
    }
    if let Some(found) = sheet.quantity(acceleration) {
        return Ok(Some(found));
    }
    let quantities = sheet.quantities();
    let mut rates = quantities.all_of(rate);
    let document = &sheet.document;
    if let Some(state) = rates.find_map(|rate| document.states.get(rate)) {
        return Ok(Some(format!("({})", state.derivative)));
    }
    let mut rates = quantities.all_of(rate);
    let Some(rate) = rates.find(|rate| document.inputs.contains_key(*rate)) else {
        return Ok(None);
    };
    let (usual, words) = (format!("{rate}dot"), format!("derivative of {rate}"));
    (sheet.recorded(acceleration, &usual, "rad/s^2", &words)).map(Some)
}
