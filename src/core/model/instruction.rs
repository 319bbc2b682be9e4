//! The instructions of a program, and the interpreter that follows them.

use multiversion::multiversion;

use super::graph::{Binary, Unary};
use super::scalar::{Lanes, Scalar};

/// What an instruction does with its operands a, b, c. Flat, so that it is told by one jump.
#[derive(Clone, Copy, Debug)]
pub(super) enum Operation {
    Negate,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Tanh,
    Exp,
    Ln,
    Sqrt,
    Abs,
    Sign,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Atan2,
    Less,
    LessOrEqual,
    Select,
    /// c + a b, rounded once.
    MultiplyAdd,
    /// c - a b, rounded once.
    MultiplySubtract,
}

impl From<Unary> for Operation {
    fn from(unary: Unary) -> Self {
        match unary {
            Unary::Negate => Self::Negate,
            Unary::Sin => Self::Sin,
            Unary::Cos => Self::Cos,
            Unary::Tan => Self::Tan,
            Unary::Asin => Self::Asin,
            Unary::Acos => Self::Acos,
            Unary::Atan => Self::Atan,
            Unary::Tanh => Self::Tanh,
            Unary::Exp => Self::Exp,
            Unary::Ln => Self::Ln,
            Unary::Sqrt => Self::Sqrt,
            Unary::Abs => Self::Abs,
            Unary::Sign => Self::Sign,
        }
    }
}

impl From<Binary> for Operation {
    fn from(binary: Binary) -> Self {
        match binary {
            Binary::Add => Self::Add,
            Binary::Subtract => Self::Subtract,
            Binary::Multiply => Self::Multiply,
            Binary::Divide => Self::Divide,
            Binary::Power => Self::Power,
            Binary::Atan2 => Self::Atan2,
            Binary::Less => Self::Less,
            Binary::LessOrEqual => Self::LessOrEqual,
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Instruction {
    pub operation: Operation,
    pub target: u32,
    pub a: u32,
    pub b: u32,
    pub c: u32,
}

/// Instructions in the order in which they are done.
#[derive(Clone, Debug, Default)]
pub struct Instructions(Vec<Instruction>);

impl Instructions {
    pub(super) fn push(&mut self, instruction: Instruction) {
        self.0.push(instruction);
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    pub(super) fn as_slice(&self) -> &[Instruction] {
        &self.0
    }

    /// For any kind of number.
    #[inline(always)]
    pub(super) fn interpret<T: Scalar>(&self, registers: &mut [T]) {
        for instruction in &self.0 {
            let a = registers[instruction.a as usize];
            let b = registers[instruction.b as usize];
            registers[instruction.target as usize] = match instruction.operation {
                Operation::Add => a + b,
                Operation::Subtract => a - b,
                Operation::Multiply => a * b,
                Operation::MultiplyAdd => a.multiply_add(b, registers[instruction.c as usize]),
                Operation::MultiplySubtract => {
                    (-a).multiply_add(b, registers[instruction.c as usize])
                }
                Operation::Divide => a / b,
                Operation::Power => a.power(b),
                Operation::Atan2 => a.atan2(b),
                Operation::Less => a.less(b),
                Operation::LessOrEqual => a.less_or_equal(b),
                Operation::Select => a.select(b, registers[instruction.c as usize]),
                Operation::Negate => -a,
                Operation::Sin => a.sin(),
                Operation::Cos => a.cos(),
                Operation::Tan => a.tan(),
                Operation::Asin => a.asin(),
                Operation::Acos => a.acos(),
                Operation::Atan => a.atan(),
                Operation::Tanh => a.tanh(),
                Operation::Exp => a.exp(),
                Operation::Ln => a.ln(),
                Operation::Sqrt => a.sqrt(),
                Operation::Abs => a.abs(),
                Operation::Sign => a.sign(),
            };
        }
    }

    pub(super) fn execute_one(&self, registers: &mut [f64]) {
        one(self, registers);
    }

    pub(super) fn execute_lanes(&self, registers: &mut [Lanes]) {
        lanes(self, registers);
    }
}

#[multiversion(targets("x86_64+avx2+fma"))]
fn one(instructions: &Instructions, registers: &mut [f64]) {
    instructions.interpret(registers);
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn lanes(instructions: &Instructions, registers: &mut [Lanes]) {
    instructions.interpret(registers);
}
