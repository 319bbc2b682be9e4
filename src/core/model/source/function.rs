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
}

/// The assignments of a program, and what its results are then called.
pub(super) fn assignments(
    program: &Program,
    (inputs, parameters): (usize, &[f64]),
    dialect: &impl Dialect,
) -> (Vec<String>, Vec<String>) {
    let slots = program.slots();
    let mut names: Vec<String> = (0..program.registers()).map(|i| format!("r{i}")).collect();
    for state in 0..slots.states {
        names[slots.state(state) as usize] = format!("x[{state}]");
    }
    for input in 0..slots.inputs {
        // behind the inputs stand the slopes of their paths, which are not in the functions
        names[slots.input(input) as usize] = match input < inputs {
            true => format!("u[{input}]"),
            false => dialect.number(0.0),
        };
    }
    names[slots.time() as usize] = "t".to_string();
    for (parameter, value) in parameters.iter().enumerate() {
        names[slots.parameter(parameter) as usize] = dialect.number(*value);
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
