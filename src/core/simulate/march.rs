//! A simulation taken along a segment stretch by stretch, for any kind of number. Where inputs or outputs have paths
//! the whole segment is one stretch: a delay looks back and ahead.

use super::method::{InputInterpolation, Integrator};
use super::segment::Segment;
use super::simulation::{initial_state, simulate};
use super::stepper::Stepper;
use crate::model::{Model, Scalar, Workspace};
use crate::stop;

/// The machinery, shared by any number of simulations that go along side by side.
pub(crate) struct March<'m, T> {
    model: &'m Model,
    integrator: Integrator,
    interpolation: InputInterpolation,
    stepper: Stepper<'m, T>,
    observation: Workspace<T>,
    outputs: Vec<T>,
}

/// How far one simulation has come: the sample that is next, and the state there.
#[derive(Clone, Debug)]
pub(crate) struct Standing<T> {
    next: usize,
    elapsed: f64,
    state: Vec<T>,
}

impl Standing<f64> {
    pub(crate) fn is_finite(&self) -> bool {
        self.state.iter().all(|x| x.is_finite())
    }
}

impl<'m, T: Scalar> March<'m, T> {
    pub(crate) fn new(
        model: &'m Model,
        integrator: Integrator,
        interpolation: InputInterpolation,
    ) -> Self {
        Self {
            model,
            integrator,
            interpolation,
            stepper: Stepper::new(model, integrator, interpolation),
            observation: model.observation.workspace(),
            outputs: vec![T::from_f64(0.0); model.outputs.len()],
        }
    }

    /// How many samples of a segment to go on by: `samples`, where that may be chosen.
    pub(crate) fn stretch(model: &Model, segment: &Segment, samples: usize) -> usize {
        if model.paths.is_empty() {
            samples
        } else {
            segment.len().max(1)
        }
    }

    /// The start of a simulation with `parameters`, all of the model's, SI.
    pub(crate) fn start(&self, parameters: &[T]) -> Standing<T> {
        Standing {
            next: 0,
            elapsed: 0.0,
            state: initial_state(self.model, parameters),
        }
    }

    /// Goes on to sample `until` (not included) and hands the outputs of each sample to `sink`.
    /// `parameters` are those that the simulation was started with; stretches are as [`Self::stretch`] says.
    pub(crate) fn advance(
        &mut self,
        standing: &mut Standing<T>,
        segment: &Segment,
        parameters: &[T],
        until: usize,
        mut sink: impl FnMut(usize, &[T]),
    ) {
        if !self.model.paths.is_empty() {
            let (integrator, interpolation) = (self.integrator, self.interpolation);
            simulate(
                self.model,
                integrator,
                interpolation,
                segment,
                parameters,
                sink,
            );
            standing.next = segment.len();
            return;
        }
        self.stepper.set_parameters(parameters);
        let program = &self.model.observation;
        program.set_parameters(&mut self.observation, parameters);
        for k in standing.next..until.min(segment.len()) {
            stop::check_sometimes(k);
            let workspace = &mut self.observation;
            program.states(workspace).copy_from_slice(&standing.state);
            for (to, samples) in program.inputs(workspace).iter_mut().zip(&segment.inputs) {
                *to = T::from_f64(samples[k]);
            }
            *program.time(workspace) = T::from_f64(standing.elapsed);
            program.run(workspace);
            program.results(workspace, &mut self.outputs);
            sink(k, &self.outputs);
            if k + 1 < segment.len() {
                let state = &mut standing.state;
                self.stepper.step(segment, k, standing.elapsed, state);
                standing.elapsed += segment.steps.length(k);
            }
        }
        standing.next = until;
    }
}
