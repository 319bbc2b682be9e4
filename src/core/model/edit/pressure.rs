//! Derivatives that scale with dynamic pressure, in a model of constant speed.

use super::edited::AddedRole;
use super::error::EditError;
use super::sheet::{Sheet, Speed, unknown};
use super::text::laws;
use crate::flight::{Dimension, Unit};
use crate::model::document::{Definition, ModelDocument, Parameter, Per, Start};
use crate::model::expression::{self, BinaryOperator, Expression, Kind, Span};

/// Every aerodynamic derivative p becomes p (1 + k ((V/V_ref)² - 1)).
///
/// A derivative is a free parameter of the whole job that multiplies something in the equation of a state or definition
/// and has a dimension: one without (`1 + Zq/V`, a coefficient's derivative) is kinematic, or multiplied by the dynamic
/// pressure already. Where it multiplies something in an output, it is scaled there too.
pub(super) fn scaled(sheet: &mut Sheet) -> Result<(), EditError> {
    let term = (sheet.edit).needed_term("\"qbar\" is the one that the target \"all\" knows")?;
    if term != "qbar" {
        let message = "\"qbar\" is the one that the target \"all\" knows";
        return Err(sheet.edit.bad_term(message));
    }
    let derivatives = derivatives(&mut sheet.document);
    if derivatives.is_empty() {
        let message = "no free parameter with a dimension multiplies anything in the equations of this model's states";
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
        let start = Start::FromData(format!("mean({}, 5)", speed_channel(&speed)));
        let parameter = Parameter {
            start,
            fixed: true,
            per: Per::Maneuver,
            ..unknown("m/s", 0.0, None, "speed of the steady flight".to_string())
        };
        sheet.add(&name, AddedRole::Reference, parameter);
        name
    });
    let ratio = sheet.free("qbar_ratio");
    let scale = |text: &mut String| {
        let Ok(parsed) = expression::parse(text) else {
            return;
        };
        let mut places = Vec::new();
        factors(&parsed, &mut |name, span| {
            if derivatives.iter().any(|derivative| derivative == name) {
                places.push(span);
            }
        });
        places.sort_by_key(|span| std::cmp::Reverse(span.start));
        for span in places {
            text.insert_str(span.end, &format!("*{ratio})"));
            text.insert(span.start, '(');
        }
    };
    laws(&mut sheet.document).for_each(scale);
    let outputs = sheet.document.outputs.values_mut();
    outputs.for_each(|output| scale(&mut output.equation));
    let definition = Definition {
        unit: "-".to_string(),
        equation: format!("1 + {name}*(({speed}/{reference})^2 - 1)"),
        description: "what the derivatives are multiplied by".to_string(),
    };
    sheet.document.definitions.insert(ratio, definition);
    Ok(())
}

/// A speed that is written out is recorded under its usual name.
fn speed_channel(speed: &str) -> &str {
    if expression::is_name(speed) {
        speed
    } else {
        "V"
    }
}

fn derivatives(document: &mut ModelDocument) -> Vec<String> {
    let mut found = Vec::new();
    for text in laws(document) {
        if let Ok(parsed) = expression::parse(text) {
            factors(&parsed, &mut |name, _| found.push(name.to_string()));
        }
    }
    found.retain(|name| {
        (document.parameters.get(name)).is_some_and(|parameter| {
            !parameter.fixed
                && parameter.per == Per::Job
                && Unit::parse(&parameter.unit).is_ok_and(|unit| unit.dimension != Dimension::NONE)
        })
    });
    found.sort();
    found.dedup();
    found
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
