//! The regression of equation error, made by an edit of the model: measured states become inputs, their
//! derivatives outputs.
//!
//! This leaves a problem of the usual kind, so that cost, steps, bounds, error bounds and collinear sets are
//! those of output error. States that no output measures stay states: they are integrated from the initial
//! values that the model gives them, driven by the measured ones.

pub(super) mod local_fit;
pub(super) mod measured;
pub(super) mod smoothing;

use crate::estimate::options::{Noise, Options};
use crate::estimate::problem::Problem;
use crate::estimate::problem::unknowns::Unknowns;
use crate::flight::{Dimension, Unit};
use crate::model::{Input, Model, ModelDocument, Output};
use crate::simulate::{InputInterpolation, Segment};
use measured::{MeasuredState, measured_states};
use smoothing::{Windows, half_width};

/// The regression problem of an output-error problem.
pub(crate) struct Regression {
    pub problem: Problem,
    /// θ of the problem it was made of, but for what the regression finds.
    rest: Vec<f64>,
    /// By place in the regression's θ: place in the θ of the problem it was made of.
    places: Vec<usize>,
    /// Names of the states that stay states.
    pub integrated: Vec<String>,
    /// The states that are measured, in the order of the inputs and outputs that they have become.
    pub measured: Vec<MeasuredState>,
}

/// A segment as the edited model wants it, and the first value of each measured state.
type Made = (Segment, Vec<f64>);

impl Regression {
    /// `None` where no output measures a state, or the edited model is too large.
    pub(crate) fn new(problem: &Problem) -> Option<Self> {
        Self::with(problem, with_states)
    }

    /// As [`Self::new`], with all signals as they were recorded: where the outputs of the edited model are derivatives of
    /// states, the segments have the states themselves.
    pub(crate) fn recorded(problem: &Problem) -> Option<Self> {
        Self::with(problem, with_recorded_states)
    }

    fn with(
        problem: &Problem,
        made: impl Fn(&Problem, &Segment, &[MeasuredState], &[f64]) -> Made,
    ) -> Option<Self> {
        let start = problem.unknowns.start();
        let mut parameters = Vec::new();
        if problem.segments.is_empty() {
            return None;
        }
        problem.unknowns.parameters(0, &start, &mut parameters);
        let measured = measured_states(&problem.model, &parameters);
        if measured.is_empty() && !problem.model.states.is_empty() {
            return None;
        }
        let model = regressed(&problem.model, &measured)?;

        let mut rest = start.clone();
        let mut segments = Vec::new();
        let mut initial = InitialStates::new(problem);
        for (index, segment) in problem.segments.iter().enumerate() {
            problem.unknowns.parameters(index, &start, &mut parameters);
            let (segment, first) = made(problem, segment, &measured, &parameters);
            segments.push(segment);
            for (at, value) in measured.iter().zip(first) {
                initial.add(problem, &model, index, at.state, value);
            }
        }
        initial.set(problem, &mut rest);
        let unknowns = Unknowns::new(&model, segments.len(), |parameter, segment| {
            problem
                .unknowns
                .parameters(segment, &start, &mut parameters);
            Ok::<f64, ()>(parameters[parameter])
        })
        .ok()?
        .held_elsewhere(&model, |segment, label| segments[segment].label == label);
        let places = unknowns
            .free
            .iter()
            .map(|&i| {
                let unknown = &unknowns.all[i];
                problem
                    .unknowns
                    .place(unknown.segment.unwrap_or(0), unknown.parameter)
            })
            .collect::<Option<Vec<usize>>>()?;
        let options = Options {
            noise: Noise::default(),
            // smoothed inputs are held no more
            input_interpolation: InputInterpolation::Linear,
            ..problem.options.clone()
        };
        let states = problem.model.states.iter().enumerate();
        let integrated = states.filter(|(i, _)| measured.iter().all(|at| at.state != *i));
        Some(Self {
            integrated: integrated.map(|(_, state)| state.name.clone()).collect(),
            problem: Problem::new(model, segments, unknowns, options),
            rest,
            places,
            measured,
        })
    }

    /// θ of the problem that the regression was made of: what the regression does not find is left at its start,
    /// but for initial states, which are read off the measured states.
    pub(crate) fn theta(&self, found: &[f64]) -> Vec<f64> {
        let mut theta = self.rest.clone();
        for (&place, &value) in self.places.iter().zip(found) {
            theta[place] = value;
        }
        theta
    }

    /// By place of the problem's θ: place in the regression's.
    pub(crate) fn place(&self, place: usize) -> Option<usize> {
        self.places.iter().position(|&own| own == place)
    }
}

/// The model with measured states as inputs, and their derivatives in place of the outputs that measure them; parameters that are in
/// no equation of it are fixed. `None` where it is too large.
pub(crate) fn regressed(model: &Model, measured: &[MeasuredState]) -> Option<Model> {
    let mut regressed = Model::compile(&edited(model, measured)).ok()?;
    fix_unused(&mut regressed);
    Some(regressed)
}

