//! A program as assignments, one after the other.

use crate::model::instruction::Instruction;
use crate::model::operation::Operation;
use crate::model::program::Program;

/// How a language writes numbers and operations.
pub(super) trait Dialect {
    /// A number that stands for itself.
    fn number(&self, value: f64) -> String;
    /// An assignment to a new name.
    fn assign(&self, name: &str, value: &str) -> String;
    /// A function of one operand.
    fn call(&self, operation: Operation, a: &str) -> String;
    /// An operation that is not written as a function of one operand or with a sign.
    fn other(&self, operation: Operation, a: &str, b: &str, c: &str) -> String;
    /// An element of an array, counted from 0.
    fn element(&self, array: &str, index: usize) -> String {
        format!("{array}[{index}]")
    }
}

/// How parameters stand in functions.
#[derive(Clone, Copy)]
pub(in crate::model) enum Parameters<'p> {
    /// As these numbers, SI.
    Numbers(&'p [f64]),
    /// As so many elements of an array `p`.
    Array(usize),
}

/// The name of a function of one operand, as C's `math.h` and Python's `math` have it.
pub(super) fn function_name(operation: Operation) -> &'static str {
    match operation {
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
    }
}

/// The assignments of a program, and what its results are then called.
pub(super) fn assignments(
    program: &Program,
    (inputs, parameters): (usize, Parameters<'_>),
    dialect: &impl Dialect,
) -> (Vec<String>, Vec<String>) {
    let slots = program.slots();
    let mut names: Vec<String> = (0..program.registers()).map(|i| format!("r{i}")).collect();
    for state in 0..slots.states {
        names[slots.state(state) as usize] = dialect.element("x", state);
    }
    for input in 0..slots.inputs {
        // behind the inputs stand the slopes of their paths, which are not in the functions
        names[slots.input(input) as usize] = match input < inputs {
            true => dialect.element("u", input),
            false => dialect.number(0.0),
        };
    }
    names[slots.time() as usize] = "t".to_string();
    let count = match parameters {
        Parameters::Numbers(values) => values.len(),
        Parameters::Array(count) => count,
    };
    for parameter in 0..count {
        names[slots.parameter(parameter) as usize] = match parameters {
            Parameters::Numbers(values) => dialect.number(values[parameter]),
            Parameters::Array(_) => dialect.element("p", parameter),
        };
    }
    for &(at, value) in program.constants() {
        names[at as usize] = dialect.number(value);
    }
    let lines = (program.prelude().iter().chain(program.body()))
        .map(|instruction| line(instruction, &names, dialect))
        .collect();
    let results = program.result_registers().iter();
    (
        lines,
        results
            .map(|&register| names[register as usize].clone())
            .collect(),
    )
}

fn line(instruction: &Instruction, names: &[String], dialect: &impl Dialect) -> String {
    let of = |register: u32| names[register as usize].as_str();
    let (a, b, c) = (of(instruction.a), of(instruction.b), of(instruction.c));
    let value = match instruction.operation {
        Operation::Negate => format!("-{a}"),
        Operation::Add => format!("{a} + {b}"),
        Operation::Subtract => format!("{a} - {b}"),
        Operation::Multiply => format!("{a} * {b}"),
        Operation::MultiplyAdd => format!("{c} + {a} * {b}"),
        Operation::MultiplySubtract => format!("{c} - {a} * {b}"),
        Operation::Sin
        | Operation::Cos
        | Operation::Tan
        | Operation::Asin
        | Operation::Acos
        | Operation::Atan
        | Operation::Tanh
        | Operation::Exp
        | Operation::Ln
        | Operation::Sqrt
        | Operation::Abs
        | Operation::Sign => dialect.call(instruction.operation, a),
        Operation::Divide
        | Operation::Power
        | Operation::Atan2
        | Operation::Less
        | Operation::LessOrEqual
        | Operation::Select => dialect.other(instruction.operation, a, b, c),
    };
    dialect.assign(of(instruction.target), &value)
}
