//! Controls are told by the derivatives that multiply them.

use super::equations::{Equations, dimension};
use super::known::Quantities;
use super::sums::{Term, names_of, terms};
use crate::flight::PhysicalQuantity;

/// An input without a dimension that a parameter multiplies in the equation of a state or a definition is a control,
/// whatever its name.
pub(super) fn find(equations: &Equations, found: &mut Quantities) {
    let document = equations.document;
    let laws = equations
        .states
        .values()
        .chain(equations.definitions.values());
    let outputs = equations.outputs.values();
    for equation in laws.chain(outputs) {
        for term in terms(equation) {
            for name in multiplied(equations, &term) {
                let input = document.inputs.get(name);
                if input.is_some_and(|input| dimension(&input.unit).is_none()) {
                    found.note(name, PhysicalQuantity::Control, || {
                        "an input that a derivative multiplies".to_string()
                    });
                }
            }
        }
    }
}

/// What varies in a product with a parameter.
fn multiplied<'e>(equations: &Equations, term: &Term<'e>) -> Vec<&'e str> {
    let is_parameter = |name: &str| equations.document.parameters.contains_key(name);
    if !term.names().any(is_parameter) {
        return Vec::new();
    }
    (term.factors.iter().flat_map(|factor| names_of(factor)))
        .filter(|name| equations.varies(name))
        .collect()
}
