//! dx/dt and every quantity of a model as functions of states and inputs, with their exact derivatives.

use indexmap::IndexMap;
use nalgebra::DMatrix;

use crate::dynamics::linearisation::with_inputs_as_parameters;
use crate::flight::Faults;
use crate::model::{Jacobian, Model, ModelDocument, Output, Program};

/// The equations with inputs as parameters, and definitions and outputs as outputs.
pub(in crate::dynamics) struct Equations {
    model: Model,
    pub states: usize,
    pub inputs: usize,
    parameters: usize,
    /// Definitions, then outputs, by name, with the document's unit.
    pub quantities: Vec<(String, String, bool)>,
}

/// Values of some functions and their derivatives.
pub(in crate::dynamics) struct Rows {
    pub values: Vec<f64>,
    /// By states, then inputs.
    pub by_unknown: DMatrix<f64>,
    pub by_parameter: DMatrix<f64>,
}

/// All of them at one place.
pub(in crate::dynamics) struct At {
    /// dx/dt
    pub rates: Rows,
    pub quantities: Rows,
}

impl Equations {
    pub(in crate::dynamics) fn of(original: &Model) -> Result<Self, Faults> {
        let document = &original.document;
        let definitions = (document.definitions.iter())
            .map(|(name, definition)| (name.clone(), definition.unit.clone(), true));
        let outputs = (document.outputs.iter())
            .map(|(name, output)| (name.clone(), output.unit.clone(), false));
        let quantities: Vec<_> = definitions.chain(outputs).collect();
        let model = Model::compile(&with_quantities_as_outputs(document, &quantities))?;
        Ok(Self {
            model,
            states: original.states.len(),
            inputs: original.inputs.len(),
            parameters: original.parameters.len(),
            quantities,
        })
    }

    /// The initial state of the model.
    pub(in crate::dynamics) fn initial(&self, parameters: &[f64]) -> Vec<f64> {
        let z = vec![0.0; self.states + self.inputs];
        self.results(&self.model.initial, &z, parameters)
    }

    /// At states and inputs `z`.
    pub(in crate::dynamics) fn at(&self, z: &[f64], parameters: &[f64]) -> At {
        let rows = |program: &Program, jacobian: &Jacobian| {
            let values = self.results(program, z, parameters);
            let entries = self.results(&jacobian.program, z, parameters);
            self.rows(values, jacobian, &entries)
        };
        At {
            rates: rows(&self.model.dynamics, &self.model.dynamics_jacobian),
            quantities: rows(&self.model.observation, &self.model.observation_jacobian),
        }
    }

    fn rows(&self, values: Vec<f64>, jacobian: &Jacobian, entries: &[f64]) -> Rows {
        let count = values.len();
        let mut by_unknown = DMatrix::zeros(count, self.states + self.inputs);
        let mut by_parameter = DMatrix::zeros(count, self.parameters);
        let (by_state, rest) = entries.split_at(jacobian.by_state.len());
        for (&(row, state), entry) in jacobian.by_state.iter().zip(by_state) {
            by_unknown[(row, state)] = *entry;
        }
        for (&(row, parameter), entry) in jacobian.by_parameter.iter().zip(rest) {
            // inputs stand behind the parameters
            match parameter.checked_sub(self.parameters) {
                Some(input) => by_unknown[(row, self.states + input)] = *entry,
                None => by_parameter[(row, parameter)] = *entry,
            }
        }
        Rows {
            values,
            by_unknown,
            by_parameter,
        }
    }

    fn results(&self, program: &Program, z: &[f64], parameters: &[f64]) -> Vec<f64> {
        let (state, inputs) = z.split_at(self.states);
        let all: Vec<f64> = parameters.iter().chain(inputs).copied().collect();
        let mut workspace = program.workspace();
        program.set_parameters(&mut workspace, &all);
        program.states(&mut workspace).copy_from_slice(state);
        *program.time(&mut workspace) = 0.0;
        program.run(&mut workspace);
        let mut results = vec![0.0; program.len()];
        program.results(&workspace, &mut results);
        results
    }
}

/// An output of a definition may be called like an output of the document: they are numbered.
fn with_quantities_as_outputs(
    document: &ModelDocument,
    quantities: &[(String, String, bool)],
) -> ModelDocument {
    let mut seen = with_inputs_as_parameters(document);
    let output = |(place, (name, unit, is_definition)): (usize, &(String, String, bool))| {
        let equation = match is_definition {
            true => name.clone(),
            false => document.outputs[name].equation.clone(),
        };
        let output = Output {
            unit: unit.clone(),
            equation,
            ..Output::default()
        };
        (format!("quantity_{place}"), output)
    };
    seen.outputs = quantities
        .iter()
        .enumerate()
        .map(output)
        .collect::<IndexMap<_, _>>();
    seen
}
