//! Velocities in body axes are told by the gravity in their derivatives, elastic states by their stiffness.

use super::equations::Equations;
use super::known::Quantities;
use super::sums::{Term, name_of};
use crate::flight::PhysicalQuantity;
use crate::model::expression::{BinaryOperator, Expression, Function, Kind};

pub(super) fn find(equations: &Equations, found: &mut Quantities) {
    for (name, derivative) in &equations.states {
        elastic(equations, name, derivative, found);
        if !PhysicalQuantity::VelocityX.measures(equations.dimension(name)) {
            continue;
        }
        let terms = equations.terms(derivative);
        let Some((quantity, force)) = terms.iter().find_map(gravity) else {
            continue;
        };
        // dV/dt along the path holds the sine of a difference; the axes of the body turn, and so have products
        let turns = |term: &Term| term.names().filter(|name| equations.varies(name)).count() >= 2;
        if terms.iter().filter(|term| turns(term)).count() < 2 {
            continue;
        }
        found.note(name, quantity, || {
            "by the gravity in its derivative".to_string()
        });
        for term in &terms {
            if let ([factor], []) = (term.factors.as_slice(), term.divisors.as_slice())
                && let Some(input) = name_of(factor)
                && equations.document.inputs.contains_key(input)
            {
                found.note(input, force, || {
                    format!("the derivative of {name} holds it as it is")
                });
            }
        }
    }
}

/// -g sin θ is along x, g cos θ sin φ along y, g cos θ cos φ along z: the velocity, and the specific force beside it.
fn gravity(term: &Term) -> Option<(PhysicalQuantity, PhysicalQuantity)> {
    use PhysicalQuantity::{
        AccelerationX, AccelerationY, AccelerationZ, VelocityX, VelocityY, VelocityZ,
    };
    let calls = |wanted: Function| {
        let is = |factor: &&&Expression| match &factor.kind {
            Kind::Call(function, arguments) => {
                *function == wanted && arguments.iter().all(|a| name_of(a).is_some())
            }
            _ => false,
        };
        term.factors.iter().filter(is).count()
    };
    let has_name = term.names().next().is_some()
        || term
            .factors
            .iter()
            .any(|f| matches!(f.kind, Kind::Number(_)));
    match (has_name, calls(Function::Sin), calls(Function::Cos)) {
        (true, 1, 0) => Some((VelocityX, AccelerationX)),
        (true, 1, 1) => Some((VelocityY, AccelerationY)),
        (true, 0, 2) => Some((VelocityZ, AccelerationZ)),
        _ => None,
    }
}

/// ẋ = r, ṙ = ω² (... - x) ...: an elastic coordinate and its rate.
fn elastic(equations: &Equations, name: &str, derivative: &Expression, found: &mut Quantities) {
    let Some(rate) = name_of(derivative) else {
        return;
    };
    let Some(acceleration) = equations.states.get(rate) else {
        return;
    };
    let squared = |factor: &&Expression| match &factor.kind {
        Kind::Binary(BinaryOperator::Power, base, _) => {
            name_of(base).is_some_and(|base| !equations.varies(base))
        }
        _ => false,
    };
    let stiff = |term: &Term| {
        let reads = |factor: &&Expression| factor.names().iter().any(|(read, _)| *read == name);
        term.factors.iter().any(squared) && term.factors.iter().any(reads)
    };
    if equations.terms(acceleration).iter().any(stiff) {
        for name in [name, rate] {
            found.note_elastic(name);
        }
    }
}
