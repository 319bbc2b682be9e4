//! One integration step, for any kind of number.

use super::method::{InputInterpolation, Integrator, Stage};
use super::segment::Segment;
use crate::model::{Model, Program, Scalar, Workspace};

/// Steps the state of a model along a segment and keeps the states at which f was evaluated.
pub(crate) struct Stepper<'m, T> {
    dynamics: &'m Program,
    workspace: Workspace<T>,
    pub stages: &'static [Stage],
    pub interpolation: InputInterpolation,
    /// Stage states X_s of the last step, stage by stage.
    pub stage_states: Vec<T>,
    slope: Vec<T>,
    sum: Vec<T>,
}

impl<'m, T: Scalar> Stepper<'m, T> {
    pub(crate) fn new(
        model: &'m Model,
        integrator: Integrator,
        interpolation: InputInterpolation,
    ) -> Self {
        let states = model.states.len();
        let stages = integrator.stages();
        let zero = T::from_f64(0.0);
        Self {
            dynamics: &model.dynamics,
            workspace: model.dynamics.workspace(),
            stages,
            interpolation,
            stage_states: vec![zero; states * stages.len()],
            slope: vec![zero; states],
            sum: vec![zero; states],
        }
    }

    pub(crate) fn set_parameters(&mut self, parameters: &[T]) {
        self.dynamics
            .set_parameters(&mut self.workspace, parameters);
    }

    /// The registers of f, with θ in place.
    pub(super) fn workspace(&self) -> &Workspace<T> {
        &self.workspace
    }

    /// From sample `k`, at `elapsed` seconds since the start, to the next.
    pub(crate) fn step(&mut self, segment: &Segment, k: usize, elapsed: f64, state: &mut [T]) {
        let n = state.len();
        let h = segment.steps.length(k);
        self.sum.fill(T::from_f64(0.0));
        for (s, stage) in self.stages.iter().enumerate() {
            let at = &mut self.stage_states[s * n..(s + 1) * n];
            let advance = T::from_f64(h * stage.advance);
            for i in 0..n {
                at[i] = if s == 0 {
                    state[i]
                } else {
                    state[i] + advance * self.slope[i]
                };
            }
            self.dynamics
                .states(&mut self.workspace)
                .copy_from_slice(at);
            let share = self.interpolation.share_of_next(stage.node);
            for (to, samples) in self
                .dynamics
                .inputs(&mut self.workspace)
                .iter_mut()
                .zip(&segment.inputs)
            {
                *to = T::from_f64(between(samples[k], samples[k + 1], share));
            }
            *self.dynamics.time(&mut self.workspace) = T::from_f64(elapsed + h * stage.node);
            self.dynamics.run(&mut self.workspace);
            self.dynamics.results(&self.workspace, &mut self.slope);
            let weight = T::from_f64(h * stage.weight);
            for i in 0..n {
                self.sum[i] = self.sum[i] + weight * self.slope[i];
            }
        }
        for (state, &sum) in state.iter_mut().zip(&self.sum) {
            *state = *state + sum;
        }
    }
}

/// The value between two samples, `share` of the way to the later one.
#[inline(always)]
pub(crate) fn between(now: f64, next: f64, share: f64) -> f64 {
    // written so that the ends and the middle are exact
    if share == 0.0 {
        now
    } else if share == 1.0 {
        next
    } else {
        now * (1.0 - share) + next * share
    }
}
