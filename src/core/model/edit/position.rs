//! The lever arm of a sensor that is not where the model has it: a vane or an accelerometer.

use super::edited::AddedRole;
use super::error::EditError;
use super::sensors::{Sensor, arm};
use super::sheet::{Sheet, Speed, dimension};
use crate::flight::Dimension;

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
    /// By the name, up to a suffix (`alpha_vane`, `az_cg`), and by the dimension.
    fn of(name: &str, unit: &str) -> Option<Self> {
        let name = name.to_lowercase();
        let word = name.split('_').next().unwrap_or_default();
        let word = word.trim_end_matches(|c: char| c.is_ascii_digit());
        let acceleration = Dimension::METRE.over(Dimension::SECOND.times(Dimension::SECOND));
        let (found, measures) = match word {
            "alpha" | "aoa" | "alfa" | "alpham" | "alphav" => (Self::Alpha, Dimension::NONE),
            "beta" | "aos" | "sideslip" | "betam" | "betav" => (Self::Beta, Dimension::NONE),
            "ax" | "axm" | "axcg" => (Self::Ax, acceleration),
            "ay" | "aym" | "aycg" => (Self::Ay, acceleration),
            "az" | "azm" | "azcg" => (Self::Az, acceleration),
            _ => return None,
        };
        (dimension(unit) == measures).then_some(found)
    }

    /// The contribution of one metre of the arm, as terms: a sign and the rates that are multiplied. `V` divides all.
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
    let Some(quantity) = Quantity::of(target, sensor.unit()) else {
        let message = format!(
            "only a flow angle (alpha, beta) or a specific force (ax, ay, az, in m/s^2) depends on a position by these \
             equations, and '{target}' in '{}' is none by its name and unit",
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
    let per_second = Dimension::NONE.over(Dimension::SECOND);
    let Some(rate) = name.strip_suffix("dot") else {
        let candidates = [format!("{name}_true"), name.to_string()];
        let candidates: Vec<&str> = candidates.iter().map(String::as_str).collect();
        return Ok(sheet.quantity(&candidates, per_second));
    };
    let acceleration = per_second.over(Dimension::SECOND);
    if let Some(found) = sheet.quantity(&[name], acceleration) {
        return Ok(Some(found));
    }
    if let Some(state) = sheet.document.states.get(rate) {
        return Ok(Some(format!("({})", state.derivative)));
    }
    if sheet.document.inputs.contains_key(rate) {
        return sheet
            .channel(name, "rad/s^2", &format!("derivative of {rate}"))
            .map(Some);
    }
    Ok(None)
}
