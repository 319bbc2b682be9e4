//! The state equations as sums of regressors: y_i = h_i(x, u) + Σ_j φ_ij(x, u) θ_j + c_i.
//!
//! y_i is the derivative of a measured state, or an output that measures none; h_i is what needs no estimated parameter. Trim values
//! and biases multiply other parameters (Ma (alpha - alpha_eq)) and would make the sum no sum: those that only shift an equation are
//! held, and the equation has a constant c_i of its own in their place.

use crate::estimate::{MeasuredState, measured_states, regressed};
use crate::flight::{Fault, Faults, escape};
use crate::model::{Model, Symbol, Workspace};
use crate::recursive::sample::Sample;
use crate::recursive::setup::Setup;

/// A regressor: which parameter it belongs to, and where it is found.
pub(super) struct Entry {
    /// By place in [`Equations::tracked`].
    pub column: usize,
    result: usize,
    /// Whether an input goes into it, which may jump.
    pub of_input: bool,
}

/// One equation.
pub(super) struct Row {
    pub entries: Vec<Entry>,
    /// Whether it has a constant of its own.
    pub constant: bool,
    /// Whether an input goes into h.
    pub of_input: bool,
}

/// All equations of a model, to be evaluated sample by sample. Signals are inputs, then measured states, then other outputs.
pub(super) struct Equations {
    model: Model,
    asked: Model,
    measured: Vec<MeasuredState>,
    slopes_of_states: Vec<f64>,
    /// Outputs that measure no state.
    others: Vec<usize>,
    /// By column: the parameter of the model that was asked about.
    pub tracked: Vec<usize>,
    /// Those of measured states first.
    pub rows: Vec<Row>,
    known: Workspace<f64>,
    regressors: Workspace<f64>,
    reading: Workspace<f64>,
}

impl Equations {
    pub(super) fn new(setup: &Setup) -> Result<Self, Faults> {
        let asked = setup.model.clone();
        let measured = measured_states(&asked, &setup.start);
        check_states(&asked, &measured)?;
        let model = regressed(&asked, &measured).ok_or_else(too_large)?;
        let mut parameters = setup.start.clone();
        let free: Vec<bool> = (model.parameters.iter().zip(&setup.free))
            .map(|(parameter, free)| *free && !parameter.document.fixed)
            .collect();
        let linear = Linear::of(&model, &free, measured.len())?;
        for &parameter in &linear.tracked {
            parameters[parameter] = 0.0;
        }
        let mut known = model.observation.workspace();
        model.observation.set_parameters(&mut known, &parameters);
        let program = &model.observation_jacobian.program;
        let mut regressors = program.workspace();
        program.set_parameters(&mut regressors, &parameters);
        check_starts(setup, &model, &linear)?;
        let mut reading = asked.observation.workspace();
        asked.observation.set_parameters(&mut reading, &setup.start);
        let others = (0..asked.outputs.len())
            .filter(|output| measured.iter().all(|at| at.output != *output));
        Ok(Self {
            slopes_of_states: (measured.iter())
                .map(|at| at.slope(&asked, &setup.start))
                .collect(),
            others: others.collect(),
            tracked: linear.tracked,
            rows: linear.rows,
            model,
            asked,
            measured,
            known,
            regressors,
            reading,
        })
    }

    /// Inputs of the model that was asked about.
    pub(super) fn inputs(&self) -> usize {
        self.asked.inputs.len()
    }

    /// Measured states: the first rows are their derivatives.
    pub(super) fn states(&self) -> usize {
        self.measured.len()
    }

    /// Inputs, measured states and other outputs.
    pub(super) fn signals(&self) -> usize {
        self.inputs() + self.measured.len() + self.others.len()
    }

    /// Regressors of all rows.
    pub(super) fn entries(&self) -> usize {
        self.rows.iter().map(|row| row.entries.len()).sum()
    }

    /// The signals of a sample, `elapsed` seconds after the first: states as (z - b)/a.
    pub(super) fn read(&mut self, sample: &Sample<'_>, elapsed: f64, to: &mut [f64]) {
        let (inputs, rest) = to.split_at_mut(self.asked.inputs.len());
        inputs.copy_from_slice(sample.inputs);
        let program = &self.asked.observation;
        // the workspace's states are zero: what is left of the output is b
        *program.time(&mut self.reading) = elapsed;
        program.run(&mut self.reading);
        let (states, others) = rest.split_at_mut(self.measured.len());
        for ((to, at), slope) in (states.iter_mut().zip(&self.measured)).zip(&self.slopes_of_states)
        {
            let shift = program.result(&self.reading, at.output);
            *to = (sample.outputs[at.output] - shift) / slope;
        }
        for (to, &output) in others.iter_mut().zip(&self.others) {
            *to = sample.outputs[output];
        }
    }

    /// h by row, and φ row by row, for inputs and measured states.
    pub(super) fn evaluate(
        &mut self,
        signals: &[f64],
        elapsed: f64,
        known: &mut [f64],
        regressors: &mut [f64],
    ) {
        let signals = &signals[..self.asked.inputs.len() + self.measured.len()];
        let program = &self.model.observation;
        program.inputs(&mut self.known).copy_from_slice(signals);
        *program.time(&mut self.known) = elapsed;
        program.run(&mut self.known);
        program.results(&self.known, known);
        let program = &self.model.observation_jacobian.program;
        program
            .inputs(&mut self.regressors)
            .copy_from_slice(signals);
        *program.time(&mut self.regressors) = elapsed;
        program.run(&mut self.regressors);
        let entries = self.rows.iter().flat_map(|row| &row.entries);
        for (to, entry) in regressors.iter_mut().zip(entries) {
            *to = program.result(&self.regressors, entry.result);
        }
    }
}

