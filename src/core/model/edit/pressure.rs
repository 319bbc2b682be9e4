//! Derivatives that scale with dynamic pressure, in a model of constant speed.
//!
//! A derivative is made of the density, a power of the speed, and lengths and masses: no time but that of the speed. The
//! exponent of the second in its unit is therefore that power: Mα (1/s²) grows with V², the damping Mq (1/s) with V.

use std::collections::BTreeMap;

use super::edited::AddedRole;
use super::error::EditError;
use super::lookup::Speed;
use super::sheet::{Sheet, unknown};
use super::text::laws;
use crate::flight::{PhysicalQuantity, Unit};
use crate::model::document::{Definition, ModelDocument, Parameter, Per, Start};
use crate::model::expression::{self, BinaryOperator, Expression, Kind, Span};

/// Every aerodynamic derivative p becomes p (1 + k ((V/V_ref)ⁿ - 1)), n by its unit.
///
/// A derivative is a free parameter of the whole job that multiplies something in the equation of a state or definition
/// and whose unit holds the second: one without (`1 + Zq/V`, a coefficient's derivative) is kinematic, or multiplied by the
/// dynamic pressure already. Where it multiplies something in an output, it is scaled there too.
pub(super) fn scaled(sheet: &mut Sheet) -> Result<(), EditError> {
    let term = (sheet.edit).needed_term("\"qbar\" is the one that the target \"all\" knows")?;
    if term != "qbar" {
        let message = "\"qbar\" is the one that the target \"all\" knows";
        return Err(sheet.edit.bad_term(message));
    }
    let derivatives = derivatives(&mut sheet.document);
    if derivatives.is_empty() {
        let message = "no free parameter that grows with the speed multiplies anything in the equations of this model's states";
        return Err(sheet.unfit(message));
    }
    let reference = sheet.steady_speed();
    let speed = sheet.speed(Speed::Varying)?;
    let name = sheet.name("qbar_share")?;
    let words = "share of the derivatives that follows the dynamic pressure".to_string();
    sheet.add(
        &name,
        AddedRole::Size,
        unknown("-", 0.0, Some((-2.0, 3.0)), words),
    );
    let reference = reference.unwrap_or_else(|| {
        let name = sheet.free("V_ref");
        let start = Start::FromData(format!("mean({}, 5)", speed_channel(sheet, &speed)));
        let parameter = Parameter {
            start,
            fixed: true,
            per: Per::Maneuver,
            ..unknown("m/s", 0.0, None, "speed of the steady flight".to_string())
        };
        sheet.add(&name, AddedRole::Reference, parameter);
        name
    });
    let mut ratios: BTreeMap<i32, String> = BTreeMap::new();
    for power in derivatives.values() {
        if !ratios.contains_key(power) {
            let base = if *power == 2 {
                "qbar_ratio".to_string()
            } else {
                format!("speed_ratio_{power}")
            };
            let ratio = sheet.free(&base);
            let definition = Definition {
                unit: "-".to_string(),
                equation: format!("1 + {name}*(({speed}/{reference})^{power} - 1)"),
                quantity: Some(PhysicalQuantity::Other),
                description: format!(
                    "what derivatives that grow with the speed to the power {power} are multiplied by"
                ),
            };
            sheet.document.definitions.insert(ratio.clone(), definition);
            ratios.insert(*power, ratio);
        }
    }
    let scale = |text: &mut String| {
        let Ok(parsed) = expression::parse(text) else {
            return;
        };
        let mut places = Vec::new();
        factors(&parsed, &mut |name, span| {
            if let Some(power) = derivatives.get(name) {
                places.push((span, &ratios[power]));
            }
        });
        places.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
        for (span, ratio) in places {
            text.insert_str(span.end, &format!("*{ratio})"));
            text.insert(span.start, '(');
        }
    };
    laws(&mut sheet.document).for_each(scale);
    let outputs = sheet.document.outputs.values_mut();
    outputs.for_each(|output| scale(&mut output.equation));
    Ok(())
}

/// The channel that a speed is recorded in.
fn speed_channel(sheet: &Sheet, speed: &str) -> String {
    let quantities = sheet.quantities();
    let output = quantities.outputs_of(PhysicalQuantity::Airspeed).next();
    output.unwrap_or(speed).to_string()
}

/// Derivatives by name, with the power of the speed that they grow with.
fn derivatives(document: &mut ModelDocument) -> BTreeMap<String, i32> {
    let mut names = Vec::new();
    for text in laws(document) {
        if let Ok(parsed) = expression::parse(text) {
            factors(&parsed, &mut |name, _| names.push(name.to_string()));
        }
    }
    let power = |name: String| {
        let parameter = document.parameters.get(&name)?;
        let unit = Unit::parse(&parameter.unit).ok()?;
        let power = -unit.dimension.seconds()?;
        let grows = !parameter.fixed && parameter.per == Per::Job && power > 0;
        grows.then_some((name, power))
    };
    names.into_iter().filter_map(power).collect()
}

/// Calls back for each name that is a factor of a product, and for its place.
fn factors(expression: &Expression, found: &mut impl FnMut(&str, Span)) {
    match &expression.kind {
        Kind::Number(_) | Kind::Name(_) => {}
        Kind::Negate(inner) => factors(inner, found),
        Kind::Binary(operator, left, right) => {
            if *operator == BinaryOperator::Multiply {
                for side in [left, right] {
                    if let Kind::Name(name) = &side.kind {
                        found(name, side.span);
                    }
                }
            }
            factors(left, found);
            factors(right, found);
        }
        Kind::Call(_, arguments) => arguments.iter().for_each(|a| factors(a, found)),
    }
}
