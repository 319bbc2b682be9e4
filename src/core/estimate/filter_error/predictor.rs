//! One-step predictions along a segment, and their sensitivities.
//!
//! y_k = g(x_k, u_k), e_k = z_k - y_k, x_(k+1) = Φ(x_k + K e_k), Φ the way to the next sample by the integrator. The derivative is that of
//! this recursion, exact but for rounding: ∂x⁺ = ∂x + ∂K e - K ∂y, then through each stage of the step.

use nalgebra::DMatrix;

use super::gain::{Change, Gain};
use super::layout::Column;
use crate::estimate::problem::Problem;
use crate::estimate::problem::missing::present;
use crate::model::{Jacobian, Model, Program, Workspace};
use crate::simulate::{Segment, Stepper, between, initial_state};
use crate::stop;

/// One sample.
pub(super) struct Predicted<'a> {
    pub sample: usize,
    /// By output.
    pub outputs: &'a [f64],
    /// z - y by output; 0 where nothing was measured.
    pub innovations: &'a [f64],
    /// ∂y by output, then column; rows of outputs that were not measured are 0.
    pub slopes: &'a [f64],
}

/// The machinery for one model, reusable for any segment and any unknowns.
pub(super) struct Predictor<'p> {
    problem: &'p Problem,
    stepper: Stepper<'p, f64>,
    observation: Workspace<f64>,
    dynamics_slopes: Workspace<f64>,
    observation_slopes: Workspace<f64>,
}

impl<'p> Predictor<'p> {
    pub(super) fn new(problem: &'p Problem) -> Self {
        let model = &problem.model;
        let options = &problem.options;
        Self {
            problem,
            stepper: Stepper::new(model, options.integrator, options.input_interpolation),
            observation: model.observation.workspace(),
            dynamics_slopes: model.dynamics_jacobian.program.workspace(),
            observation_slopes: model.observation_jacobian.program.workspace(),
        }
    }

    /// Predicts a segment sample by sample. Without `columns` there are no slopes.
    pub(super) fn run(
        &mut self,
        segment: &Segment,
        parameters: &[f64],
        gain: &Gain,
        (columns, changes): (&[Column], &[Change]),
        mut sink: impl FnMut(&Predicted<'_>),
    ) {
        let model = &self.problem.model;
        self.set_parameters(parameters, columns.len());
        let mut sample = Sample::new(model.outputs.len(), columns.len());
        let mut state = initial_state(model, parameters);
        let mut tangent = Tangent::new(model, columns, parameters);
        let mut elapsed = 0.0;
        for k in 0..segment.len() {
            stop::check();
            self.observe(segment, (k, elapsed), &state, &tangent, &mut sample);
            sink(&Predicted {
                sample: k,
                outputs: &sample.outputs,
                innovations: &sample.innovations,
                slopes: &sample.slopes,
            });
            if k + 1 == segment.len() {
                break;
            }
            correct(&mut state, gain, &sample.innovations);
            tangent.correct(&gain.k, changes, &sample.innovations, &sample.slopes);
            let count = segment.substeps.within(segment.steps.length(k));
            for part in 0..count {
                let part = (part, count);
                self.stepper.part(segment, k, part, elapsed, &mut state);
                self.propagate(segment, (k, elapsed), part, &mut tangent);
            }
            elapsed += segment.steps.length(k);
        }
    }

    fn set_parameters(&mut self, parameters: &[f64], width: usize) {
        let model = &self.problem.model;
        self.stepper.set_parameters(parameters);
        model
            .observation
            .set_parameters(&mut self.observation, parameters);
        if width > 0 {
            let set = |jacobian: &Jacobian, workspace: &mut Workspace<f64>| {
                jacobian.program.set_parameters(workspace, parameters);
            };
            set(&model.dynamics_jacobian, &mut self.dynamics_slopes);
            set(&model.observation_jacobian, &mut self.observation_slopes);
        }
    }

    /// Outputs, innovations and their slopes at sample `k`.
    fn observe(
        &mut self,
        segment: &Segment,
        (k, elapsed): (usize, f64),
        state: &[f64],
        tangent: &Tangent,
        to: &mut Sample,
    ) {
        let model = &self.problem.model;
        let at = &mut self.observation;
        place(&model.observation, at, state, segment, (k, 0.0), elapsed);
        model.observation.run(at);
        model.observation.results(at, &mut to.outputs);
        let pairs = to.innovations.iter_mut().zip(&to.outputs);
        for ((innovation, y), measured) in pairs.zip(&segment.measured) {
            let z = measured[k];
            *innovation = present(z - y, z);
        }
        if tangent.width == 0 {
            return;
        }
        let program = &model.observation_jacobian.program;
        let at = &mut self.observation_slopes;
        place(program, at, state, segment, (k, 0.0), elapsed);
        program.run(at);
        tangent.observe(&model.observation_jacobian, at, &mut to.slopes);
        let rows = to.slopes.chunks_exact_mut(tangent.width);
        for (row, measured) in rows.zip(&segment.measured) {
            if measured[k].is_nan() {
                row.fill(0.0);
            }
        }
    }

    /// Takes the tangent through the stages of the step that the stepper has just made, one of the `count` from sample
    /// `k` to the next.
    fn propagate(
        &mut self,
        segment: &Segment,
        (k, elapsed): (usize, f64),
        (part, count): (usize, usize),
        tangent: &mut Tangent,
    ) {
        if tangent.width == 0 {
            return;
        }
        let model = &self.problem.model;
        let states = model.states.len();
        let h = segment.steps.length(k) / count as f64;
        let elapsed = elapsed + h * part as f64;
        let program = &model.dynamics_jacobian.program;
        tangent.begin_step();
        for (s, stage) in self.stepper.stages.iter().enumerate() {
            let at = &self.stepper.stage_states[s * states..(s + 1) * states];
            let node = (part as f64 + stage.node) / count as f64;
            let share = self.stepper.interpolation.share_of_next(node);
            let workspace = &mut self.dynamics_slopes;
            let time = elapsed + h * stage.node;
            place(program, workspace, at, segment, (k, share), time);
            program.run(workspace);
            let lengths = (h * stage.advance, h * stage.weight);
            tangent.stage(&model.dynamics_jacobian, workspace, s, lengths);
        }
        tangent.end_step();
    }
}

/// What is known at one sample; see [`Predicted`].
struct Sample {
    outputs: Vec<f64>,
    innovations: Vec<f64>,
    slopes: Vec<f64>,
}

impl Sample {
    fn new(outputs: usize, width: usize) -> Self {
        Self {
            outputs: vec![0.0; outputs],
            innovations: vec![0.0; outputs],
            slopes: vec![0.0; outputs * width],
        }
    }
}

/// x += K e
fn correct(state: &mut [f64], gain: &Gain, innovations: &[f64]) {
    for (i, x) in state.iter_mut().enumerate() {
        *x += (innovations.iter().enumerate())
            .map(|(j, e)| gain.k[(i, j)] * e)
            .sum::<f64>();
    }
}

/// Puts state, inputs and time in place, `share` of the way from sample `k` to the next.
fn place(
    program: &Program,
    workspace: &mut Workspace<f64>,
    state: &[f64],
    segment: &Segment,
    (k, share): (usize, f64),
    time: f64,
) {
    program.states(workspace).copy_from_slice(state);
    let last = segment.len() - 1;
    for (to, samples) in program.inputs(workspace).iter_mut().zip(&segment.inputs) {
        *to = between(samples[k], samples[(k + 1).min(last)], share);
    }
    *program.time(workspace) = time;
}

/// ∂x by the columns, row by state.
struct Tangent {
    width: usize,
    /// By parameter of the model: its column.
    column: Vec<Option<usize>>,
    current: Vec<f64>,
    stage: Vec<f64>,
    slope: Vec<f64>,
    sum: Vec<f64>,
}

impl Tangent {
    /// Begins with ∂x0/∂θ.
    fn new(model: &Model, columns: &[Column], parameters: &[f64]) -> Self {
        let width = columns.len();
        let mut column = vec![None; model.parameters.len()];
        for (index, kind) in columns.iter().enumerate() {
            if let Column::Parameter(parameter) = *kind {
                column[parameter] = Some(index);
            }
        }
        let zeros = vec![0.0; model.states.len() * width];
        let mut tangent = Self {
            width,
            column,
            current: zeros.clone(),
            stage: zeros.clone(),
            slope: zeros.clone(),
            sum: zeros,
        };
        if width > 0 {
            let jacobian = &model.initial_jacobian;
            let mut workspace = jacobian.program.workspace();
            jacobian.program.set_parameters(&mut workspace, parameters);
            jacobian.program.run(&mut workspace);
            jacobian.add_by_parameter(&workspace, &tangent.column, width, &mut tangent.current);
        }
        tangent
    }

