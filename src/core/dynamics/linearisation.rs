//! A, B, C, D of a model at the start of a segment, and their exact derivatives by θ.
//!
//! Inputs are parameters of the model compiled once more: there is one way to write models, and one to differentiate them.
//! The derivatives by θ, the initial state's part in them included, are by a complex step, exact but for rounding.

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::no_linear_system::NoLinearSystem;
use super::signal::Signal;
use crate::estimate::{Estimate, Estimated, Problem, is_kinematic};
use crate::model::{
    Jacobian, Model, ModelDocument, Parameter, PathElement, Per, Program, Quantities, Scalar, Start,
};
use crate::simulate::{Segment, initial_state};

/// Beside numbers near one this loses nothing, and its square is zero.
const COMPLEX_STEP: f64 = 1e-40;

/// Entries beyond this count as not finite: their squares would leave the range.
const LARGEST: f64 = 1e100;

/// The numbers of a linear system, SI; or their derivatives by one unknown.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Numbers {
    /// [A B; C D]
    pub matrix: DMatrix<f64>,
    /// Sizes of the elements of signal paths, by place.
    pub paths: Vec<f64>,
    /// x0 and dx/dt there.
    pub state: Vec<f64>,
    pub rates: Vec<f64>,
}

/// A model linearised at the start of one segment.
pub(super) struct Linearisation<'p> {
    pub problem: &'p Problem,
    pub estimated: Estimated,
    /// The segment's label.
    pub segment: String,
    /// The same for all states, inputs and segments?
    pub is_everywhere: bool,
    /// The motion is recorded rather than computed from forces.
    pub is_kinematic: bool,
    pub quantities: Quantities,
    pub inputs: Vec<Signal>,
    pub outputs: Vec<Signal>,
    /// u there.
    pub input_values: Vec<f64>,
    /// All parameters of the model there.
    pub parameters: Vec<f64>,
    pub at: Numbers,
    /// By place of θ.
    pub by_place: Vec<Numbers>,
}

impl<'p> Linearisation<'p> {
    /// At the start of the segment of this label, or of the first.
    pub(super) fn at(
        problem: &'p Problem,
        estimate: &Estimate,
        label: Option<&str>,
    ) -> Result<Self, NoLinearSystem> {
        let segment = find_segment(problem, label)?;
        let model = &problem.model;
        let equations = Equations::of(model)?;
        let estimated = Estimated::of(problem, estimate);
        let mut parameters = Vec::new();
        (estimated.unknowns).parameters(segment, &estimated.theta, &mut parameters);
        let data = &problem.segments[segment];
        let input_values = inputs_at_start(data);
        let at = equations.numbers(&equations.values(&parameters, &input_values));
        let mut by_place = vec![at.zero(); estimated.theta.len()];
        let mut own = false;
        for parameter in 0..parameters.len() {
            let Some(place) = estimated.unknowns.place(segment, parameter) else {
                continue;
            };
            let mut moved: Vec<Complex64> = parameters.iter().map(|&p| p.into()).collect();
            moved[parameter].im = COMPLEX_STEP;
            let values = equations.values(&moved, &input_values);
            let slopes: Vec<f64> = values.iter().map(|z| z.im / COMPLEX_STEP).collect();
            by_place[place] = equations.numbers(&slopes);
            own |= estimated.unknowns.at(place).segment.is_some()
                && by_place[place].matrix.iter().any(|&slope| slope != 0.0);
        }
        if !at.is_finite() || !by_place.iter().all(Numbers::is_finite) {
            return Err(NoLinearSystem::NotFinite(data.label.clone()));
        }
        let is_same = equations.are_same(problem, &estimated, &at);
        let quantities = Quantities::of(&model.document);
        let inputs = signals(model, &quantities, true);
        let outputs = signals(model, &quantities, false);
        Ok(Self {
            problem,
            estimated,
            segment: data.label.clone(),
            is_everywhere: !own && !equations.varies() && is_same,
            is_kinematic: is_kinematic(model),
            quantities,
            inputs,
            outputs,
            input_values,
            parameters,
            at,
            by_place,
        })
    }

