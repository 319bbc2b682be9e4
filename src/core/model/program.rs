//! A flat program: what a graph becomes for evaluation, many times over, without allocation.
//!
//! Registers hold states, inputs, time, parameters, constants, then results. What depends on parameters
//! alone is the *prelude*, run once for each θ; the *body* runs for each sample.

use super::graph::{Graph, Node, NodeId};
use super::instruction::{Instruction, Instructions};
use super::operation::Binary;
use super::operation::Operation;
use super::scalar::Scalar;

/// Where the symbols of a model stand, in registers as in the graph.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Slots {
    pub states: usize,
    pub inputs: usize,
    pub parameters: usize,
}

impl Slots {
    pub(super) fn state(self, i: usize) -> u32 {
        i as u32
    }
    pub(super) fn input(self, i: usize) -> u32 {
        (self.states + i) as u32
    }
    pub(super) fn time(self) -> u32 {
        (self.states + self.inputs) as u32
    }
    pub(super) fn parameter(self, i: usize) -> u32 {
        (self.states + self.inputs + 1 + i) as u32
    }
    fn count(self) -> usize {
        self.states + self.inputs + 1 + self.parameters
    }
}

/// Compiled equations: f(x, u, t, θ) for some list of results.
#[derive(Clone, Debug)]
pub struct Program {
    slots: Slots,
    registers: usize,
    constants: Vec<(u32, f64)>,
    prelude: Instructions,
    body: Instructions,
    results: Vec<u32>,
    /// By result: does it change from sample to sample, or only with θ?
    varies: Vec<bool>,
}

/// The registers of one evaluation; made once, used for every sample.
#[derive(Clone, Debug)]
pub struct Workspace<T>(Vec<T>);

impl<T> Workspace<T> {
    pub(super) fn registers(&self) -> &[T] {
        &self.0
    }
}

impl Program {
    pub(super) fn compile(graph: &Graph, slots: Slots, roots: &[NodeId]) -> Self {
        let uses = uses(graph, roots);
        let mut program = Self {
            slots,
            registers: slots.count(),
            constants: Vec::new(),
            prelude: Instructions::default(),
            body: Instructions::default(),
            results: Vec::new(),
            varies: Vec::new(),
        };
        let needed = || (0..graph.len()).filter(|&id| uses[id] > 0);
        let mut varies = vec![false; graph.len()];
        for id in needed() {
            varies[id] = match graph.node(id as NodeId) {
                Node::Symbol(slot) => slot < slots.parameter(0),
                node => operands(node).any(|operand| varies[operand as usize]),
            };
        }
        // a product that only one sum uses becomes a part of it
        let product = |id: NodeId| match graph.node(id) {
            Node::Binary(Binary::Multiply, a, b)
                if uses[id as usize] == 1 && varies[id as usize] =>
            {
                Some((a, b))
            }
            _ => None,
        };
        let mut absorbed = vec![false; graph.len()];
        let mut sums = vec![None; graph.len()];
        for id in needed() {
            let (operation, rest, factor) = match graph.node(id as NodeId) {
                Node::Binary(Binary::Add, a, b) if product(b).is_some() => {
                    (Operation::MultiplyAdd, a, b)
                }
                Node::Binary(Binary::Add, a, b) if product(a).is_some() => {
                    (Operation::MultiplyAdd, b, a)
                }
                Node::Binary(Binary::Subtract, a, b) if product(b).is_some() => {
                    (Operation::MultiplySubtract, a, b)
                }
                _ => continue,
            };
            if let Some((a, b)) = product(factor) {
                absorbed[factor as usize] = true;
                sums[id] = Some((operation, a, b, rest));
            }
        }
        let mut register = vec![0_u32; graph.len()];
        for id in needed().filter(|&id| !absorbed[id]) {
            let node = graph.node(id as NodeId);
            if let Node::Symbol(slot) = node {
                register[id] = slot;
                continue;
            }
            let target = program.registers as u32;
            program.registers += 1;
            register[id] = target;
            if let Node::Constant(bits) = node {
                program.constants.push((target, f64::from_bits(bits)));
                continue;
            }
            let at = |operand: NodeId| register[operand as usize];
            let (operation, a, b, c) = match (sums[id], node) {
                (Some((operation, a, b, c)), _) => (operation, at(a), at(b), at(c)),
                (None, Node::Unary(unary, a)) => (unary.into(), at(a), 0, 0),
                (None, Node::Binary(binary, a, b)) => (binary.into(), at(a), at(b), 0),
                (None, Node::Select(a, b, c)) => (Operation::Select, at(a), at(b), at(c)),
                (None, Node::Constant(_) | Node::Symbol(_)) => continue,
            };
            let instruction = Instruction {
                operation,
                target,
                a,
                b,
                c,
            };
            if varies[id] {
                program.body.push(instruction)
            } else {
                program.prelude.push(instruction)
            }
        }
        program.results = roots.iter().map(|&root| register[root as usize]).collect();
        program.varies = roots.iter().map(|&root| varies[root as usize]).collect();
        program
    }

