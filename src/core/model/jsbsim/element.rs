//! Expressions as JSBSim's functions.

use super::no_aerodynamics::NoAerodynamics;
use crate::model::expression::{BinaryOperator, Expression, Function, Kind};

/// An element with elements in it, or with text.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Element {
    Value(f64),
    Property(String),
    Of(&'static str, Vec<Element>),
}

impl Element {
    /// The element as lines of XML.
    pub(super) fn xml(&self, indent: usize) -> String {
        let blanks = "  ".repeat(indent);
        match self {
            Self::Value(value) => format!("{blanks}<value> {value:?} </value>\n"),
            Self::Property(name) => format!("{blanks}<property> {name} </property>\n"),
            Self::Of(name, inside) => {
                let inside: String = inside.iter().map(|one| one.xml(indent + 1)).collect();
                format!("{blanks}<{name}>\n{inside}{blanks}</{name}>\n")
            }
        }
    }
}

/// The tree as elements; `name` says what a name is.
pub(super) fn element(
    tree: &Expression,
    name: &mut dyn FnMut(&str) -> Result<Element, NoAerodynamics>,
) -> Result<Element, NoAerodynamics> {
    match &tree.kind {
        Kind::Number(value) => Ok(Element::Value(*value)),
        Kind::Name(text) => name(text),
        Kind::Negate(inner) => {
            let inner = element(inner, name)?;
            Ok(Element::Of("product", vec![Element::Value(-1.0), inner]))
        }
        Kind::Binary(operator, left, right) => {
            let (left, right) = (element(left, name)?, element(right, name)?);
            Ok(binary(*operator, left, right))
        }
        Kind::Call(function, arguments) => {
            let arguments = arguments.iter().map(|one| element(one, name));
            Ok(call(*function, arguments.collect::<Result<_, _>>()?))
        }
    }
}

fn binary(operator: BinaryOperator, left: Element, right: Element) -> Element {
    use BinaryOperator::*;
    let of = match operator {
        Add => "sum",
        Subtract => "difference",
        Multiply => "product",
        Divide => "quotient",
        Power => "pow",
        Less => "lt",
        LessOrEqual => "le",
        Greater => "gt",
        GreaterOrEqual => "ge",
    };
    match left {
        // sums and products take any number of elements
        Element::Of(name, mut inside) if name == of && matches!(operator, Add | Multiply) => {
            inside.push(right);
            Element::Of(of, inside)
        }
        left => Element::Of(of, vec![left, right]),
    }
}

fn call(function: Function, arguments: Vec<Element>) -> Element {
    use Element::{Of, Value};
    let first = || arguments.first().cloned().unwrap_or(Value(0.0));
    match function {
        Function::If => Of("ifthen", arguments),
        // 1 - 2/(exp(2 a) + 1)
        Function::Tanh => {
            let grown = Of("exp", vec![Of("product", vec![Value(2.0), first()])]);
            let share = vec![Value(2.0), Of("sum", vec![grown, Value(1.0)])];
            Of("difference", vec![Value(1.0), Of("quotient", share)])
        }
        Function::Sign => {
            let is = |what| Of(what, vec![first(), Value(0.0)]);
            let below = Of("ifthen", vec![is("lt"), Value(-1.0), Value(0.0)]);
            Of("ifthen", vec![is("gt"), Value(1.0), below])
        }
        other => Of(other.name(), arguments),
    }
}