    /// Number of states.
    pub(super) fn states(&self) -> usize {
        self.problem.model.states.len()
    }

    /// The standard error of something whose derivative by each unknown is known.
    pub(super) fn standard_error(&self, of: impl Fn(&Numbers) -> f64) -> Option<f64> {
        let derivatives: Vec<f64> = self.by_place.iter().map(of).collect();
        self.estimated.standard_error(&derivatives)
    }

    /// The place of an input or output of this name.
    pub(super) fn find(
        signals: &[Signal],
        what: &'static str,
        name: &str,
    ) -> Result<usize, NoLinearSystem> {
        let names = || signals.iter().map(|signal| signal.name.as_str());
        names()
            .position(|known| known == name)
            .ok_or_else(|| unknown(what, name, names()))
    }
}

impl Numbers {
    fn zero(&self) -> Self {
        Self {
            matrix: DMatrix::zeros(self.matrix.nrows(), self.matrix.ncols()),
            paths: vec![0.0; self.paths.len()],
            state: vec![0.0; self.state.len()],
            rates: vec![0.0; self.rates.len()],
        }
    }

    fn is_finite(&self) -> bool {
        let rest = [&self.paths, &self.state, &self.rates]
            .into_iter()
            .flatten();
        (self.matrix.iter().chain(rest)).all(|value| value.abs() < LARGEST)
    }
}

/// The equations with their inputs as parameters.
struct Equations<'m> {
    /// As it was estimated.
    original: &'m Model,
    model: Model,
}

impl<'m> Equations<'m> {
    fn of(original: &'m Model) -> Result<Self, NoLinearSystem> {
        let document = with_inputs_as_parameters(&original.document);
        let model = Model::compile(&document)
            .map_err(|faults| NoLinearSystem::TooLarge(faults.to_string()))?;
        Ok(Self { original, model })
    }

    fn varies(&self) -> bool {
        let jacobians = [
            &self.model.dynamics_jacobian,
            &self.model.observation_jacobian,
        ];
        let first = self.original.parameters.len();
        jacobians.into_iter().any(|jacobian| {
            let by_input = (jacobian.by_parameter.iter().enumerate())
                .filter(|(_, (_, parameter))| *parameter >= first)
                .map(|(entry, _)| jacobian.by_state.len() + entry);
            ((0..jacobian.by_state.len()).chain(by_input)).any(|i| jacobian.program.varies(i))
        })
    }

    /// Whether matrices and paths of all segments are these: values that are held differ from maneuver to maneuver, too.
    fn are_same(&self, problem: &Problem, estimated: &Estimated, at: &Numbers) -> bool {
        let mut parameters = Vec::new();
        problem.segments.iter().enumerate().all(|(index, data)| {
            (estimated.unknowns).parameters(index, &estimated.theta, &mut parameters);
            let other = self.numbers(&self.values(&parameters, &inputs_at_start(data)));
            other.matrix == at.matrix && other.paths == at.paths
        })
    }

    /// [A B; C D] by rows, then the sizes of paths, x0 and dx/dt, for any kind of number.
    fn values<T: Scalar>(&self, parameters: &[T], inputs: &[f64]) -> Vec<T> {
        let inputs = inputs.iter().map(|&value| T::from_f64(value));
        let all: Vec<T> = parameters.iter().copied().chain(inputs).collect();
        let state = initial_state(&self.model, &all);
        let mut values = self.dense(&self.model.dynamics_jacobian, state.len(), &state, &all);
        let outputs = self.model.outputs.len();
        values.extend(self.dense(&self.model.observation_jacobian, outputs, &state, &all));
        values.extend(self.original.paths.at(parameters));
        values.extend(&state);
        values.extend(results(&self.model.dynamics, &state, &all));
        values
    }

