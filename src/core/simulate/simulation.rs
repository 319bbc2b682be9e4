//! Simulation of a segment for any kind of number.

use super::delayed_inputs::driven;
use super::interpolation::Axis;
use super::method::{InputInterpolation, Integrator};
use super::segment::Segment;
use super::stepper::Stepper;
use crate::model::{Model, Scalar};

/// The simulation left the range of numbers.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[error("the simulation leaves the range of numbers at sample {}", sample + 1)]
pub struct Diverged {
    /// Index of the first sample at which something is not finite, as far as it is known.
    pub sample: usize,
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
    mut sink: impl FnMut(usize, &[T]),
) {
    let delays = model.delays.at(parameters);
    let at_hand: Vec<f64> = delays.iter().map(|delay| delay.real()).collect();
    let segment = &*driven(model, segment, &at_hand);
    let delays = &delays[model.delays.inputs.len()..];
    if delays.is_empty() {
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
    let outputs = model.outputs.len();
    let mut prompt = Vec::with_capacity(segment.len() * outputs);
    let keep = |_, y: &[T]| prompt.extend_from_slice(y);
    run(
        model,
        integrator,
        interpolation,
        segment,
        parameters,
        disturb,
        keep,
    );
    let axis = Axis::new(segment);
    for (k, prompt_now) in prompt.chunks_exact(outputs.max(1)).enumerate() {
        let mut y = prompt_now.to_vec();
        for (&output, &delay) in model.delays.outputs.iter().zip(delays) {
            let stencil = axis.stencil(axis.before(k, delay.real()));
            let sum = |weights: [f64; 4]| {
                let terms = weights.into_iter().zip(stencil.samples);
                let terms = terms.filter(|&(weight, _)| weight != 0.0);
                terms.fold(T::from_f64(0.0), |sum, (weight, sample)| {
                    sum + T::from_f64(weight) * prompt[sample * outputs + output]
                })
            };
            let rest = T::from_f64(delay.real()) - delay;
            y[output] = sum(stencil.weights) + sum(stencil.rates) * rest;
        }
        sink(k, &y);
    }
}

/// Simulates a driven segment, outputs without their delays.
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
