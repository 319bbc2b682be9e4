//! Rates and attitude angles are told by the kinematics that tie them.

use super::equations::Equations;
use super::identity::carried;
use super::known::Quantities;
use super::sums::{Term, name_of};
use crate::flight::{Dimension, PhysicalQuantity};
use crate::model::expression::{Expression, Function, Kind};

pub(super) fn find(equations: &Equations, found: &mut Quantities) {
    use PhysicalQuantity::{HeadingAngle, PitchAngle, PitchRate, RollAngle, RollRate, YawRate};
    for (state, derivative) in &equations.states {
        if !equations.dimension(state).is_none() {
            continue;
        }
        let said = || format!("by the kinematics of {state}");
        let terms = equations.terms(derivative);
        match terms.as_slice() {
            // θ̇ = q where there is no bank, φ̇ = p where there is no pitch
            [one] if one.divisors.is_empty() && one.factors.len() == 1 => {
                let Some(rate) = rate(equations, one.factors[0]) else {
                    continue;
                };
                for (angle, of) in [
                    (PitchAngle, PitchRate),
                    (RollAngle, RollRate),
                    (HeadingAngle, YawRate),
                ] {
                    if found.get(state) == Some(angle) {
                        found.note(rate, of, said);
                    } else if found.get(rate) == Some(of) {
                        found.note(state, angle, said);
                    }
                }
            }
            // θ̇ = q cos φ - r sin φ
            [one, other] if !one.negative && other.negative => {
                let pitch = turned(equations, one, Function::Cos);
                let yaw = turned(equations, other, Function::Sin);
                if let (Some((pitch, bank)), Some((yaw, same))) = (pitch, yaw)
                    && bank == same
                {
                    found.note(state, PitchAngle, said);
                    found.note(bank, RollAngle, said);
                    found.note(pitch, PitchRate, said);
                    found.note(yaw, YawRate, said);
                }
            }
            // φ̇ = p + tan θ (q sin φ + r cos φ)
            [one, other] if one.factors.len() == 1 && one.divisors.is_empty() => {
                let tangent = other
                    .factors
                    .iter()
                    .find_map(|factor| argument(factor, Function::Tan));
                if let (Some(rate), Some(pitch)) = (rate(equations, one.factors[0]), tangent)
                    && equations.varies(pitch)
                {
                    found.note(state, RollAngle, said);
                    found.note(rate, RollRate, said);
                    found.note(pitch, PitchAngle, said);
                } else if let Some(rate) = rate(equations, one.factors[0])
                    && found.get(state) == Some(RollAngle)
                {
                    found.note(rate, RollRate, said);
                }
            }
            _ => {}
        }
    }
}

/// The only rate of a longitudinal model is that of pitch.
pub(super) fn only_rate(equations: &Equations, found: &mut Quantities) {
    use PhysicalQuantity::{AngleOfAttack, AngleOfSideslip, PitchAngle, PitchRate, RollRate};
    let is_there = |found: &Quantities, quantity| found.all_of(quantity).next().is_some();
    let longitudinal = is_there(found, AngleOfAttack) || is_there(found, PitchAngle);
    if !longitudinal || is_there(found, AngleOfSideslip) || is_there(found, PitchRate) {
        return;
    }
    let document = equations.document;
    let mut rates = (document.states.keys().chain(document.inputs.keys()))
        .filter(|name| found.get(name).is_none() && RollRate.measures(equations.dimension(name)));
    if let (Some(rate), None) = (rates.next(), rates.next()) {
        found.note(rate, PitchRate, || {
            "the only rate beside an angle of attack".to_string()
        });
        super::identity::find(equations, found);
    }
}

/// The rate that an expression is, less its bias.
fn rate<'e>(equations: &Equations, expression: &'e Expression) -> Option<&'e str> {
    let name = carried(equations, expression)?;
    let per_second = Dimension::NONE.over(Dimension::SECOND);
    (equations.dimension(name) == per_second).then_some(name)
}

/// A rate and the angle by whose function it is multiplied.
fn turned<'e>(
    equations: &Equations,
    term: &Term<'e>,
    function: Function,
) -> Option<(&'e str, &'e str)> {
    let [a, b] = term.factors.as_slice() else {
        return None;
    };
    let of = |factor: &'e Expression, other: &'e Expression| {
        Some((rate(equations, factor)?, argument(other, function)?))
    };
    of(a, b).or_else(|| of(b, a))
}

fn argument(expression: &Expression, wanted: Function) -> Option<&str> {
    match &expression.kind {
        Kind::Call(function, arguments) if *function == wanted => {
            arguments.first().and_then(name_of)
        }
        _ => None,
    }
}
