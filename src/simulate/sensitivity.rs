//! Outputs and their sensitivities ∂y/∂θ, by forward sensitivities of the integration scheme itself.
//!
//! The trajectory is sequential in time, its Jacobians are not. A block of samples is done in three passes:
//! 1. integrate the states, keeping every stage state (sequential, scalar);
//! 2. evaluate ∂f/∂x, ∂f/∂θ at all stages and g, ∂g/∂x, ∂g/∂θ at all samples (side by side, [`LANES`] at a time);
//! 3. run the recursion of ∂x/∂θ and form the rows of ∂y/∂θ (sequential, vectors over parameters).
//!
//! The derivative is that of the discretised model, exact but for rounding. Memory does not grow with the
//! length of the recording.

use super::method::{InputInterpolation, Integrator, Stage};
use super::segment::Segment;
use super::stepper::{Stepper, between};
use super::trajectory::{Diverged, initial_state};
use crate::model::{Jacobian, LANES, Lanes, Model, Program, Workspace};

/// Samples in a block.
const BLOCK: usize = 4 * LANES;

/// Which parameters to differentiate by, sorted so that rows of ∂y/∂θ have no structural zeros.
///
/// Parameters that enter the state equations or the initial state come first: every output that sees a
/// state sees all of them. Each output adds the parameters that enter its own equation only.
#[derive(Clone, PartialEq, Debug)]
pub struct Columns {
    /// Parameters behind the sensitivities of the states.
    dynamic: Vec<usize>,
    /// By output: does it see the states, and parameters that only its own equation has.
    rows: Vec<Row>,
}

#[derive(Clone, PartialEq, Debug)]
struct Row {
    sees_states: bool,
    own: Vec<usize>,
    /// The row as a list of parameters: the dynamic ones, then its own.
    parameters: Vec<usize>,
}

impl Columns {
    /// For the parameters `free` of a model.
    pub fn new(model: &Model, free: &[usize]) -> Self {
        let enters = |jacobian: &Jacobian, p: usize| {
            jacobian.by_parameter.iter().any(|&(_, column)| column == p)
        };
        let (dynamic, other): (Vec<usize>, Vec<usize>) = (free.iter().copied()).partition(|&p| {
            enters(&model.dynamics_jacobian, p) || enters(&model.initial_jacobian, p)
        });
        let observation = &model.observation_jacobian;
        let row = |output: usize| {
            let sees_states = observation.by_state.iter().any(|&(row, _)| row == output);
            // a dynamic parameter may also stand in an output that sees no state
            let candidates = other.iter().chain(if sees_states {
                [].iter()
            } else {
                dynamic.iter()
            });
            let own: Vec<usize> = candidates
                .copied()
                .filter(|&p| observation.by_parameter.contains(&(output, p)))
                .collect();
            let seen = if sees_states { dynamic.as_slice() } else { &[] };
            let parameters = seen.iter().chain(&own).copied().collect();
            Row {
                sees_states,
                own,
                parameters,
            }
        };
        let rows = (0..model.outputs.len()).map(row).collect();
        Self { dynamic, rows }
    }

    /// The parameters of the model that the columns of ∂y/∂θ of `output` belong to.
    pub fn of_output(&self, output: usize) -> &[usize] {
        &self.rows[output].parameters
    }
}

/// Outputs and sensitivities of some consecutive samples.
pub struct Block<'a> {
    /// Index of the first sample.
    pub first: usize,
    pub len: usize,
    outputs: &'a [Vec<f64>],
    rows: &'a [Vec<f64>],
}

impl Block<'_> {
    /// y of one output, sample by sample.
    pub fn output(&self, output: usize) -> &[f64] {
        &self.outputs[output][..self.len]
    }

    /// ∂y/∂θ of one output: sample by sample, within it in the order of [`Columns::of_output`].
    pub fn sensitivity(&self, output: usize) -> &[f64] {
        &self.rows[output]
    }
}

/// The machinery for one model and one set of columns, reusable for any segment and θ.
pub struct Sensitivities<'m> {
    model: &'m Model,
    columns: &'m Columns,
    interpolation: InputInterpolation,
    stages: &'static [Stage],
    stepper: Stepper<'m, f64>,
    dynamics: Evaluator<'m>,
    observation: Evaluator<'m>,
    outputs: OutputEvaluator<'m>,
    /// By stage, then state: values over the block.
    stage_states: Vec<[f64; BLOCK]>,
    /// Time since the start of the segment at each sample of the block.
    elapsed: [f64; BLOCK],
    sensitivity: Recursion,
    output_values: Vec<Vec<f64>>,
    output_rows: Vec<Vec<f64>>,
}