/// Which parameters an equation is linear in.
struct Linear {
    tracked: Vec<usize>,
    rows: Vec<Row>,
}

impl Linear {
    fn of(model: &Model, free: &[bool], measured: usize) -> Result<Self, Faults> {
        let jacobian = &model.observation_jacobian;
        let program = &jacobian.program;
        let first = jacobian.by_state.len();
        let is_in = |free: &[bool]| {
            program.depends_on(|symbol| matches!(symbol, Symbol::Parameter(i) if free[i]))
        };
        // by parameter: whether the slope of a row by it depends on what is estimated, and on the signals
        let mut shifts = vec![false; free.len()];
        let all = is_in(free);
        for parameter in (0..free.len()).filter(|&i| free[i]) {
            let mut own =
                (jacobian.by_parameter.iter().enumerate()).filter(|(_, at)| at.1 == parameter);
            let mut results = own.clone().map(|(entry, _)| first + entry);
            shifts[parameter] = own.any(|(entry, _)| all[first + entry])
                && results.all(|result| !program.varies(result));
        }
        let kept: Vec<bool> = free
            .iter()
            .zip(&shifts)
            .map(|(free, shift)| *free && !shift)
            .collect();
        let entangled = is_in(&kept);
        let is_entangled = |parameter: usize| {
            let mut all = jacobian.by_parameter.iter().enumerate();
            all.any(|(entry, at)| at.1 == parameter && entangled[first + entry])
        };
        let tracked: Vec<usize> = (0..kept.len()).filter(|&i| kept[i]).collect();
        let not_linear: Vec<usize> = tracked
            .iter()
            .copied()
            .filter(|&i| is_entangled(i))
            .collect();
        if !not_linear.is_empty() {
            return Err(not_a_sum(model, &not_linear));
        }
        if tracked.is_empty() {
            return Err(nothing_to_track());
        }
        let recorded = model.inputs.len() - measured;
        let is_input = |symbol: Symbol| matches!(symbol, Symbol::Input(i) if i < recorded);
        let (slope_of_input, known_of_input) = (
            program.depends_on(is_input),
            model.observation.depends_on(is_input),
        );
        let row = |row: usize| {
            let own = jacobian
                .by_parameter
                .iter()
                .enumerate()
                .filter(|(_, at)| at.0 == row);
            let entries = own.clone().filter_map(|(entry, at)| {
                Some(Entry {
                    column: tracked.iter().position(|&parameter| parameter == at.1)?,
                    result: first + entry,
                    of_input: slope_of_input[first + entry],
                })
            });
            let entries: Vec<Entry> = entries.collect();
            let has_level = entries.iter().any(|entry| !program.varies(entry.result));
            Row {
                constant: !has_level && own.clone().any(|(_, at)| shifts[at.1]),
                of_input: known_of_input[row],
                entries,
            }
        };
        let rows = (0..model.outputs.len()).map(row).collect();
        Ok(Self { tracked, rows })
    }
}

fn check_states(model: &Model, measured: &[MeasuredState]) -> Result<(), Faults> {
    let states = model.states.iter().enumerate();
    let unseen = states.filter(|(i, _)| measured.iter().all(|at| at.state != *i));
    let faults: Vec<Fault> = unseen
        .map(|(_, state)| {
            let name = &state.name;
            let message = format!("no output measures {name}, as equation error needs: an output whose equation is {name}; add one, or use ekf");
            Fault::new(format!("/model/states/{}", escape(name)), "no_measured_state", message)
        })
        .collect();
    match faults.is_empty() {
        true => Ok(()),
        false => Err(faults.into()),
    }
}

/// A start that is not there must not matter.
fn check_starts(setup: &Setup, model: &Model, linear: &Linear) -> Result<(), Faults> {
    let jacobian = &model.observation_jacobian;
    let faults: Vec<Fault> = (0..setup.start.len())
        .filter(|&i| setup.unread[i] && !setup.free[i] && !linear.tracked.contains(&i))
        .filter(|&i| {
            let is_it = |symbol: Symbol| symbol == Symbol::Parameter(i);
            let used =
                [&model.observation, &jacobian.program].map(|program| program.depends_on(is_it));
            used.iter().flatten().any(|used| *used)
        })
        .map(|i| setup.no_start(i))
        .collect();
    match faults.is_empty() {
        true => Ok(()),
        false => Err(faults.into()),
    }
}

fn too_large() -> Faults {
    Fault::new(
        "/model",
        "too_large",
        "the model is too large to be regressed; use ekf",
    )
    .into()
}

fn nothing_to_track() -> Faults {
    let message = "no parameter is free in an equation of a measured state; free one, or use ekf";
    Fault::new("/model/parameters", "nothing_to_estimate", message).into()
}

fn not_a_sum(model: &Model, parameters: &[usize]) -> Faults {
    let names: Vec<&str> = parameters
        .iter()
        .map(|&i| model.parameters[i].name.as_str())
        .collect();
    let message = format!(
        "the state equations are not linear in {} together; hold some of them (fixed), or use ekf",
        names.join(", ")
    );
    let pointer = format!("/model/parameters/{}", escape(names[0]));
    Fault::new(pointer, "not_linear", message).into()
}
