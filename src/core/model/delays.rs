//! Time delays of inputs and outputs: functions D(θ) of the parameters, in seconds.
//!
//! Equations see a delayed input as v + ρ D(θ), with v and ρ given for each sample of a run: with D0 the delay
//! for the θ at hand, ρ = -du/dt at t - D0 and v = u(t - D0) - ρ D0. The value is then u(t - D0), and every way of
//! deriving by θ finds ∂u/∂D = ρ. How v and ρ are worked out, and how an output is delayed, is the matter of the
//! room `simulate`.

use super::graph::{Graph, NodeId};
use super::jacobian::Jacobian;
use super::program::{Program, Slots};
use super::scalar::Scalar;

/// Which inputs and outputs of a model are delayed, and by how much.
#[derive(Clone, Debug)]
pub struct Delays {
    /// Delayed inputs, by index. The i-th of them has the slot of its ρ behind all inputs, at place i.
    pub inputs: Vec<usize>,
    /// Delayed outputs, by index.
    pub outputs: Vec<usize>,
    /// Delays of those inputs, then of those outputs.
    program: Program,
    jacobian: Jacobian,
}

impl Delays {
    pub(super) fn compile(
        graph: &mut Graph,
        slots: Slots,
        inputs: &[(usize, NodeId)],
        outputs: &[(usize, NodeId)],
    ) -> Self {
        let roots: Vec<NodeId> = inputs
            .iter()
            .chain(outputs)
            .map(|&(_, node)| node)
            .collect();
        Self {
            inputs: inputs.iter().map(|&(input, _)| input).collect(),
            outputs: outputs.iter().map(|&(output, _)| output).collect(),
            program: Program::compile(graph, slots, &roots),
            jacobian: Jacobian::derive(graph, slots, &roots),
        }
    }

    /// Whether nothing is delayed.
    pub fn is_empty(&self) -> bool {
        self.inputs.is_empty() && self.outputs.is_empty()
    }

    /// D(θ) in s: of the delayed inputs, then of the delayed outputs.
    pub fn at<T: Scalar>(&self, parameters: &[T]) -> Vec<T> {
        if self.is_empty() {
            return Vec::new();
        }
        let mut workspace = self.program.workspace();
        self.program.set_parameters(&mut workspace, parameters);
        self.program.run(&mut workspace);
        let mut delays = vec![T::from_f64(0.0); self.program.len()];
        self.program.results(&workspace, &mut delays);
        delays
    }

    /// ∂D/∂θ of the delayed outputs: (output, parameter, value) where it is not structurally zero.
    pub fn output_derivatives(&self, parameters: &[f64]) -> Vec<(usize, usize, f64)> {
        let program = &self.jacobian.program;
        let mut workspace = program.workspace();
        program.set_parameters(&mut workspace, parameters);
        program.run(&mut workspace);
        let entries = self.jacobian.by_parameter.iter().enumerate();
        entries
            .filter_map(|(entry, &(row, parameter))| {
                let output = self.outputs.get(row.checked_sub(self.inputs.len())?)?;
                Some((*output, parameter, program.result(&workspace, entry)))
            })
            .collect()
    }

    /// Whether the delay of an output depends on a parameter.
    pub fn output_depends_on(&self, output: usize, parameter: usize) -> bool {
        let row = self.outputs.iter().position(|&delayed| delayed == output);
        row.is_some_and(|row| {
            let entry = (self.inputs.len() + row, parameter);
            self.jacobian.by_parameter.contains(&entry)
        })
    }
}
