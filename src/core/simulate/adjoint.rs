//! Σ_k (∂y_k/∂θ)ᵀ ȳ_k for any ȳ, by the adjoint of the integration scheme itself: one pass forward, one back.
//!
//! With ȳ_k = ∂J/∂y_k this is the gradient of J, at a cost that does not grow with the number of parameters
//! (Machado 2022, section 4.3, there for the Euler scheme). For the stages
//! X_s = x + h advance_s K_(s-1), K_s = f(X_s), x' = x + h Σ weight_s K_s the way back is
//!
//! ```text
//! K̄_s = h weight_s x̄' + h advance_(s+1) X̄_(s+1),   X̄_s = (∂f/∂x)ᵀ K̄_s,   θ̄ += (∂f/∂θ)ᵀ K̄_s
//! x̄ = x̄' + Σ X̄_s + (∂g/∂x)ᵀ ȳ,                    θ̄ += (∂g/∂θ)ᵀ ȳ
//! ```
//!
//! and at the start θ̄ += (∂x0/∂θ)ᵀ x̄. Note that x̄ *gathers*: what an output adds at a sample joins what came
//! back from later ones.
//!
//! States are kept once a block; those between are worked out again on the way back. The Jacobians of a block
//! are evaluated side by side, as those of the forward sensitivities are.

use super::checkpoints::Checkpoints;
use super::method::{InputInterpolation, Integrator, Stage};
use super::refined::Refined;
use super::segment::Segment;
use super::side_by_side::{SPAN, SideBySide};
use super::simulation::{Diverged, initial_state};
use super::stepper::{Stepper, between};
use crate::model::{LANES, Lanes, Model, Program, Workspace};
use crate::stop;

/// The machinery for one model, reusable for any segment, θ and ȳ.
pub(crate) struct Adjoint<'m> {
    pub(super) model: &'m Model,
    pub(super) interpolation: InputInterpolation,
    stages: &'static [Stage],
    stepper: Stepper<'m, f64>,
    dynamics: SideBySide<'m>,
    observation: SideBySide<'m>,
    outputs: SideBySide<'m>,
    /// By stage, then state: values over the block.
    stage_states: Vec<[f64; SPAN]>,
    /// Time since the start of the segment at each sample of the block.
    elapsed: [f64; SPAN],
    /// K̄ by stage, then state: values over the block.
    slopes: Vec<[f64; SPAN]>,
    /// ȳ by output: values over the block.
    seeds: Vec<[f64; SPAN]>,
    /// x̄
    state: Vec<f64>,
    /// K̄ of one stage, X̄ of the stage behind it, and Σ X̄.
    slope: Vec<f64>,
    later_stage: Vec<f64>,
    change: Vec<f64>,
    /// ∂f/∂x where it is the same at all samples; else nothing.
    fixed: Vec<f64>,
}

impl<'m> Adjoint<'m> {
    /// Machinery with room for one block.
    pub(crate) fn new(
        model: &'m Model,
        integrator: Integrator,
        interpolation: InputInterpolation,
    ) -> Self {
        let stages = integrator.stages();
        let n = model.states.len();
        Self {
            model,
            interpolation,
            stages,
            stepper: Stepper::new(model, integrator, interpolation),
            dynamics: SideBySide::new(&model.dynamics_jacobian.program, stages.len()),
            observation: SideBySide::new(&model.observation_jacobian.program, 1),
            outputs: SideBySide::new(&model.observation, 1),
            stage_states: vec![[0.0; SPAN]; stages.len() * n],
            elapsed: [0.0; SPAN],
            slopes: vec![[0.0; SPAN]; stages.len() * n],
            seeds: vec![[0.0; SPAN]; model.outputs.len()],
            state: vec![0.0; n],
            slope: vec![0.0; n],
            later_stage: vec![0.0; n],
            change: vec![0.0; n],
            fixed: Vec::new(),
        }
    }