/// The document with measured states as inputs, and their derivatives in place of the outputs that measure them.
fn edited(model: &Model, measured: &[MeasuredState]) -> ModelDocument {
    let mut document = model.document.clone();
    document.outputs.clear();
    for at in measured {
        let name = &model.states[at.state].name;
        let Some(state) = document.states.shift_remove(name) else {
            continue;
        };
        let unit = Unit::parse(&state.unit).map_or(Dimension::NONE, |unit| unit.dimension);
        let output = Output {
            unit: unit.over(Dimension::SECOND).to_string(),
            equation: state.derivative,
            description: format!("derivative of the measured {name}"),
            ..Default::default()
        };
        document.outputs.insert(format!("d_{name}_dt"), output);
        let input = Input {
            unit: state.unit,
            quantity: state.quantity,
            description: state.description,
            ..Default::default()
        };
        document.inputs.insert(name.clone(), input);
    }
    for (index, (name, output)) in model.document.outputs.iter().enumerate() {
        if measured.iter().any(|at| at.output == index) {
            continue;
        }
        let taken =
            |name: &str| document.outputs.contains_key(name) || document.inputs.contains_key(name);
        let numbered = (2..).map(|n| format!("{name}_{n}"));
        let free = std::iter::once(name.clone())
            .chain(numbered)
            .find(|name| !taken(name));
        document
            .outputs
            .insert(free.unwrap_or_default(), output.clone());
    }
    document
}

/// Fixes the parameters that no equation names any more.
fn fix_unused(model: &mut Model) {
    let jacobians = [
        &model.initial_jacobian,
        &model.dynamics_jacobian,
        &model.observation_jacobian,
    ];
    let used: Vec<bool> = (0..model.parameters.len())
        .map(|parameter| {
            let enters = |entry: &(usize, usize)| entry.1 == parameter;
            jacobians
                .iter()
                .any(|jacobian| jacobian.by_parameter.iter().any(enters))
        })
        .collect();
    for (info, used) in model.parameters.iter_mut().zip(used) {
        info.document.fixed |= !used;
    }
}

/// The segment as the edited model wants it, and the first value of each measured state.
///
/// States, inputs and outputs pass through the same local polynomials as the derivatives. An equation linear in them
/// holds for what a linear filter leaves as it held before; with the states alone smoothed, an input that jumps, or
/// that feeds back the states' noise, would drive a motion that the filter took away.
fn with_states(
    problem: &Problem,
    segment: &Segment,
    measured: &[MeasuredState],
    parameters: &[f64],
) -> Made {
    let time = segment.elapsed();
    let read = |at: &MeasuredState| at.read(&problem.model, segment, parameters);
    let states: Vec<Vec<f64>> = measured.iter().map(read).collect();
    let series: Vec<&[f64]> = states.iter().map(Vec::as_slice).collect();
    let windows = Windows::new(&time, half_width(&time, &series));
    let mut made = segment.clone();
    for input in &mut made.inputs {
        let seen = match problem.options.input_interpolation {
            InputInterpolation::Linear => input.clone(),
            InputInterpolation::Hold => around_samples(input),
        };
        *input = windows.smoothed(&seen).value;
    }
    made.measured.clear();
    let mut first = Vec::new();
    for state in &states {
        let smooth = windows.smoothed(state);
        first.push(smooth.value.first().copied().unwrap_or(0.0));
        made.inputs.push(smooth.value);
        made.measured.push(smooth.slope);
    }
    let others = segment.measured.iter().enumerate();
    let others = others.filter(|(i, _)| measured.iter().all(|at| at.output != *i));
    made.measured.extend(others.map(|(_, values)| {
        let smooth = windows.smoothed(values).value;
        let numbers = values.iter().zip(smooth);
        // what was not measured is not made up
        numbers
            .map(|(z, smooth)| if z.is_finite() { smooth } else { *z })
            .collect()
    }));
    (made, first)
}

/// The segment with measured states behind its inputs, and again in place of their derivatives.
fn with_recorded_states(
    problem: &Problem,
    segment: &Segment,
    measured: &[MeasuredState],
    parameters: &[f64],
) -> Made {
    let read = |at: &MeasuredState| at.read(&problem.model, segment, parameters);
    let states: Vec<Vec<f64>> = measured.iter().map(read).collect();
    let first = states.iter().map(|state| state[0]).collect();
    let mut made = segment.clone();
    made.inputs.extend(states.iter().cloned());
    made.measured = states;
    let others = segment.measured.iter().enumerate();
    let others = others.filter(|(i, _)| measured.iter().all(|at| at.output != *i));
    made.measured
        .extend(others.map(|(_, values)| values.clone()));
    (made, first)
}

/// A held input as it acts around each sample: the mean of what is held before and after.
fn around_samples(input: &[f64]) -> Vec<f64> {
    let before = input.iter().take(1).chain(input);
    before
        .zip(input)
        .map(|(before, after)| 0.5 * (before + after))
        .collect()
}

/// Initial states that are parameters of nothing else: read off the data, the mean where segments share one.
struct InitialStates {
    /// By place of θ: sum and count.
    sums: Vec<(f64, usize)>,
}

impl InitialStates {
    fn new(problem: &Problem) -> Self {
        Self {
            sums: vec![(0.0, 0); problem.unknowns.len()],
        }
    }

    fn add(
        &mut self,
        problem: &Problem,
        regression: &Model,
        segment: usize,
        state: usize,
        value: f64,
    ) {
        let Some((_, document)) = problem.model.document.states.get_index(state) else {
            return;
        };
        let parameters = &problem.model.parameters;
        let Some(parameter) = parameters
            .iter()
            .position(|p| p.name == document.initial.trim())
        else {
            return;
        };
        let elsewhere = !regression.parameters[parameter].document.fixed;
        if let Some(place) = problem.unknowns.place(segment, parameter)
            && !elsewhere
        {
            self.sums[place].0 += value;
            self.sums[place].1 += 1;
        }
    }

    fn set(&self, problem: &Problem, theta: &mut [f64]) {
        for (place, &(sum, count)) in self.sums.iter().enumerate() {
            if count > 0 {
                let unknown = problem.unknowns.at(place);
                theta[place] = (sum / count as f64).clamp(unknown.lower, unknown.upper);
            }
        }
    }
}
