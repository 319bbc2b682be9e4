//! Simulation of a segment for any kind of number.

use super::input_path::driven;
use super::interpolation::Axis;
use super::method::{InputInterpolation, Integrator};
use super::output_path;
use super::refined::Refined;
use super::segment::Segment;
use super::stepper::Stepper;
use crate::model::{Model, Scalar};
use crate::stop;

/// The simulation left the range of numbers.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[error("the simulation leaves the range of numbers at sample {}", sample + 1)]
pub struct Diverged {
    /// Index of the first sample at which something is not finite, as far as it is known.
    pub sample: usize,
}

impl Diverged {
    /// The same, found among the steps of a refined segment.
    pub(super) fn in_samples(self, refined: Option<&Refined>) -> Self {
        Self {
            sample: refined.map_or(self.sample, |refined| refined.sample_from(self.sample)),
        }
    }
}

/// Simulates a segment and hands the outputs of each sample to `sink`.
///
/// `parameters` are all parameters of the model, SI, in its order. Generic over the number, so that the
/// same code gives outputs (`f64`) and complex-step derivatives (`Complex64`).
pub fn simulate<T: Scalar>(
    model: &Model,
    integrator: Integrator,
    interpolation: InputInterpolation,
    segment: &Segment,
    parameters: &[T],
    sink: impl FnMut(usize, &[T]),
) {
    simulate_disturbed(
        model,
        integrator,
        interpolation,
        segment,
        parameters,
        |_| {},
        sink,
    );
}

/// As [`simulate`], with `disturb` shown the state after each step.
pub(super) fn simulate_disturbed<T: Scalar>(
    model: &Model,
    integrator: Integrator,
    interpolation: InputInterpolation,
    segment: &Segment,
    parameters: &[T],
    disturb: impl FnMut(&mut [T]),
    sink: impl FnMut(usize, &[T]),
) {
    let sizes = model.paths.at(parameters);
    let at_hand: Vec<f64> = sizes.iter().map(|size| size.real()).collect();
    let segment = &*driven(model, interpolation, segment, &at_hand);
    let sizes = &sizes[model.paths.of_inputs().len()..];
    if sizes.is_empty() {
        run(
            model,
            integrator,
            interpolation,
            segment,
            parameters,
            disturb,
            sink,
        );
        return;
    }
    let mut outputs = vec![Vec::with_capacity(segment.len()); model.outputs.len()];
    let keep = |_, y: &[T]| output_path::push(&mut outputs, y);
    run(
        model,
        integrator,
        interpolation,
        segment,
        parameters,
        disturb,
        keep,
    );
    output_path::pass(model, &Axis::new(segment), sizes, &mut outputs);
    output_path::samples(&outputs, sink);
}

/// Simulates a driven segment, outputs before their paths.
fn run<T: Scalar>(
    model: &Model,
    integrator: Integrator,
    interpolation: InputInterpolation,
    segment: &Segment,
    parameters: &[T],
    mut disturb: impl FnMut(&mut [T]),
    mut sink: impl FnMut(usize, &[T]),
) {
    let mut stepper = Stepper::new(model, integrator, interpolation);
    stepper.set_parameters(parameters);
    let mut state = initial_state(model, parameters);
    let mut observation = model.observation.workspace();
    model
        .observation
        .set_parameters(&mut observation, parameters);
    let mut outputs = vec![T::from_f64(0.0); model.outputs.len()];
    let mut elapsed = 0.0;
    for k in 0..segment.len() {
        stop::check_sometimes(k);
        model
            .observation
            .states(&mut observation)
            .copy_from_slice(&state);
        for (to, samples) in model
            .observation
            .inputs(&mut observation)
            .iter_mut()
            .zip(&segment.inputs)
        {
            *to = T::from_f64(samples[k]);
        }
        *model.observation.time(&mut observation) = T::from_f64(elapsed);
        model.observation.run(&mut observation);
        model.observation.results(&observation, &mut outputs);
        sink(k, &outputs);
        if k + 1 < segment.len() {
            stepper.step(segment, k, elapsed, &mut state);
            disturb(&mut state);
            elapsed += segment.steps.length(k);
        }
    }
}

/// x0(θ)
pub fn initial_state<T: Scalar>(model: &Model, parameters: &[T]) -> Vec<T> {
    let mut workspace = model.initial.workspace();
    model.initial.set_parameters(&mut workspace, parameters);
    model.initial.run(&mut workspace);
    let mut state = vec![T::from_f64(0.0); model.states.len()];
    model.initial.results(&workspace, &mut state);
    state
}