    /// The way forward along a driven segment, outputs before their paths.
    pub(super) fn advance(
        &mut self,
        segment: &Segment,
        parameters: &[f64],
        mut sink: impl FnMut(usize, &[f64]),
    ) -> Result<Checkpoints, Diverged> {
        let refined = Refined::of(segment, self.interpolation);
        let refined = refined.as_ref();
        let segment = refined.map_or(segment, |refined| &refined.segment);
        self.stepper.set_parameters(parameters);
        self.outputs.set_parameters(parameters);
        let mut state = initial_state(self.model, parameters);
        let mut elapsed = 0.0;
        let mut kept = Checkpoints::default();
        let mut sample = vec![0.0; self.model.outputs.len()];
        for first in (0..segment.len()).step_by(SPAN) {
            stop::check();
            kept.elapsed.push(elapsed);
            kept.states.extend_from_slice(&state);
            let len = SPAN.min(segment.len() - first);
            self.integrate(segment, first, len, &mut elapsed, &mut state);
            if state.iter().any(|x| !x.is_finite()) {
                return Err(Diverged { sample: first }.in_samples(refined));
            }
            self.evaluate(segment, first, len, false);
            for k in 0..len {
                let Some(number) = number(refined, first + k) else {
                    continue;
                };
                for (i, y) in sample.iter_mut().enumerate() {
                    *y = self.outputs.result(0, i)[k];
                }
                sink(number, &sample);
            }
        }
        Ok(kept)
    }

    /// The way back along a driven segment, from outputs before their paths.
    pub(super) fn step_back_along(
        &mut self,
        segment: &Segment,
        parameters: &[f64],
        checkpoints: &Checkpoints,
        mut seed: impl FnMut(usize, &[f64], &mut [f64]),
        gradient: &mut [f64],
    ) {
        let n = self.model.states.len();
        let refined = Refined::of(segment, self.interpolation);
        let refined = refined.as_ref();
        let segment = refined.map_or(segment, |refined| &refined.segment);
        self.stepper.set_parameters(parameters);
        self.dynamics.set_parameters(parameters);
        self.observation.set_parameters(parameters);
        self.outputs.set_parameters(parameters);
        self.state.fill(0.0);
        let entries = 0..self.model.dynamics_jacobian.by_state.len();
        self.fixed.clear();
        if entries.clone().all(|i| !self.dynamics.varies(i)) {
            self.fixed
                .extend(entries.map(|i| self.dynamics.result(0, i)[0]));
        }
        let outputs = self.model.outputs.len();
        let (mut y, mut y_bar) = (vec![0.0; outputs], vec![0.0; outputs]);
        for (block, &since) in checkpoints.elapsed.iter().enumerate().rev() {
            stop::check();
            let first = block * SPAN;
            let len = SPAN.min(segment.len() - first);
            let mut state = checkpoints.states[block * n..(block + 1) * n].to_vec();
            let mut elapsed = since;
            self.integrate(segment, first, len, &mut elapsed, &mut state);
            self.evaluate(segment, first, len, true);
            for k in 0..len {
                match number(refined, first + k) {
                    Some(number) => {
                        for (i, y) in y.iter_mut().enumerate() {
                            *y = self.outputs.result(0, i)[k];
                        }
                        seed(number, &y, &mut y_bar);
                    }
                    // nothing is measured between samples
                    None => y_bar.fill(0.0),
                }
                for (to, &value) in self.seeds.iter_mut().zip(&y_bar) {
                    to[k] = value;
                }
            }
            for k in (0..len).rev() {
                self.step_back(segment, first, k);
            }
            self.gather(len, gradient);
        }
        let initial = &self.model.initial_jacobian;
        let mut workspace = initial.program.workspace::<f64>();
        initial.program.set_parameters(&mut workspace, parameters);
        initial.program.run(&mut workspace);
        for (i, &(row, parameter)) in initial.by_parameter.iter().enumerate() {
            let entry = initial
                .program
                .result(&workspace, initial.by_state.len() + i);
            gradient[parameter] += entry * self.state[row];
        }
    }

    /// x̄ at sample `k` of the block from x̄ at the next one; K̄ of the step between are kept.
    fn step_back(&mut self, segment: &Segment, first: usize, k: usize) {
        if first + k + 1 < segment.len() {
            let h = segment.steps.length(first + k);
            let n = self.state.len();
            self.later_stage.fill(0.0);
            self.change.fill(0.0);
            for (s, stage) in self.stages.iter().enumerate().rev() {
                let advance = self.stages.get(s + 1).map_or(0.0, |later| later.advance);
                for i in 0..n {
                    self.slope[i] =
                        h * (stage.weight * self.state[i] + advance * self.later_stage[i]);
                    self.slopes[s * n + i][k] = self.slope[i];
                }
                let own = &mut self.later_stage;
                own.fill(0.0);
                let entries = &self.model.dynamics_jacobian.by_state;
                if self.fixed.is_empty() {
                    for (entry, &(row, column)) in entries.iter().enumerate() {
                        own[column] += self.dynamics.result(s, entry)[k] * self.slope[row];
                    }
                } else {
                    for (value, &(row, column)) in self.fixed.iter().zip(entries) {
                        own[column] += value * self.slope[row];
                    }
                }
                self.change
                    .iter_mut()
                    .zip(own)
                    .for_each(|(sum, own)| *sum += *own);
            }
            for (x, change) in self.state.iter_mut().zip(&self.change) {
                *x += change;
            }
        } else {
            // the last sample has outputs but no step
            self.slopes.iter_mut().for_each(|slopes| slopes[k] = 0.0);
        }
        let observed = &self.model.observation_jacobian.by_state;
        for (entry, &(output, state)) in observed.iter().enumerate() {
            self.state[state] += self.observation.result(0, entry)[k] * self.seeds[output][k];
        }
    }

