//! Flow angles and airspeed are told by their formulas in the velocities of the body.

use super::equations::Equations;
use super::known::Quantities;
use super::sums::{name_of, terms};
use crate::flight::{Dimension, PhysicalQuantity};
use crate::model::expression::{BinaryOperator, Expression, Function, Kind};

pub(super) fn find(equations: &Equations, found: &mut Quantities) {
    use PhysicalQuantity::{
        Airspeed, AngleOfAttack, AngleOfSideslip, VelocityX, VelocityY, VelocityZ,
    };
    let definitions = equations
        .definitions
        .iter()
        .map(|(name, e)| (*name, e, false));
    let outputs = equations.outputs.iter().map(|(name, e)| (*name, e, true));
    for (name, equation, is_output) in definitions.chain(outputs) {
        let mut note = |quantity, reason: &str| {
            let reason = || reason.to_string();
            match is_output {
                true => found.note_output(name, quantity, reason),
                false => found.note(name, quantity, reason),
            }
        };
        if is_length(equations, equation) {
            note(Airspeed, "it is the length of a velocity");
            continue;
        }
        let Some((above, below)) = equations.terms(equation).iter().find_map(|term| {
            let inner = term.factors.iter().find_map(|factor| ratio(factor));
            // w/u, v/V as they stand
            let plain = match (term.factors.as_slice(), term.divisors.as_slice()) {
                ([above], [below]) => Some((*above, *below)),
                _ => None,
            };
            inner.or(plain)
        }) else {
            continue;
        };
        let [above, below] = [above, below].map(|side| velocity(equations, side));
        let Some(above) = above else { continue };
        match found.get(above) {
            Some(VelocityZ) => match is_output {
                true => found.note_output(name, AngleOfAttack, || format!("the angle of {above}")),
                false => found.note(name, AngleOfAttack, || format!("the angle of {above}")),
            },
            Some(VelocityY) => match is_output {
                true => {
                    found.note_output(name, AngleOfSideslip, || format!("the angle of {above}"))
                }
                false => found.note(name, AngleOfSideslip, || format!("the angle of {above}")),
            },
            _ => {}
        }
        let angle = if is_output {
            found.output(name)
        } else {
            found.get(name)
        };
        let is_speed = |below: &&str| found.get(below) == Some(Airspeed);
        match angle {
            Some(AngleOfAttack) => {
                let below = below.filter(|below| !is_speed(below));
                found.note(above, VelocityZ, || format!("{name} is its angle"));
                if let Some(below) = below {
                    found.note(below, VelocityX, || format!("{name} is the angle about it"));
                }
            }
            Some(AngleOfSideslip) => {
                found.note(above, VelocityY, || format!("{name} is its angle"));
            }
            _ => {}
        }
    }
}

/// n and d of atan2(n, d), atan(n/d) and asin(n/d).
fn ratio(expression: &Expression) -> Option<(&Expression, &Expression)> {
    let Kind::Call(function, arguments) = &expression.kind else {
        return None;
    };
    match (function, arguments.as_slice()) {
        (Function::Atan2, [above, below]) => Some((above, below)),
        (Function::Atan | Function::Asin, [inner]) => match &inner.kind {
            Kind::Binary(BinaryOperator::Divide, above, below) => Some((above, below)),
            _ => None,
        },
        _ => None,
    }
}

fn is_speed(equations: &Equations, name: &str) -> bool {
    equations.varies(name) && equations.dimension(name) == Dimension::METRE.over(Dimension::SECOND)
}

/// The velocity that an expression is, but for what a lever arm adds.
fn velocity<'e>(equations: &Equations, expression: &'e Expression) -> Option<&'e str> {
    match &expression.kind {
        Kind::Name(name) => is_speed(equations, name).then_some(name),
        Kind::Binary(BinaryOperator::Add | BinaryOperator::Subtract, left, _) => {
            velocity(equations, left)
        }
        _ => None,
    }
}

/// sqrt(u² + v² + w²), two of them in a motion in one plane.
fn is_length(equations: &Equations, expression: &Expression) -> bool {
    let Kind::Call(Function::Sqrt, arguments) = &expression.kind else {
        return false;
    };
    let square = |factor: &Expression| match &factor.kind {
        Kind::Binary(BinaryOperator::Power, base, exponent) => {
            matches!(exponent.kind, Kind::Number(2.0))
                && name_of(base).is_some_and(|name| is_speed(equations, name))
        }
        _ => false,
    };
    let Some(sum) = arguments.first() else {
        return false;
    };
    let terms = terms(sum);
    terms.len() >= 2
        && terms.iter().all(|term| match term.factors.as_slice() {
            [one] => square(one) && term.divisors.is_empty(),
            [a, b] => name_of(a).is_some_and(|a| name_of(b) == Some(a) && is_speed(equations, a)),
            _ => false,
        })
}
