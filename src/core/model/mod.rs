//! Models as data: a document that an engineer reads, and what it compiles to.
//!
//! There is one way from a model to numbers: [`ModelDocument`] → [`Model::compile`] → [`Program`]s for
//! f, g, x0 and their exact Jacobians. An effect is an [`Edit`] of the document.
//!
//! Invariant: a document from anybody compiles or is refused with the place; a compiled model reaches nothing but numbers.

mod affine;
pub mod catalog;
mod compile;
mod dependence;
mod derivative;
mod dimensions;
mod document;
mod edit;
mod element;
mod equations;
pub mod expression;
mod fmu;
mod formula;
mod graph;
mod instruction;
mod jacobian;
mod jsbsim;
pub(crate) mod limits;
mod names;
mod native;
mod operation;
mod paths;
mod program;
mod quantities;
mod scalar;
mod source;
mod trigonometry;
mod unique;

pub(crate) use affine::{Affine, Coefficient, Factor};
pub(crate) use dependence::Symbol;
pub use document::{
    Constant, Definition, Input, ModelDocument, Output, Parameter, Per, Prior, Start, State,
};
pub use edit::{Added, AddedRole, Edit, EditError, EditKind, Edited, Reference};
pub use element::Element;
pub use fmu::FmuSetting;
pub use formula::{ChannelFormula, FormulaError, Recorded};
pub use jacobian::Jacobian;
pub use jsbsim::NoAerodynamics;
use native::Native;
pub(crate) use native::{NativeSteps, StepBlock};
pub use paths::{PathElement, Paths};
pub use program::{Program, Workspace};
pub use quantities::{Quantities, Source, Taken};
pub use scalar::Scalar;
pub(crate) use scalar::{BLOCK, LANES, Lanes};
pub use source::SourceLanguage;
pub(crate) use unique::unique;

use std::sync::Arc;

use crate::flight::Unit;

/// A compiled model: everything in SI, everything that could be wrong checked.
#[derive(Clone, Debug)]
pub struct Model {
    /// What it was compiled from.
    pub document: ModelDocument,
    /// The inputs u of the document, in its order.
    pub inputs: Vec<Quantity>,
    /// The states x, in the document's order.
    pub states: Vec<Quantity>,
    /// The outputs y, in the document's order.
    pub outputs: Vec<Quantity>,
    /// The parameters, free and fixed, in the document's order.
    pub parameters: Vec<ParameterInfo>,
    /// x0(θ)
    pub initial: Program,
    /// f(x, u, t, θ)
    pub dynamics: Program,
    /// f as A x + B u + c, where it is of this form.
    pub(crate) affine_dynamics: Option<Affine>,
    /// f and g are A x + B u and C x + D u but for what is added: functions of θ, and the time itself.
    pub(crate) linear: bool,
    /// g(x, u, t, θ)
    pub observation: Program,
    /// ∂x0/∂θ
    pub initial_jacobian: Jacobian,
    /// ∂f/∂x and ∂f/∂θ
    pub dynamics_jacobian: Jacobian,
    /// ∂g/∂x and ∂g/∂θ
    pub observation_jacobian: Jacobian,
    /// Play, rate limits, lags and delays of inputs and outputs, by functions of θ.
    pub paths: Paths,
    /// The steps of `dynamics` as machine code, for all who share the model.
    native: Arc<Native>,
}

impl Model {
    /// Whether f is A x + B u + c with A, B and c functions of θ alone, so that a step is a product with a matrix.
    pub fn is_affine(&self) -> bool {
        self.affine_dynamics.is_some()
    }

    /// Whether states and outputs are linear in states and inputs, with coefficients that only θ changes; constants and
    /// drifts may be added to them.
    pub fn is_linear(&self) -> bool {
        self.linear
    }

    /// What its equations see as inputs: those of the document, then the ρ of each element of their paths.
    pub(crate) fn driven_inputs(&self) -> usize {
        self.inputs.len() + self.paths.of_inputs().len()
    }

    /// Machine code for `steps` that are about to be taken with so many stages each, where there is some.
    pub(crate) fn native(&self, steps: usize, stages: usize) -> Option<&NativeSteps> {
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
    /// As equations write it.
    pub name: String,
    /// The document's unit, and how to get from it to SI.
    pub unit: Unit,
    /// The SI unit in which its values are, as the field writes it: `rad/s`.
    pub si: String,
}

/// A parameter as the document has it; its numbers are in `unit`.
#[derive(Clone, PartialEq, Debug)]
pub struct ParameterInfo {
    /// As equations write it.
    pub name: String,
    /// The document's unit, and how to get from it to SI.
    pub unit: Unit,
    /// Start value, bounds, prior and the rest.
    pub document: Parameter,
}