    /// The derivatives by states and inputs, by rows.
    fn dense<T: Scalar>(
        &self,
        jacobian: &Jacobian,
        rows: usize,
        state: &[T],
        parameters: &[T],
    ) -> Vec<T> {
        let (states, first) = (state.len(), self.original.parameters.len());
        let columns = states + self.original.inputs.len();
        let mut dense = vec![T::from_f64(0.0); rows * columns];
        let entries = results(&jacobian.program, state, parameters);
        let by_parameter = (jacobian.by_parameter.iter())
            .map(|&(row, parameter)| (row, parameter.checked_sub(first).map(|i| states + i)));
        let by_state = (jacobian.by_state.iter()).map(|&(row, state)| (row, Some(state)));
        for ((row, column), value) in by_state.chain(by_parameter).zip(entries) {
            if let Some(column) = column {
                dense[row * columns + column] = value;
            }
        }
        dense
    }

    fn numbers(&self, values: &[f64]) -> Numbers {
        let (states, outputs) = (self.original.states.len(), self.original.outputs.len());
        let (rows, columns) = (states + outputs, states + self.original.inputs.len());
        let (matrix, rest) = values.split_at(rows * columns);
        let (paths, rest) = rest.split_at(self.original.paths.elements().len());
        let (state, rates) = rest.split_at(states);
        Numbers {
            matrix: DMatrix::from_row_slice(rows, columns, matrix),
            paths: paths.to_vec(),
            state: state.to_vec(),
            rates: rates.to_vec(),
        }
    }
}

fn inputs_at_start(segment: &Segment) -> Vec<f64> {
    (segment.inputs.iter())
        .map(|samples| samples.first().copied().unwrap_or_default())
        .collect()
}

/// All results of a program at one state, at the start of time.
fn results<T: Scalar>(program: &Program, state: &[T], parameters: &[T]) -> Vec<T> {
    let mut workspace = program.workspace();
    program.set_parameters(&mut workspace, parameters);
    program.states(&mut workspace).copy_from_slice(state);
    *program.time(&mut workspace) = T::from_f64(0.0);
    program.run(&mut workspace);
    let mut results = vec![T::from_f64(0.0); program.len()];
    program.results(&workspace, &mut results);
    results
}

pub(super) fn with_inputs_as_parameters(document: &ModelDocument) -> ModelDocument {
    let mut document = document.clone();
    for (name, input) in std::mem::take(&mut document.inputs) {
        let parameter = Parameter {
            unit: input.unit,
            start: Start::Value(0.0),
            lower: None,
            upper: None,
            fixed: true,
            per: Per::Job,
            only_in: Vec::new(),
            prior: None,
            quantity: None,
            description: String::new(),
        };
        document.parameters.insert(name, parameter);
    }
    for output in document.outputs.values_mut() {
        (output.lag, output.delay) = (None, None);
    }
    document
}

pub(super) fn find_segment(
    problem: &Problem,
    label: Option<&str>,
) -> Result<usize, NoLinearSystem> {
    let labels = || {
        problem
            .segments
            .iter()
            .map(|segment| segment.label.as_str())
    };
    match label {
        None => Ok(0),
        Some(label) => labels()
            .position(|known| known == label)
            .ok_or_else(|| unknown("segment", label, labels())),
    }
}

fn unknown<'n>(
    what: &'static str,
    name: &str,
    known: impl Iterator<Item = &'n str>,
) -> NoLinearSystem {
    NoLinearSystem::Unknown {
        what,
        name: name.to_string(),
        known: known.collect::<Vec<_>>().join(", "),
    }
}

fn signals(model: &Model, quantities: &Quantities, of_inputs: bool) -> Vec<Signal> {
    let elements = (model.paths.elements().iter().enumerate())
        .filter(|&(place, _)| model.paths.is_of_input(place) == of_inputs);
    let elements: Vec<(usize, PathElement)> = elements.map(|(place, &at)| (place, at)).collect();
    let all = if of_inputs {
        &model.inputs
    } else {
        &model.outputs
    };
    let signal = |(index, of): (usize, &crate::model::Quantity)| Signal {
        name: of.name.clone(),
        unit: of.si.clone(),
        quantity: match of_inputs {
            true => quantities.get(&of.name),
            false => quantities.output(&of.name),
        },
        path: (elements.iter())
            .filter(|(_, at)| at.signal == index)
            .map(|&(place, at)| (at.element, place))
            .collect(),
    };
    all.iter().enumerate().map(signal).collect()
}
