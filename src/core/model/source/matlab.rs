//! A model in MATLAB, which Octave and Simulink's MATLAB Function block read as well: one function, its helpers below it.

use super::function::{Dialect, Parameters, assignments, function_name};
use super::written::Written;
use crate::model::operation::Operation;
use crate::model::program::Program;

struct Matlab;

/// Longest name of a function in MATLAB (`namelengthmax`).
const LONGEST: usize = 63;

/// Where C gives no number, MATLAB's functions go to complex ones.
const HELPERS: &str = r"
function c = chosen(condition, a, b)
if condition ~= 0
    c = a;
else
    c = b;
end
end

function c = real_power(a, b)
if a < 0 && b ~= fix(b)
    c = NaN;
else
    c = a ^ b;
end
end

function c = real_sqrt(a)
if a < 0
    c = NaN;
else
    c = sqrt(a);
end
end

function c = real_log(a)
if a < 0
    c = NaN;
else
    c = log(a);
end
end

function c = real_asin(a)
if abs(a) > 1
    c = NaN;
else
    c = asin(a);
end
end

function c = real_acos(a)
if abs(a) > 1
    c = NaN;
else
    c = acos(a);
end
end
";

impl Dialect for Matlab {
    fn number(&self, value: f64) -> String {
        match value {
            value if value.is_nan() => "NaN".to_string(),
            f64::INFINITY => "Inf".to_string(),
            f64::NEG_INFINITY => "(-Inf)".to_string(),
            value if value.is_sign_negative() => format!("({value:?})"),
            value => format!("{value:?}"),
        }
    }

    fn assign(&self, name: &str, value: &str) -> String {
        format!("{name} = {value};")
    }

    fn call(&self, operation: Operation, a: &str) -> String {
        match operation {
            Operation::Sign => format!("sign({a})"),
            Operation::Abs => format!("abs({a})"),
            Operation::Sqrt | Operation::Ln | Operation::Asin | Operation::Acos => {
                format!("real_{}({a})", function_name(operation))
            }
            _ => format!("{}({a})", function_name(operation)),
        }
    }

    fn other(&self, operation: Operation, a: &str, b: &str, c: &str) -> String {
        match operation {
            Operation::Power => format!("real_power({a}, {b})"),
            Operation::Atan2 => format!("atan2({a}, {b})"),
            Operation::Less => format!("double({a} < {b})"),
            Operation::LessOrEqual => format!("double({a} <= {b})"),
            Operation::Select => format!("chosen({a}, {b}, {c})"),
            _ => format!("{a} / {b}"),
        }
    }

    fn element(&self, array: &str, index: usize) -> String {
        format!("{array}({})", index + 1)
    }
}

pub(super) fn file(written: &Written<'_>) -> String {
    let model = written.model;
    let name = function_name_of(&model.document.name);
    let notes: String = (written.notes.iter())
        .map(|note| format!("% {note}\n"))
        .collect();
    let body = |result: &str, program: &Program| {
        let parameters = Parameters::Numbers(written.parameters);
        let (lines, results) = assignments(program, (model.inputs.len(), parameters), &Matlab);
        let lines: String = lines.iter().map(|line| format!("{line}\n")).collect();
        let results = match results.is_empty() {
            true => "zeros(0, 1)".to_string(),
            false => format!("[{}]", results.join("; ")),
        };
        format!("{lines}{result} = {results};\nend\n")
    };
    format!(
        "function [dx, y, x0] = {name}(x, u, t)\n\
         % [dx, y] = {name}(x, u, t): dx/dt and outputs; columns of numbers. Save it as {name}.m.\n\
         % [~, ~, x0] = {name}(): the initial state. Elements are counted from 1, below from 0:\n{notes}\
         x0 = initial_state();\nif nargin < 3\n    dx = zeros({}, 1);\n    y = zeros({}, 1);\n    return\nend\n\
         dx = derivative(x, u, t);\ny = output(x, u, t);\nend\n\n\
         function x0 = initial_state()\n{}\nfunction dx = derivative(x, u, t)\n{}\nfunction y = output(x, u, t)\n{}{HELPERS}",
        model.states.len(),
        model.outputs.len(),
        body("x0", &model.initial),
        body("dx", &model.dynamics),
        body("y", &model.observation),
    )
}

/// What can stand as the name of a function and of its file.
fn function_name_of(name: &str) -> String {
    let fit = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let name: String = name.chars().map(fit).take(LONGEST - 6).collect();
    match name.chars().next() {
        Some(first) if first.is_ascii_alphabetic() => name,
        _ => format!("model_{name}"),
    }
}
