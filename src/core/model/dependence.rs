//! Which symbols the results of a program depend on, read off its instructions.

use super::instruction::Instruction;
use super::program::Program;

/// A symbol of a model's equations, by its place among those of its kind.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Symbol {
    State(usize),
    Input(usize),
    Time,
    Parameter(usize),
}

impl Program {
    /// By result: whether one of the symbols that `is_meant` picks goes into it. What cancels in numbers alone counts.
    pub(crate) fn depends_on(&self, is_meant: impl Fn(Symbol) -> bool) -> Vec<bool> {
        let slots = self.slots();
        let mut depends = vec![false; self.registers()];
        (0..slots.states)
            .for_each(|i| depends[slots.state(i) as usize] = is_meant(Symbol::State(i)));
        (0..slots.inputs)
            .for_each(|i| depends[slots.input(i) as usize] = is_meant(Symbol::Input(i)));
        depends[slots.time() as usize] = is_meant(Symbol::Time);
        (0..slots.parameters)
            .for_each(|i| depends[slots.parameter(i) as usize] = is_meant(Symbol::Parameter(i)));
        for instruction in self.prelude().iter().chain(self.body()) {
            let Instruction { a, b, c, .. } = *instruction;
            let count = instruction.operation.operands();
            let any = [a, b, c][..count].iter().any(|&at| depends[at as usize]);
            depends[instruction.target as usize] = any;
        }
        let results = self.result_registers().iter();
        results.map(|&at| depends[at as usize]).collect()
    }
}