    /// Number of results.
    pub fn len(&self) -> usize {
        self.results.len()
    }

    /// Whether there are no results.
    pub fn is_empty(&self) -> bool {
        self.results.is_empty()
    }

    /// Operations a sample, without those done once for each θ.
    pub fn operations(&self) -> usize {
        self.body.len()
    }

    pub(super) fn slots(&self) -> Slots {
        self.slots
    }

    pub(super) fn prelude(&self) -> &[Instruction] {
        self.prelude.as_slice()
    }

    /// Registers that hold constants, and these.
    pub(super) fn constants(&self) -> &[(u32, f64)] {
        &self.constants
    }

    pub(super) fn body(&self) -> &[Instruction] {
        self.body.as_slice()
    }

    /// How many registers there are.
    pub(super) fn registers(&self) -> usize {
        self.registers
    }

    /// By result: its register.
    pub(super) fn result_registers(&self) -> &[u32] {
        &self.results
    }

    /// Whether result `i` changes from sample to sample; if not, it stands once θ is set.
    pub fn varies(&self, i: usize) -> bool {
        self.varies[i]
    }

    /// Registers with the constants in place; parameters are still to be set.
    pub fn workspace<T: Scalar>(&self) -> Workspace<T> {
        let mut registers = vec![T::from_f64(0.0); self.registers];
        for &(at, value) in &self.constants {
            registers[at as usize] = T::from_f64(value);
        }
        Workspace(registers)
    }

    /// Puts θ in place and does what depends on it alone.
    pub fn set_parameters<T: Scalar>(&self, workspace: &mut Workspace<T>, parameters: &[T]) {
        let first = self.slots.parameter(0) as usize;
        workspace.0[first..first + self.slots.parameters].copy_from_slice(parameters);
        self.prelude.interpret(&mut workspace.0);
    }

    /// Evaluates for the state, inputs and time that stand in the workspace.
    #[inline]
    pub fn run<T: Scalar>(&self, workspace: &mut Workspace<T>) {
        self.body.execute(&mut workspace.0);
    }

    /// Result `i` of the last run.
    #[inline]
    pub fn result<T: Scalar>(&self, workspace: &Workspace<T>, i: usize) -> T {
        workspace.0[self.results[i] as usize]
    }

    /// Copies all results of the last run.
    #[inline]
    pub fn results<T: Scalar>(&self, workspace: &Workspace<T>, to: &mut [T]) {
        for (to, &register) in to.iter_mut().zip(&self.results) {
            *to = workspace.0[register as usize];
        }
    }

    /// The registers of the states.
    #[inline]
    pub fn states<'w, T>(&self, workspace: &'w mut Workspace<T>) -> &'w mut [T] {
        &mut workspace.0[..self.slots.states]
    }

    /// The registers of the inputs.
    #[inline]
    pub fn inputs<'w, T>(&self, workspace: &'w mut Workspace<T>) -> &'w mut [T] {
        &mut workspace.0[self.slots.states..self.slots.states + self.slots.inputs]
    }

    /// The register of the time since the start of the segment.
    #[inline]
    pub fn time<'w, T>(&self, workspace: &'w mut Workspace<T>) -> &'w mut T {
        &mut workspace.0[self.slots.states + self.slots.inputs]
    }
}

/// How often each node is used by those that `roots` need; roots count as used from outside.
fn uses(graph: &Graph, roots: &[NodeId]) -> Vec<u32> {
    let mut uses = vec![0_u32; graph.len()];
    // twice, so that no sum takes a root's product for its own
    roots.iter().for_each(|&root| uses[root as usize] += 2);
    for id in (0..graph.len()).rev() {
        if uses[id] > 0 {
            operands(graph.node(id as NodeId)).for_each(|operand| uses[operand as usize] += 1);
        }
    }
    uses
}

fn operands(node: Node) -> impl Iterator<Item = NodeId> {
    let list = match node {
        Node::Constant(_) | Node::Symbol(_) => [None; 3],
        Node::Unary(_, a) => [Some(a), None, None],
        Node::Binary(_, a, b) => [Some(a), Some(b), None],
        Node::Select(a, b, c) => [Some(a), Some(b), Some(c)],
    };
    list.into_iter().flatten()
}
