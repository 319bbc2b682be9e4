//! What is another quantity but for a bias and a scale factor is what that is.

use super::equations::{Equations, dimension};
use super::known::Quantities;
use super::sums::name_of;
use crate::flight::PhysicalQuantity;
use crate::model::expression::{BinaryOperator, Expression, Kind};

/// The one name that varies in an expression of the form a*(x + b) + c.
pub(super) fn carried<'e>(equations: &Equations, expression: &'e Expression) -> Option<&'e str> {
    let held = |part: &Expression| {
        let names = part.names();
        !names
            .iter()
            .any(|(name, _)| equations.varies(name) || *name == "t")
    };
    if let Some(name) = name_of(expression) {
        return equations.varies(name).then_some(name);
    }
    match &expression.kind {
        Kind::Negate(inner) => carried(equations, inner),
        Kind::Binary(operator, left, right) => match operator {
            BinaryOperator::Add | BinaryOperator::Subtract | BinaryOperator::Multiply => {
                match (held(left), held(right)) {
                    (true, false) => carried(equations, right),
                    (false, true) => carried(equations, left),
                    _ => None,
                }
            }
            BinaryOperator::Divide if held(right) => carried(equations, left),
            _ => None,
        },
        _ => None,
    }
}

pub(super) fn find(equations: &Equations, found: &mut Quantities) {
    for (name, equation) in &equations.definitions {
        let Some(carried) = carried(equations, equation) else {
            continue;
        };
        let measured = [equations.dimension(name), equations.dimension(carried)];
        let fits = |quantity: &PhysicalQuantity| measured.iter().all(|d| quantity.measures(*d));
        if let Some(quantity) = found.get(carried).filter(fits) {
            found.note(name, quantity, || {
                format!("it is {carried}, but for a bias or a scale")
            });
        } else if let Some(quantity) = found.get(name).filter(fits) {
            found.note(carried, quantity, || format!("{name} is made of it alone"));
        }
    }
    for (name, equation) in &equations.outputs {
        let Some(carried) = carried(equations, equation) else {
            continue;
        };
        let output = equations.document.outputs.get(*name);
        let unit = output.map_or("", |output| output.unit.as_str());
        let measured = [dimension(unit), equations.dimension(carried)];
        let fits = |quantity: &PhysicalQuantity| measured.iter().all(|d| quantity.measures(*d));
        if let Some(quantity) = found.get(carried).filter(fits) {
            found.note_output(name, quantity, || format!("it measures {carried}"));
        } else if let Some(quantity) = found.output(name).filter(fits) {
            found.note(carried, quantity, || {
                format!("the output {name} measures it")
            });
        }
    }
}