    /// What the block adds to θ̄: vectors over samples.
    fn gather(&self, len: usize, gradient: &mut [f64]) {
        let n = self.state.len();
        let dynamics = &self.model.dynamics_jacobian;
        for (i, &(row, parameter)) in dynamics.by_parameter.iter().enumerate() {
            for s in 0..self.stages.len() {
                let entry = self.dynamics.result(s, dynamics.by_state.len() + i);
                gradient[parameter] += dot(&entry[..len], &self.slopes[s * n + row][..len]);
            }
        }
        let observation = &self.model.observation_jacobian;
        for (i, &(output, parameter)) in observation.by_parameter.iter().enumerate() {
            let entry = self.observation.result(0, observation.by_state.len() + i);
            gradient[parameter] += dot(&entry[..len], &self.seeds[output][..len]);
        }
    }

    /// States at all stages of the block. The state ends at the first sample behind it.
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
                for (i, to) in self.stage_states.iter_mut().enumerate() {
                    to[k] = state[i % n];
                }
            }
        }
    }

    /// Outputs of the block, and with `jacobians` all its Jacobians.
    fn evaluate(&mut self, segment: &Segment, first: usize, len: usize, jacobians: bool) {
        let n = self.model.states.len();
        let last = segment.len() - 1;
        let stages = if jacobians {
            self.stages
        } else {
            &self.stages[..1]
        };
        for group in (0..len).step_by(LANES) {
            // lanes behind the end repeat the last sample
            let own = |lane: usize| (group + lane).min(len - 1);
            for (s, stage) in stages.iter().enumerate() {
                let share = self.interpolation.share_of_next(stage.node);
                let states = &self.stage_states[s * n..(s + 1) * n];
                let set = |program: &Program, workspace: &mut Workspace<Lanes>| {
                    for (to, values) in program.states(workspace).iter_mut().zip(states) {
                        *to = Lanes(std::array::from_fn(|lane| values[own(lane)]));
                    }
                    for (to, samples) in program.inputs(workspace).iter_mut().zip(&segment.inputs) {
                        *to = Lanes(std::array::from_fn(|lane| {
                            let k = first + own(lane);
                            between(samples[k], samples[(k + 1).min(last)], share)
                        }));
                    }
                    *program.time(workspace) = Lanes(std::array::from_fn(|lane| {
                        let k = own(lane);
                        let step = if first + k < last {
                            segment.steps.length(first + k)
                        } else {
                            0.0
                        };
                        self.elapsed[k] + step * stage.node
                    }));
                };
                if jacobians {
                    self.dynamics.evaluate(s, group, &set);
                }
                if s == 0 {
                    self.outputs.evaluate(0, group, &set);
                    if jacobians {
                        self.observation.evaluate(0, group, &set);
                    }
                }
            }
        }
    }

    /// Bytes of the block, without the checkpoints.
    pub(crate) fn bytes(&self) -> usize {
        let own = [&self.stage_states, &self.slopes, &self.seeds];
        let own: usize = own.iter().map(|all| size_of_val(all.as_slice())).sum();
        own + self.dynamics.bytes() + self.observation.bytes() + self.outputs.bytes()
    }
}

/// The recorded sample that an integration step begins at, where there is one.
fn number(refined: Option<&Refined>, step: usize) -> Option<usize> {
    match refined {
        Some(refined) => refined.sample(step),
        None => Some(step),
    }
}

/// Σ a b, in eight sums side by side.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (chunks_a, chunks_b) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = (chunks_a.remainder().iter().zip(chunks_b.remainder()))
        .map(|(a, b)| a * b)
        .sum();
    for (a, b) in chunks_a.zip(chunks_b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    rest + sums.iter().sum::<f64>()
}