impl<'m> Sensitivities<'m> {
    pub fn new(
        model: &'m Model,
        columns: &'m Columns,
        integrator: Integrator,
        interpolation: InputInterpolation,
    ) -> Self {
        let stages = integrator.stages();
        let output_rows = columns
            .rows
            .iter()
            .map(|row| vec![0.0; BLOCK * row.parameters.len()])
            .collect();
        Self {
            model,
            columns,
            interpolation,
            stages,
            stepper: Stepper::new(model, integrator, interpolation),
            dynamics: Evaluator::new(&model.dynamics_jacobian, stages.len()),
            observation: Evaluator::new(&model.observation_jacobian, 1),
            outputs: OutputEvaluator::new(&model.observation),
            stage_states: vec![[0.0; BLOCK]; stages.len() * model.states.len()],
            elapsed: [0.0; BLOCK],
            sensitivity: Recursion::new(model, columns),
            output_values: vec![vec![0.0; BLOCK]; model.outputs.len()],
            output_rows,
        }
    }

    /// Runs along a segment and hands each block to `sink`. `parameters` are all of the model's, SI.
    ///
    /// # Errors
    /// The state left the range of numbers; blocks before that were handed over.
    pub fn run(
        &mut self,
        segment: &Segment,
        parameters: &[f64],
        mut sink: impl FnMut(&Block<'_>),
    ) -> Result<(), Diverged> {
        self.stepper.set_parameters(parameters);
        self.dynamics.set_parameters(parameters);
        self.observation.set_parameters(parameters);
        self.outputs.set_parameters(parameters);
        let mut state = initial_state(self.model, parameters);
        self.sensitivity.start(self.model, self.columns, parameters);
        let mut elapsed = 0.0;
        for first in (0..segment.len()).step_by(BLOCK) {
            let len = BLOCK.min(segment.len() - first);
            self.integrate(segment, first, len, &mut elapsed, &mut state);
            if state.iter().any(|x| !x.is_finite()) {
                return Err(Diverged {
                    sample: self.first_divergence(first, len),
                });
            }
            self.linearise(segment, first, len);
            for k in 0..len {
                self.form_rows(k);
                if first + k + 1 < segment.len() {
                    self.sensitivity.step(
                        self.stages,
                        segment.steps.length(first + k),
                        k,
                        &self.dynamics,
                    );
                }
            }
            sink(&Block {
                first,
                len,
                outputs: &self.output_values,
                rows: &self.output_rows,
            });
        }
        Ok(())
    }

    /// Pass 1: states at all stages of the block. The state ends at the first sample behind it.
    fn integrate(
        &mut self,
        segment: &Segment,
        first: usize,
        len: usize,
        elapsed: &mut f64,
        state: &mut [f64],
    ) {
        let n = state.len();
        for k in 0..len {
            self.elapsed[k] = *elapsed;
            if first + k + 1 < segment.len() {
                self.stepper.step(segment, first + k, *elapsed, state);
                for (to, &from) in self.stage_states.iter_mut().zip(&self.stepper.stage_states) {
                    to[k] = from;
                }
                *elapsed += segment.steps.length(first + k);
            } else {
                // the last sample has outputs but no step
                for (i, to) in self.stage_states.iter_mut().enumerate() {
                    to[k] = state[i % n.max(1)];
                }
            }
        }
    }

    fn first_divergence(&self, first: usize, len: usize) -> usize {
        let finite = |k: &usize| {
            self.stage_states
                .iter()
                .all(|values| values[*k].is_finite())
        };
        first + (0..len).take_while(finite).count()
    }

    /// Pass 2: outputs and all Jacobians of the block.
    fn linearise(&mut self, segment: &Segment, first: usize, len: usize) {
        let n = self.model.states.len();
        let last = segment.len() - 1;
        for group in (0..len).step_by(LANES) {
            // lanes behind the end repeat the last sample
            let sample = |lane: usize| (first + group + lane).min(last);
            let own = |lane: usize| (group + lane).min(len - 1);
            for (s, stage) in self.stages.iter().enumerate() {
                let share = self.interpolation.share_of_next(stage.node);
                let states = &self.stage_states[s * n..(s + 1) * n];
                let set = |program: &Program, workspace: &mut Workspace<Lanes>| {
                    for (to, values) in program.states(workspace).iter_mut().zip(states) {
                        *to = Lanes(std::array::from_fn(|lane| values[own(lane)]));
                    }
                    for (to, samples) in program.inputs(workspace).iter_mut().zip(&segment.inputs) {
                        *to = Lanes(std::array::from_fn(|lane| {
                            let k = sample(lane);
                            between(samples[k], samples[(k + 1).min(last)], share)
                        }));
                    }
                    *program.time(workspace) = Lanes(std::array::from_fn(|lane| {
                        let k = sample(lane);
                        let step = if k < last {
                            segment.steps.length(k)
                        } else {
                            0.0
                        };
                        self.elapsed[own(lane)] + step * stage.node
                    }));
                };
                self.dynamics.evaluate(s, group, &set);
                if s == 0 {
                    self.observation.evaluate(0, group, &set);
                    self.outputs.evaluate(group, &set, &mut self.output_values);
                }
            }
        }
    }

    /// Pass 3, for one sample: ∂y/∂θ = ∂g/∂x ∂x/∂θ + ∂g/∂θ.
    fn form_rows(&mut self, k: usize) {
        let width = self.columns.dynamic.len();
        for (row, values) in self.columns.rows.iter().zip(&mut self.output_rows) {
            let stride = row.parameters.len();
            values[k * stride..(k + 1) * stride].fill(0.0);
        }
        let jacobian = &self.model.observation_jacobian;
        for (entry, &(output, state)) in jacobian.by_state.iter().enumerate() {
            let stride = self.columns.rows[output].parameters.len();
            let to = &mut self.output_rows[output][k * stride..k * stride + width];
            add_scaled(
                to,
                self.observation.value(0, entry, k),
                self.sensitivity.of_state(state),
            );
        }
        for &(entry, output, place) in &self.sensitivity.observation_places {
            let stride = self.columns.rows[output].parameters.len();
            self.output_rows[output][k * stride + place] += self.observation.value(0, entry, k);
        }
    }
}

/// ∂x/∂θ and its recursion through the stages of the integration scheme.
struct Recursion {
    width: usize,
    states: usize,
    /// By state, then column.
    current: Vec<f64>,
    stage: Vec<f64>,
    slope: Vec<f64>,
    sum: Vec<f64>,
    /// (row, state) of the entries of ∂f/∂x.
    by_state: Vec<(usize, usize)>,
    /// (entry, row, column) of the entries of ∂f/∂θ that belong to a column.
    by_parameter: Vec<(usize, usize, usize)>,
    /// (entry, output, place in the row) of the entries of ∂g/∂θ that belong to a column.
    observation_places: Vec<(usize, usize, usize)>,
}

impl Recursion {
    fn new(model: &Model, columns: &Columns) -> Self {
        let (width, states) = (columns.dynamic.len(), model.states.len());
        let dynamics = &model.dynamics_jacobian;
        let offset = dynamics.by_state.len();
        let by_parameter = (dynamics.by_parameter.iter().enumerate())
            .filter_map(|(entry, &(row, parameter))| {
                let column = columns.dynamic.iter().position(|&p| p == parameter)?;
                Some((offset + entry, row, column))
            })
            .collect();
        let observation = &model.observation_jacobian;
        let offset = observation.by_state.len();
        let observation_places = (observation.by_parameter.iter().enumerate())
            .filter_map(|(entry, &(output, parameter))| {
                let place = columns
                    .of_output(output)
                    .iter()
                    .position(|&p| p == parameter)?;
                Some((offset + entry, output, place))
            })
            .collect();
        let zeros = || vec![0.0; width * states];
        Self {
            width,
            states,
            current: zeros(),
            stage: zeros(),
            slope: zeros(),
            sum: zeros(),
            by_state: dynamics.by_state.clone(),
            by_parameter,
            observation_places,
        }
    }

