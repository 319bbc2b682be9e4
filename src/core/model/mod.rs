//! Models as data: a document that an engineer reads, and what it compiles to.
//!
//! There is one way from a model to numbers: [`ModelDocument`] → [`Model::compile`] → [`Program`]s for
//! f, g, x0 and their exact Jacobians. An effect is an [`Edit`] of the document.

mod affine;
pub mod catalog;
mod compile;
mod derivative;
mod dimensions;
mod document;
mod edit;
mod element;
mod equations;
pub mod expression;
mod formula;
mod graph;
mod instruction;
mod jacobian;
pub mod limits;
mod names;
mod native;
mod operation;
mod paths;
mod program;
mod quantities;
mod scalar;
mod trigonometry;
mod unique;

pub use affine::{Affine, Coefficient, Factor};
pub use document::{
    Constant, Definition, Input, ModelDocument, Output, Parameter, Per, Prior, Start, State,
};
pub use edit::{Added, AddedRole, Edit, EditError, EditKind, Edited, Reference};
pub use element::Element;
pub use formula::{ChannelFormula, FormulaError, Recorded};
pub use jacobian::Jacobian;
pub use native::{Native, NativeSteps, Stretch};
pub use paths::{PathElement, Paths};
pub use program::{Program, Workspace};
pub use quantities::{Quantities, Source, Taken};
pub use scalar::{BLOCK, LANES, Lanes, Scalar};
pub use unique::unique;

use std::sync::Arc;

use crate::flight::Unit;

/// A compiled model: everything in SI, everything that could be wrong checked.
#[derive(Clone, Debug)]
pub struct Model {
    pub document: ModelDocument,
    pub inputs: Vec<Quantity>,
    pub states: Vec<Quantity>,
    pub outputs: Vec<Quantity>,
    pub parameters: Vec<ParameterInfo>,
    /// x0(θ)
    pub initial: Program,
    /// f(x, u, t, θ)
    pub dynamics: Program,
    /// f as A x + B u + c, where it is of this form.
    pub affine_dynamics: Option<Affine>,
    /// g(x, u, t, θ)
    pub observation: Program,
    pub initial_jacobian: Jacobian,
    pub dynamics_jacobian: Jacobian,
    pub observation_jacobian: Jacobian,
    pub paths: Paths,
    /// The steps of `dynamics` as machine code, for all who share the model.
    native: Arc<Native>,
}

impl Model {
    /// What its equations see as inputs: those of the document, then the ρ of each element of their paths.
    pub fn driven_inputs(&self) -> usize {
        self.inputs.len() + self.paths.of_inputs().len()
    }

    /// Machine code for `steps` that are about to be taken with so many stages each, where there is some.
    pub fn native(&self, steps: usize, stages: usize) -> Option<&NativeSteps> {
        self.native.steps(&self.dynamics, steps, stages)
    }

    /// Compiles to machine code now what would be once enough steps were taken; whether there is any.
    pub fn make_native(&self) -> bool {
        self.native.now(&self.dynamics).is_some()
    }
}

/// A named quantity of a model and the unit its document gives it.
#[derive(Clone, PartialEq, Debug)]
pub struct Quantity {
    pub name: String,
    pub unit: Unit,
    /// The SI unit in which its values are, as the field writes it: `rad/s`.
    pub si: String,
}

/// A parameter as the document has it; its numbers are in `unit`.
#[derive(Clone, PartialEq, Debug)]
pub struct ParameterInfo {
    pub name: String,
    pub unit: Unit,
    pub document: Parameter,
}
