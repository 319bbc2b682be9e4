//! Outputs and their sensitivities ∂y/∂θ, by forward sensitivities of the integration scheme itself.
//!
//! The trajectory is sequential in time, its Jacobians are not. A block of samples is done in three passes:
//! 1. integrate the states, keeping every stage state (sequential, scalar);
//! 2. evaluate ∂f/∂x, ∂f/∂θ at all stages and g, ∂g/∂x, ∂g/∂θ at all samples (side by side, [`LANES`] at a time);
//! 3. run the recursion of ∂x/∂θ and form the rows of ∂y/∂θ (sequential, vectors over parameters).
//!
//! The derivative is that of the discretised model, exact but for rounding. Memory does not grow with the
//! length of the recording.

use super::columns::Columns;
use super::delay_line::DelayLine;
use super::delayed_inputs::driven;
use super::linearised::{BLOCK, Linearised};
use super::method::{InputInterpolation, Integrator, Stage};
use super::pack::{Pack, packs};
use super::recursion::{Recursion, Sweep, sweep};
use super::segment::Segment;
use super::stepper::{Stepper, between};
use super::trajectory::{Diverged, initial_state};
use crate::model::{LANES, Lanes, Model, Program, Workspace};

/// Outputs and sensitivities of some consecutive samples.
pub struct Block<'a> {
    /// Index of the first sample.
    pub first: usize,
    pub len: usize,
    /// By output.
    pub(super) outputs: &'a [[f64; BLOCK]],
    pub(super) columns: &'a Columns,
    pub(super) rows: &'a [Vec<Pack>],
}

impl Block<'_> {
    /// y of one output, sample by sample.
    pub fn output(&self, output: usize) -> &[f64] {
        &self.outputs[output][..self.len]
    }

    /// ∂y/∂θ of one output at sample `k` of the block, in the order of [`Columns::of_output`].
    pub fn row(&self, output: usize, k: usize) -> &[f64] {
        let width = self.columns.of_output(output).len();
        let stride = packs(width);
        &self.rows[output][k * stride..(k + 1) * stride].as_flattened()[..width]
    }

    /// All rows of one output, each padded with zeros to whole packs.
    pub fn packed_rows(&self, output: usize) -> &[Pack] {
        let stride = packs(self.columns.of_output(output).len());
        &self.rows[output][..self.len * stride]
    }
}

/// The machinery for one model and one set of columns, reusable for any segment and θ.
pub struct Sensitivities<'m> {
    model: &'m Model,
    columns: &'m Columns,
    interpolation: InputInterpolation,
    stages: &'static [Stage],
    stepper: Stepper<'m, f64>,
    dynamics: Linearised<'m>,
    observation: Linearised<'m>,
    outputs: Linearised<'m>,
    recursion: Recursion,
    /// By stage, then state: values over the block.
    stage_states: Vec<[f64; BLOCK]>,
    /// Time since the start of the segment at each sample of the block.
    elapsed: [f64; BLOCK],
    /// By output: rows of ∂y/∂θ over the block.
    rows: Vec<Vec<Pack>>,
    /// Where outputs are delayed.
    delay_line: Option<DelayLine<'m>>,
}

impl<'m> Sensitivities<'m> {
    pub fn new(
        model: &'m Model,
        columns: &'m Columns,
        integrator: Integrator,
        interpolation: InputInterpolation,
    ) -> Self {
        let stages = integrator.stages();
        let rows =
            |output: usize| vec![Pack::default(); BLOCK * packs(columns.of_output(output).len())];
        Self {
            model,
            columns,
            interpolation,
            stages,
            stepper: Stepper::new(model, integrator, interpolation),
            dynamics: Linearised::new(&model.dynamics_jacobian.program, stages.len()),
            observation: Linearised::new(&model.observation_jacobian.program, 1),
            outputs: Linearised::new(&model.observation, 1),
            recursion: Recursion::new(model, columns, stages.len()),
            stage_states: vec![[0.0; BLOCK]; stages.len() * model.states.len()],
            elapsed: [0.0; BLOCK],
            rows: (0..columns.outputs()).map(rows).collect(),
            delay_line: DelayLine::new(model, columns),
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
        let delays = self.model.delays.at(parameters);
        let driven = driven(self.model, segment, &delays);
        let segment = &*driven;
        if let Some(line) = &mut self.delay_line {
            line.start(segment, parameters, &delays);
        }
        self.stepper.set_parameters(parameters);
        self.dynamics.set_parameters(parameters);
        self.observation.set_parameters(parameters);
        self.outputs.set_parameters(parameters);
        let mut state = initial_state(self.model, parameters);
        self.recursion.start(self.model, self.columns, parameters);
        let stages = self.stages.len();
        self.recursion
            .place(true, stages, &self.dynamics, &self.observation);
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
            self.recursion
                .place(false, stages, &self.dynamics, &self.observation);
            let block = Sweep {
                stages: self.stages,
                steps: &segment.steps,
                first,
                len,
                last: segment.len() - 1,
                dynamics: &self.dynamics,
                observation: &self.observation,
            };
            sweep(&block, &mut self.recursion, &mut self.rows);
            let block = Block {
                first,
                len,
                outputs: self.outputs.all_over_block(0),
                columns: self.columns,
                rows: &self.rows,
            };
            match &mut self.delay_line {
                Some(line) => line.pass(&block, &mut sink),
                None => sink(&block),
            }
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
                    self.outputs.evaluate(0, group, &set);
                }
            }
        }
    }
}
