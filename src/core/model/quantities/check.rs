//! A declared quantity must be measured in its unit.

use crate::flight::{Fault, PhysicalQuantity, Unit, escape};
use crate::model::document::ModelDocument;

pub(in crate::model) fn check(document: &ModelDocument, faults: &mut Vec<Fault>) {
    let mut of = |section: &str, name: &str, unit: &str, quantity: Option<PhysicalQuantity>| {
        // a unit that cannot be read is told elsewhere
        let (Some(quantity), Ok(parsed)) = (quantity, Unit::parse(unit)) else {
            return;
        };
        if !quantity.measures(parsed.dimension) {
            let pointer = format!("/{section}/{}/quantity", escape(name));
            let unit = if unit.is_empty() { "-" } else { unit };
            let message = format!(
                "no {} is measured in '{unit}'; correct the unit or the quantity, or leave the quantity out",
                quantity.name()
            );
            faults.push(Fault::new(pointer, "quantity_mismatch", message));
        }
    };
    for (name, x) in &document.constants {
        of("constants", name, &x.unit, x.quantity);
    }
    for (name, x) in &document.inputs {
        of("inputs", name, &x.unit, x.quantity);
    }
    for (name, x) in &document.parameters {
        of("parameters", name, &x.unit, x.quantity);
    }
    for (name, x) in &document.definitions {
        of("definitions", name, &x.unit, x.quantity);
    }
    for (name, x) in &document.states {
        of("states", name, &x.unit, x.quantity);
    }
    for (name, x) in &document.outputs {
        of("outputs", name, &x.unit, x.quantity);
    }
}
