//! The states along a segment, a block of samples at a time: sequential, and what all else is built on.

use multiversion::multiversion;

use super::aligned::Aligned;
use super::method::{InputInterpolation, Integrator, Stage};
use super::one_step::{MOST_STATES, OneStep, Stride};
use super::segment::{Segment, Steps};
use super::simulation::{Diverged, initial_state};
use super::stepper::{Stepper, between};
use crate::model::{BLOCK, LANES, Lanes, Model, Program, StepBlock, Workspace};
use crate::stop;

/// The trajectory of a model along a segment: states, inputs and times at the samples of a block.
pub(super) struct Trajectory<'m> {
    model: &'m Model,
    interpolation: InputInterpolation,
    pub stages: &'static [Stage],
    stepper: Stepper<'m, f64>,
    one_step: Option<OneStep<'m>>,
    /// The way from sample to sample, where one matrix serves the whole segment.
    stride: Option<Stride>,
    /// The state at the first sample behind the block.
    state: Vec<f64>,
    elapsed: f64,
    /// By stage, then state: values over the block. Values behind the end repeat the last.
    pub stage_states: Aligned<[f64; BLOCK]>,
    /// By stage: its weight, and how far the next one goes.
    shares: Vec<[f64; 2]>,
    /// Lengths of the steps of the block, s.
    lengths: [f64; BLOCK],
    /// By stage, then input.
    stage_inputs: Aligned<[f64; BLOCK]>,
    /// By stage: time since the start of the segment.
    stage_times: Aligned<[f64; BLOCK]>,
}

impl<'m> Trajectory<'m> {
    pub(super) fn new(
        model: &'m Model,
        integrator: Integrator,
        interpolation: InputInterpolation,
    ) -> Self {
        let stages = integrator.stages();
        let shares = stages.iter().enumerate().map(|(s, stage)| {
            let next = stages.get(s + 1).map_or(0.0, |next| next.advance);
            [stage.weight, next]
        });
        let over_block = |count: usize| Aligned::zeros(stages.len() * count);
        Self {
            model,
            interpolation,
            stages,
            stepper: Stepper::new(model, integrator, interpolation),
            one_step: OneStep::of(model),
            stride: None,
            state: Vec::new(),
            elapsed: 0.0,
            shares: shares.collect(),
            lengths: [0.0; BLOCK],
            stage_states: over_block(model.states.len()),
            stage_inputs: over_block(model.driven_inputs()),
            stage_times: over_block(1),
        }
    }

    /// Goes to the first sample of a segment. `parameters` are all of the model's, SI.
    pub(super) fn start(&mut self, segment: &Segment, parameters: &[f64]) {
        self.state = initial_state(self.model, parameters);
        self.elapsed = 0.0;
        self.stride = self.stride_of(segment);
        if let (Some(one_step), Some(stride)) = (&mut self.one_step, &self.stride) {
            one_step.set(parameters, stride);
        } else {
            self.stepper.set_parameters(parameters);
        }
    }

    /// The way from sample to sample of a segment, if one matrix serves all of it: the segment then need not be refined.
    pub(super) fn stride_of(&self, segment: &Segment) -> Option<Stride> {
        match (&self.one_step, &segment.steps) {
            (Some(_), &Steps::Even(length)) => Some(Stride {
                length,
                count: segment.substeps.within(length),
                stages: self.stages,
                interpolation: self.interpolation,
            }),
            _ => None,
        }
    }

    /// The one-step map of the segment, if one serves all of it.
    pub(super) fn one_step(&self) -> Option<(&OneStep<'m>, &Stride)> {
        self.one_step.as_ref().zip(self.stride.as_ref())
    }

    /// The state at the first sample of the block.
    pub(super) fn first_state(&self) -> Vec<f64> {
        let states = self.stage_states[..self.state.len()].iter();
        states.map(|values| values[0]).collect()
    }

    pub(super) fn interpolation(&self) -> InputInterpolation {
        self.interpolation
    }

    /// Stages whose states, inputs and times are known at each sample.
    fn known_stages(&self) -> usize {
        if self.stride.is_some() {
            1
        } else {
            self.stages.len()
        }
    }

    /// The next block.
    ///
    /// # Errors
    /// The state leaves the range of numbers.
    pub(super) fn advance(
        &mut self,
        segment: &Segment,
        first: usize,
        len: usize,
    ) -> Result<(), Diverged> {
        stop::check();
        self.place_inputs(segment, first, len);
        if let Some(stride) = self.stride {
            self.multiply(segment, first, len, stride.length);
        } else {
            self.integrate(segment, first, len);
        }
        if self.state.iter().all(|x| x.is_finite()) {
            return Ok(());
        }
        let known = self.known_stages() * self.state.len();
        let finite = |k: &usize| {
            self.stage_states[..known]
                .iter()
                .all(|values| values[*k].is_finite())
        };
        Err(Diverged {
            sample: first + (0..len).take_while(finite).count(),
        })
    }

    /// Puts states, inputs and times of `LANES` samples from `group` on into a program's registers.
    pub(super) fn place(
        &self,
        stage: usize,
        group: usize,
        program: &Program,
        workspace: &mut Workspace<Lanes>,
    ) {
        let lanes = |values: &[f64; BLOCK]| {
            let mut lanes = Lanes([0.0; LANES]);
            lanes.0.copy_from_slice(&values[group..group + LANES]);
            lanes
        };
        let (states, inputs) = (self.model.states.len(), self.model.driven_inputs());
        let from = &self.stage_states[stage * states..(stage + 1) * states];
        for (to, values) in program.states(workspace).iter_mut().zip(from) {
            *to = lanes(values);
        }
        let from = &self.stage_inputs[stage * inputs..(stage + 1) * inputs];
        for (to, values) in program.inputs(workspace).iter_mut().zip(from) {
            *to = lanes(values);
        }
        *program.time(workspace) = lanes(&self.stage_times[stage]);
    }

