//! A model in C99.

use super::function::{Dialect, Parameters, assignments, function_name};
use super::written::Written;
use crate::model::Model;
use crate::model::operation::Operation;
use crate::model::program::Program;

struct C;

impl Dialect for C {
    fn number(&self, value: f64) -> String {
        number(value)
    }

    fn assign(&self, name: &str, value: &str) -> String {
        format!("    const double {name} = {value};")
    }

    fn call(&self, operation: Operation, a: &str) -> String {
        match operation {
            Operation::Sign => format!("(double)(({a} > 0.0) - ({a} < 0.0))"),
            _ => format!("{}({a})", function_name(operation)),
        }
    }

    fn other(&self, operation: Operation, a: &str, b: &str, c: &str) -> String {
        match operation {
            Operation::Power => format!("pow({a}, {b})"),
            Operation::Atan2 => format!("atan2({a}, {b})"),
            Operation::Less => format!("(double)({a} < {b})"),
            Operation::LessOrEqual => format!("(double)({a} <= {b})"),
            Operation::Select => format!("{a} != 0.0 ? {b} : {c}"),
            _ => format!("{a} / {b}"),
        }
    }
}

/// A number as an expression.
pub(in crate::model) fn number(value: f64) -> String {
    match value {
        value if value.is_nan() => "NAN".to_string(),
        f64::INFINITY => "INFINITY".to_string(),
        f64::NEG_INFINITY => "(-INFINITY)".to_string(),
        value if value.is_sign_negative() => format!("({value:?})"),
        value => format!("{value:?}"),
    }
}

pub(super) fn file(written: &Written<'_>) -> String {
    let model = written.model;
    let notes: String = written
        .notes
        .iter()
        .map(|note| format!(" * {note}\n"))
        .collect();
    format!(
        "/*\n{notes} */\n#include <math.h>\n\nenum {{ MODEL_STATES = {}, MODEL_INPUTS = {}, MODEL_OUTPUTS = {} }};\n\n{}",
        model.states.len(),
        model.inputs.len(),
        model.outputs.len(),
        functions(model, Parameters::Numbers(written.parameters)),
    )
}

/// The three functions of a model.
pub(in crate::model) fn functions(model: &Model, parameters: Parameters<'_>) -> String {
    format!(
        "/* x0; x and u are not read */\n{}\n/* dx/dt */\n{}\n/* y */\n{}",
        function(("initial", "x0"), &model.initial, model, parameters),
        function(("derivative", "dx"), &model.dynamics, model, parameters),
        function(("output", "y"), &model.observation, model, parameters),
    )
}

fn function(
    (name, result): (&str, &str),
    program: &Program,
    model: &Model,
    parameters: Parameters<'_>,
) -> String {
    let (argument, unread) = match parameters {
        Parameters::Numbers(_) => ("", ""),
        Parameters::Array(_) => ("const double *p, ", "(void)p; "),
    };
    let (lines, results) = assignments(program, (model.inputs.len(), parameters), &C);
    let lines: String = lines.iter().map(|line| format!("{line}\n")).collect();
    let results: String = (results.iter().enumerate())
        .map(|(at, value)| format!("    {result}[{at}] = {value};\n"))
        .collect();
    format!(
        "void model_{name}({argument}const double *x, const double *u, double t, double *{result}) {{\n    {unread}(void)x; (void)u; (void)t; (void){result};\n{lines}{results}}}\n"
    )
}
