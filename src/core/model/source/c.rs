//! A model in C99.

use super::function::{Dialect, assignments};
use super::written::Written;
use crate::model::operation::Operation;
use crate::model::program::Program;

struct C;

impl Dialect for C {
    fn number(&self, value: f64) -> String {
        match value {
            value if value.is_nan() => "NAN".to_string(),
            f64::INFINITY => "INFINITY".to_string(),
            f64::NEG_INFINITY => "(-INFINITY)".to_string(),
            value if value.is_sign_negative() => format!("({value:?})"),
            value => format!("{value:?}"),
        }
    }

    fn assign(&self, name: &str, value: &str) -> String {
        format!("    const double {name} = {value};")
    }

    fn call(&self, operation: Operation, a: &str) -> String {
        let function = match operation {
            Operation::Sign => return format!("(double)(({a} > 0.0) - ({a} < 0.0))"),
            Operation::Sin => "sin",
            Operation::Cos => "cos",
            Operation::Tan => "tan",
            Operation::Asin => "asin",
            Operation::Acos => "acos",
            Operation::Atan => "atan",
            Operation::Tanh => "tanh",
            Operation::Exp => "exp",
            Operation::Ln => "log",
            Operation::Sqrt => "sqrt",
            _ => "fabs",
        };
        format!("{function}({a})")
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

pub(super) fn file(written: &Written<'_>) -> String {
    let model = written.model;
    let notes: String = written
        .notes
        .iter()
        .map(|note| format!(" * {note}\n"))
        .collect();
    let function = |name: &str, result: &str, program: &Program| {
        let (lines, results) = assignments(program, (model.inputs.len(), written.parameters), &C);
        let lines: String = lines.iter().map(|line| format!("{line}\n")).collect();
        let results: String = (results.iter().enumerate())
            .map(|(at, value)| format!("    {result}[{at}] = {value};\n"))
            .collect();
        format!(
            "void model_{name}(const double *x, const double *u, double t, double *{result}) {{\n    (void)x; (void)u; (void)t;\n{lines}{results}}}\n"
        )
    };
    format!(
        "/*\n{notes} */\n#include <math.h>\n\nenum {{ MODEL_STATES = {}, MODEL_INPUTS = {}, MODEL_OUTPUTS = {} }};\n\n/* x0; x and u are not read */\n{}\n/* dx/dt */\n{}\n/* y */\n{}",
        model.states.len(),
        model.inputs.len(),
        model.outputs.len(),
        function("initial", "x0", &model.initial),
        function("derivative", "dx", &model.dynamics),
        function("output", "y", &model.observation),
    )
}