    fn place_inputs(&mut self, segment: &Segment, first: usize, len: usize) {
        let last = segment.len() - 1;
        let count = segment.inputs.len();
        for (s, stage) in self.stages[..self.known_stages()].iter().enumerate() {
            let share = self.interpolation.share_of_next(stage.node);
            for (to, samples) in self.stage_inputs[s * count..(s + 1) * count]
                .iter_mut()
                .zip(&segment.inputs)
            {
                let steps = len.min(last - first);
                let next = &samples[first + 1..];
                for ((to, &now), &next) in to[..steps].iter_mut().zip(&samples[first..]).zip(next) {
                    *to = between(now, next, share);
                }
                to[steps..].fill(samples[first + len - 1]);
            }
        }
    }

    /// States at all stages, by the integrator.
    fn integrate(&mut self, segment: &Segment, first: usize, len: usize) {
        let n = self.state.len();
        let steps = len.min(segment.len() - 1 - first);
        let since = self.elapsed;
        for k in 0..len {
            // the last sample has outputs but no step
            let h = if k < steps {
                segment.steps.length(first + k)
            } else {
                0.0
            };
            self.lengths[k] = h;
            for (to, stage) in self.stage_times.iter_mut().zip(self.stages) {
                to[k] = self.elapsed + h * stage.node;
            }
            self.elapsed += h;
        }
        if let Some(native) = self.model.native(steps, self.stages.len()) {
            let mut steps_to_take = StepBlock {
                stages: &self.shares,
                lengths: &self.lengths[..steps],
                inputs: &self.stage_inputs,
                times: &self.stage_times,
                stage_states: &mut self.stage_states,
                state: &mut self.state,
            };
            native.take(self.stepper.workspace(), &mut steps_to_take);
        } else {
            let mut elapsed = since;
            for k in 0..steps {
                self.stepper
                    .step(segment, first + k, elapsed, &mut self.state);
                for (to, &from) in self.stage_states.iter_mut().zip(&self.stepper.stage_states) {
                    to[k] = from;
                }
                elapsed += self.lengths[k];
            }
        }
        if steps < len {
            for (i, to) in self.stage_states.iter_mut().enumerate() {
                to[steps] = self.state[i % n];
            }
        }
        for values in self.stage_states.iter_mut().chain(&mut *self.stage_times) {
            let last = values[len - 1];
            values[len..].fill(last);
        }
    }

    /// States at the samples, by the one-step map.
    fn multiply(&mut self, segment: &Segment, first: usize, len: usize, h: f64) {
        let Some(one_step) = &self.one_step else {
            return;
        };
        let steps = len.min(segment.len() - 1 - first);
        let n = self.state.len();
        march(
            one_step.matrix(),
            &segment.inputs,
            first,
            (len, steps),
            &mut self.state,
            &mut self.stage_states[..n],
        );
        for to in &mut self.stage_times[0][..len] {
            *to = self.elapsed;
            self.elapsed += h;
        }
        for values in self.stage_states[..n]
            .iter_mut()
            .chain(&mut self.stage_times[..1])
        {
            let last = values[len - 1];
            values[len..].fill(last);
        }
    }
}

/// x(k+1) = M (x(k), u(k), u(k+1), 1) over `steps` of the `len` samples from `first` on.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn march(
    matrix: &[f64],
    inputs: &[Vec<f64>],
    first: usize,
    (len, steps): (usize, usize),
    state: &mut [f64],
    states: &mut [[f64; BLOCK]],
) {
    let (n, m) = (state.len(), inputs.len());
    let factors = n + 2 * m + 1;
    // what drives each state does not depend on the states: all samples side by side
    for (row, driven) in matrix.chunks_exact(factors).zip(states.iter_mut()) {
        driven.fill(row[factors - 1]);
        for (j, samples) in inputs.iter().enumerate() {
            let (now, next) = (&samples[first..first + steps], &samples[first + 1..]);
            for ((to, &now), &next) in driven.iter_mut().zip(now).zip(next) {
                *to = row[n + j].mul_add(now, row[n + m + j].mul_add(next, *to));
            }
        }
    }
    match n {
        1 => march_states::<1>(matrix, (len, steps), state, states),
        2 => march_states::<2>(matrix, (len, steps), state, states),
        3 => march_states::<3>(matrix, (len, steps), state, states),
        4 => march_states::<4>(matrix, (len, steps), state, states),
        5 => march_states::<5>(matrix, (len, steps), state, states),
        _ => march_states::<MOST_STATES>(matrix, (len, steps), state, states),
    }
}

/// For a number of states that is known beforehand, so that they stay in registers. What drives them stands in `states`.
#[inline(always)]
fn march_states<const STATES: usize>(
    matrix: &[f64],
    (len, steps): (usize, usize),
    state: &mut [f64],
    states: &mut [[f64; BLOCK]],
) {
    let factors = matrix.len() / STATES;
    let transition: [[f64; STATES]; STATES] =
        std::array::from_fn(|i| std::array::from_fn(|j| matrix[i * factors + j]));
    let (Some(state), Some(states)) = (
        state.first_chunk_mut::<STATES>(),
        states.first_chunk_mut::<STATES>(),
    ) else {
        return;
    };
    let mut now = *state;
    for k in 0..len.min(BLOCK) {
        let mut next = now;
        for (i, values) in states.iter_mut().enumerate() {
            next[i] = values[k];
            for j in 0..STATES {
                next[i] = transition[i][j].mul_add(now[j], next[i]);
            }
            values[k] = now[i];
        }
        if k < steps {
            now = next;
        }
    }
    *state = now;
}