    /// ∂x0/∂θ.
    fn start(&mut self, model: &Model, columns: &Columns, parameters: &[f64]) {
        let jacobian = &model.initial_jacobian;
        let mut workspace = jacobian.program.workspace::<f64>();
        jacobian.program.set_parameters(&mut workspace, parameters);
        jacobian.program.run(&mut workspace);
        self.current.fill(0.0);
        for (entry, &(state, parameter)) in jacobian.by_parameter.iter().enumerate() {
            if let Some(column) = columns.dynamic.iter().position(|&p| p == parameter) {
                let result = jacobian.by_state.len() + entry;
                self.current[state * self.width + column] =
                    jacobian.program.result(&workspace, result);
            }
        }
    }

    fn of_state(&self, state: usize) -> &[f64] {
        &self.current[state * self.width..(state + 1) * self.width]
    }

    fn step(&mut self, stages: &[Stage], h: f64, k: usize, jacobian: &Evaluator<'_>) {
        let width = self.width;
        self.sum.copy_from_slice(&self.current);
        for (s, stage) in stages.iter().enumerate() {
            self.stage.copy_from_slice(&self.current);
            if s > 0 {
                add_scaled(&mut self.stage, h * stage.advance, &self.slope);
            }
            self.slope.fill(0.0);
            for (entry, &(row, state)) in self.by_state.iter().enumerate() {
                let from = &self.stage[state * width..(state + 1) * width];
                add_scaled(
                    &mut self.slope[row * width..(row + 1) * width],
                    jacobian.value(s, entry, k),
                    from,
                );
            }
            for &(entry, row, column) in &self.by_parameter {
                self.slope[row * width + column] += jacobian.value(s, entry, k);
            }
            add_scaled(&mut self.sum, h * stage.weight, &self.slope);
        }
        debug_assert_eq!(self.sum.len(), self.states * width);
        std::mem::swap(&mut self.current, &mut self.sum);
    }
}

/// to += factor * from
#[inline(always)]
fn add_scaled(to: &mut [f64], factor: f64, from: &[f64]) {
    for (to, &from) in to.iter_mut().zip(from) {
        *to += factor * from;
    }
}

/// A Jacobian's entries over a block, for each of `stages` sets of states.
struct Evaluator<'m> {
    program: &'m Program,
    workspace: Workspace<Lanes>,
    entries: usize,
    /// By stage, then entry: values over the block.
    values: Vec<[f64; BLOCK]>,
}

