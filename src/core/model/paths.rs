//! Signal paths: what inputs pass before the equations see them, and outputs before they are recorded. The size of
//! each element is a function ψ(θ) of the parameters.
//!
//! Equations see an input with a path as v + Σ ρ_i ψ_i(θ), with v and the ρ_i given for each sample of a run: with ψ0
//! the sizes for the θ at hand and y(ψ) what comes out of the path, ρ_i = ∂y/∂ψ_i and v = y(ψ0) - Σ ρ_i ψ0_i. The
//! value is then y(ψ0), and every way of deriving by θ finds ∂u/∂ψ_i = ρ_i. How y and ρ are worked out, and what
//! becomes of an output, is the matter of the room `simulate`.

use super::element::Element;
use super::graph::{Graph, NodeId};
use super::jacobian::Jacobian;
use super::program::{Program, Slots};
use super::scalar::Scalar;

/// An element in the path of an input or output, which goes by its index.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PathElement {
    /// Which input or output.
    pub signal: usize,
    /// What it passes.
    pub element: Element,
}

/// The paths of a model's inputs and outputs.
#[derive(Clone, Debug)]
pub struct Paths {
    /// Those of inputs, then those of outputs; of one signal in the order in which it passes them. The i-th has its
    /// size at place i of [`Self::at`]; of an input, the slot of its ρ is at place i behind all inputs.
    elements: Vec<PathElement>,
    /// How many belong to inputs.
    of_inputs: usize,
    /// The sizes.
    program: Program,
    jacobian: Jacobian,
}

/// An element whose size is compiled.
pub(super) type Compiled = (PathElement, NodeId);

impl Paths {
    pub(super) fn compile(
        graph: &mut Graph,
        slots: Slots,
        inputs: &[Compiled],
        outputs: &[Compiled],
    ) -> Self {
        let (elements, roots): (Vec<PathElement>, Vec<NodeId>) =
            inputs.iter().chain(outputs).copied().unzip();
        Self {
            elements,
            of_inputs: inputs.len(),
            program: Program::compile(graph, slots, &roots),
            jacobian: Jacobian::derive(graph, slots, &roots),
        }
    }

    /// Whether no signal passes anything.
    pub fn is_empty(&self) -> bool {
        self.elements.is_empty()
    }

    /// All of them, by place.
    pub fn elements(&self) -> &[PathElement] {
        &self.elements
    }

    /// Those of inputs.
    pub fn of_inputs(&self) -> &[PathElement] {
        &self.elements[..self.of_inputs]
    }

    /// Those of outputs.
    pub fn of_outputs(&self) -> &[PathElement] {
        &self.elements[self.of_inputs..]
    }

    /// Whether the element at a place belongs to an input.
    pub fn is_of_input(&self, place: usize) -> bool {
        place < self.of_inputs
    }

    /// ψ(θ), SI, by place.
    pub fn at<T: Scalar>(&self, parameters: &[T]) -> Vec<T> {
        if self.is_empty() {
            return Vec::new();
        }
        let mut workspace = self.program.workspace();
        self.program.set_parameters(&mut workspace, parameters);
        self.program.run(&mut workspace);
        let mut sizes = vec![T::from_f64(0.0); self.program.len()];
        self.program.results(&workspace, &mut sizes);
        sizes
    }

    /// ∂ψ/∂θ: (place, parameter, value) where it is not structurally zero.
    pub fn derivatives(&self, parameters: &[f64]) -> Vec<(usize, usize, f64)> {
        let program = &self.jacobian.program;
        let mut workspace = program.workspace();
        program.set_parameters(&mut workspace, parameters);
        program.run(&mut workspace);
        let entries = self.jacobian.by_parameter.iter().enumerate();
        entries
            .map(|(entry, &(place, parameter))| {
                (place, parameter, program.result(&workspace, entry))
            })
            .collect()
    }

    /// As [`Self::derivatives`], of the elements of outputs, by place among them.
    pub fn output_derivatives(&self, parameters: &[f64]) -> Vec<(usize, usize, f64)> {
        let all = self.derivatives(parameters).into_iter();
        all.filter_map(|(place, parameter, value)| {
            Some((place.checked_sub(self.of_inputs)?, parameter, value))
        })
        .collect()
    }

    /// Whether the size of any element depends on a parameter.
    pub fn depends_on(&self, parameter: usize) -> bool {
        (self.jacobian.by_parameter.iter()).any(|&(_, by)| by == parameter)
    }

    /// Whether the path of an output depends on a parameter.
    pub fn output_depends_on(&self, output: usize, parameter: usize) -> bool {
        let mut elements = self.elements.iter().enumerate().skip(self.of_inputs);
        elements.any(|(place, element)| {
            element.signal == output && self.jacobian.by_parameter.contains(&(place, parameter))
        })
    }
}
