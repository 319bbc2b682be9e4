//! A model in Python 3, with the standard library alone.

use super::function::{Dialect, Parameters, assignments, function_name};
use super::written::Written;
use crate::model::operation::Operation;
use crate::model::program::Program;

struct Python;

/// Python's functions raise where those of C give an infinity or no number.
const HELPERS: &str = r#"import math


def _of(function, *operands):
    try:
        return function(*operands)
    except ValueError:
        return math.nan


def _divide(a, b):
    if b != 0.0:
        return a / b
    return math.nan if a == 0.0 or a != a else math.copysign(math.inf, a) * math.copysign(1.0, b)


def _ln(a):
    return -math.inf if a == 0.0 else _of(math.log, a)


def _exp(a):
    try:
        return math.exp(a)
    except OverflowError:
        return math.inf


def _power(a, b):
    try:
        return math.pow(a, b)
    except ValueError:
        if a != 0.0:
            return math.nan
    except OverflowError:
        pass
    is_odd = abs(math.fmod(b, 2.0)) == 1.0
    return math.copysign(math.inf, a) if is_odd else math.inf
"#;

impl Dialect for Python {
    fn number(&self, value: f64) -> String {
        match value {
            value if value.is_nan() => "math.nan".to_string(),
            f64::INFINITY => "math.inf".to_string(),
            f64::NEG_INFINITY => "(-math.inf)".to_string(),
            value if value.is_sign_negative() => format!("({value:?})"),
            value => format!("{value:?}"),
        }
    }

    fn assign(&self, name: &str, value: &str) -> String {
        format!("    {name} = {value}")
    }

    fn call(&self, operation: Operation, a: &str) -> String {
        match operation {
            Operation::Sign => format!("float(({a} > 0.0) - ({a} < 0.0))"),
            Operation::Ln => format!("_ln({a})"),
            Operation::Exp => format!("_exp({a})"),
            _ => format!("_of(math.{}, {a})", function_name(operation)),
        }
    }

    fn other(&self, operation: Operation, a: &str, b: &str, c: &str) -> String {
        match operation {
            Operation::Power => format!("_power({a}, {b})"),
            Operation::Atan2 => format!("math.atan2({a}, {b})"),
            Operation::Less => format!("float({a} < {b})"),
            Operation::LessOrEqual => format!("float({a} <= {b})"),
            Operation::Select => format!("{b} if {a} != 0.0 else {c}"),
            _ => format!("_divide({a}, {b})"),
        }
    }
}

pub(super) fn file(written: &Written<'_>) -> String {
    let model = written.model;
    let notes: String = written
        .notes
        .iter()
        .map(|note| format!("# {note}\n"))
        .collect();
    let names = |all: &[crate::model::Quantity]| {
        let names: Vec<String> = all.iter().map(|of| format!("\"{}\"", of.name)).collect();
        format!("[{}]", names.join(", "))
    };
    let function = |head: &str, what: &str, program: &Program| {
        let parameters = Parameters::Numbers(written.parameters);
        let (lines, results) = assignments(program, (model.inputs.len(), parameters), &Python);
        let lines: String = lines.iter().map(|line| format!("{line}\n")).collect();
        format!(
            "def {head}:\n    \"\"\"{what}\"\"\"\n{lines}    return [{}]\n",
            results.join(", ")
        )
    };
    format!(
        "{notes}{HELPERS}\n\nSTATES = {}\nINPUTS = {}\nOUTPUTS = {}\n\n\n{}\n\n{}\n\n{}",
        names(&model.states),
        names(&model.inputs),
        names(&model.outputs),
        function("initial()", "x0", &model.initial),
        function("derivative(x, u, t)", "dx/dt", &model.dynamics),
        function("output(x, u, t)", "y", &model.observation),
    )
}
