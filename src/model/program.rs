//! A flat program: what a graph becomes for evaluation, many times over, without allocation.
//!
//! Registers hold states, inputs, time, parameters, constants, then results. What depends on parameters
//! alone is the *prelude*, run once for each θ; the *body* runs for each sample.

use super::graph::{Binary, Graph, Node, NodeId, Unary};
use super::scalar::{Lanes, Scalar};

/// Where the symbols of a model stand, in registers as in the graph.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Slots {
    pub states: usize,
    pub inputs: usize,
    pub parameters: usize,
}

impl Slots {
    pub fn state(self, i: usize) -> u32 {
        i as u32
    }
    pub fn input(self, i: usize) -> u32 {
        (self.states + i) as u32
    }
    pub fn time(self) -> u32 {
        (self.states + self.inputs) as u32
    }
    pub fn parameter(self, i: usize) -> u32 {
        (self.states + self.inputs + 1 + i) as u32
    }
    fn count(self) -> usize {
        self.states + self.inputs + 1 + self.parameters
    }
}

#[derive(Clone, Copy, Debug)]
enum Operation {
    Unary(Unary),
    Binary(Binary),
    Select,
}

#[derive(Clone, Copy, Debug)]
struct Instruction {
    operation: Operation,
    target: u32,
    a: u32,
    b: u32,
    c: u32,
}

/// Compiled equations: f(x, u, t, θ) for some list of results.
#[derive(Clone, Debug)]
pub struct Program {
    slots: Slots,
    registers: usize,
    constants: Vec<(u32, f64)>,
    prelude: Vec<Instruction>,
    body: Vec<Instruction>,
    results: Vec<u32>,
    /// By result: does it change from sample to sample, or only with θ?
    varies: Vec<bool>,
}

/// The registers of one evaluation; made once, used for every sample.
#[derive(Clone, Debug)]
pub struct Workspace<T>(Vec<T>);

impl Program {
    pub(super) fn compile(graph: &Graph, slots: Slots, roots: &[NodeId]) -> Self {
        let mut needed = vec![false; graph.len()];
        roots.iter().for_each(|&root| needed[root as usize] = true);
        for id in (0..graph.len()).rev() {
            if needed[id] {
                operands(graph.node(id as NodeId))
                    .for_each(|operand| needed[operand as usize] = true);
            }
        }
        let mut program = Self {
            slots,
            registers: slots.count(),
            constants: Vec::new(),
            prelude: Vec::new(),
            body: Vec::new(),
            results: Vec::new(),
            varies: Vec::new(),
        };
        let mut register = vec![0_u32; graph.len()];
        let mut varies = vec![false; graph.len()];
        let first_parameter = slots.parameter(0);
        for id in (0..graph.len()).filter(|&id| needed[id]) {
            let node = graph.node(id as NodeId);
            varies[id] = match node {
                Node::Symbol(slot) => slot < first_parameter,
                _ => operands(node).any(|operand| varies[operand as usize]),
            };
            if let Node::Symbol(slot) = node {
                register[id] = slot;
                continue;
            }
            let target = program.registers as u32;
            program.registers += 1;
            register[id] = target;
            let at = |operand: NodeId| register[operand as usize];
            let instruction = match node {
                Node::Constant(bits) => {
                    program.constants.push((target, f64::from_bits(bits)));
                    continue;
                }
                Node::Symbol(_) => continue,
                Node::Unary(unary, a) => Instruction {
                    operation: Operation::Unary(unary),
                    target,
                    a: at(a),
                    b: 0,
                    c: 0,
                },
                Node::Binary(binary, a, b) => Instruction {
                    operation: Operation::Binary(binary),
                    target,
                    a: at(a),
                    b: at(b),
                    c: 0,
                },
                Node::Select(a, b, c) => Instruction {
                    operation: Operation::Select,
                    target,
                    a: at(a),
                    b: at(b),
                    c: at(c),
                },
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

    pub fn is_empty(&self) -> bool {
        self.results.is_empty()
    }

    /// Operations a sample, without those done once for each θ.
    pub fn operations(&self) -> usize {
        self.body.len()
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
        execute(&self.prelude, &mut workspace.0);
    }

    /// Evaluates for the state, inputs and time that stand in the workspace.
    #[inline]
    pub fn run<T: Scalar>(&self, workspace: &mut Workspace<T>) {
        execute(&self.body, &mut workspace.0);
    }

    /// As [`Self::run`], with the widest vectors that the machine has; the numbers are the same.
    pub fn run_lanes(&self, workspace: &mut Workspace<Lanes>) {
        execute_lanes(&self.body, &mut workspace.0);
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

fn operands(node: Node) -> impl Iterator<Item = NodeId> {
    let list = match node {
        Node::Constant(_) | Node::Symbol(_) => [None; 3],
        Node::Unary(_, a) => [Some(a), None, None],
        Node::Binary(_, a, b) => [Some(a), Some(b), None],
        Node::Select(a, b, c) => [Some(a), Some(b), Some(c)],
    };
    list.into_iter().flatten()
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn execute_lanes(instructions: &[Instruction], registers: &mut [Lanes]) {
    execute(instructions, registers);
}

#[inline(always)]
fn execute<T: Scalar>(instructions: &[Instruction], registers: &mut [T]) {
    for instruction in instructions {
        let a = registers[instruction.a as usize];
        let value = match instruction.operation {
            Operation::Binary(binary) => {
                let b = registers[instruction.b as usize];
                match binary {
                    Binary::Add => a + b,
                    Binary::Subtract => a - b,
                    Binary::Multiply => a * b,
                    Binary::Divide => a / b,
                    Binary::Power => a.power(b),
                    Binary::Atan2 => a.atan2(b),
                    Binary::Less => a.less(b),
                    Binary::LessOrEqual => a.less_or_equal(b),
                }
            }
            Operation::Unary(unary) => match unary {
                Unary::Negate => -a,
                Unary::Sin => a.sin(),
                Unary::Cos => a.cos(),
                Unary::Tan => a.tan(),
                Unary::Asin => a.asin(),
                Unary::Acos => a.acos(),
                Unary::Atan => a.atan(),
                Unary::Tanh => a.tanh(),
                Unary::Exp => a.exp(),
                Unary::Ln => a.ln(),
                Unary::Sqrt => a.sqrt(),
                Unary::Abs => a.abs(),
                Unary::Sign => a.sign(),
            },
            Operation::Select => a.select(
                registers[instruction.b as usize],
                registers[instruction.c as usize],
            ),
        };
        registers[instruction.target as usize] = value;
    }
}
