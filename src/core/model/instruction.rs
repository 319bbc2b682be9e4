//! The instructions of a program, and the interpreter that follows them.

use multiversion::multiversion;

use super::operation::Operation;
use super::scalar::{Lanes, Numbers, Scalar};

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
pub(super) struct Instructions(Vec<Instruction>);

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

    /// As [`Self::interpret`], with the widest vectors that the machine has; the numbers do not depend on them.
    #[inline(always)]
    pub(super) fn execute<T: Scalar>(&self, registers: &mut [T]) {
        match T::told_apart(registers) {
            Numbers::Real(registers) => one(self, registers),
            Numbers::SideBySide(registers) => lanes(self, registers),
            Numbers::Other(registers) => self.interpret(registers),
        }
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