impl<'m> Evaluator<'m> {
    fn new(jacobian: &'m Jacobian, stages: usize) -> Self {
        let entries = jacobian.program.len();
        Self {
            program: &jacobian.program,
            workspace: jacobian.program.workspace(),
            entries,
            values: vec![[0.0; BLOCK]; stages * entries],
        }
    }

    fn set_parameters(&mut self, parameters: &[f64]) {
        set_lanes(self.program, &mut self.workspace, parameters);
    }

    fn evaluate(
        &mut self,
        stage: usize,
        group: usize,
        set: &impl Fn(&Program, &mut Workspace<Lanes>),
    ) {
        set(self.program, &mut self.workspace);
        self.program.run(&mut self.workspace);
        for entry in 0..self.entries {
            let result = self.program.result(&self.workspace, entry);
            self.values[stage * self.entries + entry][group..group + LANES]
                .copy_from_slice(&result.0);
        }
    }

    #[inline(always)]
    fn value(&self, stage: usize, entry: usize, k: usize) -> f64 {
        self.values[stage * self.entries + entry][k]
    }
}

/// The outputs themselves over a block.
struct OutputEvaluator<'m> {
    program: &'m Program,
    workspace: Workspace<Lanes>,
}

impl<'m> OutputEvaluator<'m> {
    fn new(program: &'m Program) -> Self {
        Self {
            program,
            workspace: program.workspace(),
        }
    }

    fn set_parameters(&mut self, parameters: &[f64]) {
        set_lanes(self.program, &mut self.workspace, parameters);
    }

    fn evaluate(
        &mut self,
        group: usize,
        set: &impl Fn(&Program, &mut Workspace<Lanes>),
        to: &mut [Vec<f64>],
    ) {
        set(self.program, &mut self.workspace);
        self.program.run(&mut self.workspace);
        for (output, to) in to.iter_mut().enumerate() {
            to[group..group + LANES]
                .copy_from_slice(&self.program.result(&self.workspace, output).0);
        }
    }
}

fn set_lanes(program: &Program, workspace: &mut Workspace<Lanes>, parameters: &[f64]) {
    let lanes: Vec<Lanes> = parameters
        .iter()
        .map(|&value| Lanes([value; LANES]))
        .collect();
    program.set_parameters(workspace, &lanes);
}