    /// ∂y = ∂g/∂x ∂x + ∂g/∂θ.
    fn observe(&self, jacobian: &Jacobian, at: &Workspace<f64>, slopes: &mut [f64]) {
        slopes.fill(0.0);
        jacobian.add_by_state(at, self.width, &self.current, slopes);
        jacobian.add_by_parameter(at, &self.column, self.width, slopes);
    }

    /// ∂x += ∂K e - K ∂y
    fn correct(&mut self, k: &DMatrix<f64>, changes: &[Change], e: &[f64], slopes: &[f64]) {
        let width = self.width;
        if width == 0 {
            return;
        }
        for (i, row) in self.current.chunks_exact_mut(width).enumerate() {
            for (j, &innovation) in e.iter().enumerate() {
                let slopes = &slopes[j * width..(j + 1) * width];
                let gain = k[(i, j)];
                for ((to, change), slope) in row.iter_mut().zip(changes).zip(slopes) {
                    *to += change.k[(i, j)] * innovation - gain * slope;
                }
            }
        }
    }

    fn begin_step(&mut self) {
        self.sum.copy_from_slice(&self.current);
    }

    fn stage(
        &mut self,
        jacobian: &Jacobian,
        at: &Workspace<f64>,
        s: usize,
        (advance, weight): (f64, f64),
    ) {
        if s == 0 {
            self.stage.copy_from_slice(&self.current);
        } else {
            for ((to, from), slope) in self.stage.iter_mut().zip(&self.current).zip(&self.slope) {
                *to = from + advance * slope;
            }
        }
        self.slope.fill(0.0);
        jacobian.add_by_state(at, self.width, &self.stage, &mut self.slope);
        jacobian.add_by_parameter(at, &self.column, self.width, &mut self.slope);
        for (sum, slope) in self.sum.iter_mut().zip(&self.slope) {
            *sum += weight * slope;
        }
    }

    fn end_step(&mut self) {
        std::mem::swap(&mut self.current, &mut self.sum);
    }
}
