//! Outputs on their paths to the recorder, whole series at a time: there, and back for the adjoint.

use super::interpolation::{Axis, Stencil};
use super::lag::Lag;
use crate::model::{Element, Model, PathElement, Scalar};

/// What is recorded of outputs, by output, then sample. `sizes` are those of the elements of outputs.
pub(super) fn pass<T: Scalar>(model: &Model, axis: &Axis, sizes: &[T], outputs: &mut [Vec<T>]) {
    for (passed, &size) in model.paths.of_outputs().iter().zip(sizes) {
        pass_one(passed.element, axis, size, &mut outputs[passed.signal]);
    }
}

/// One sample more at the end of each output.
pub(super) fn push<T: Scalar>(outputs: &mut [Vec<T>], sample: &[T]) {
    let series = outputs.iter_mut().zip(sample);
    series.for_each(|(series, &y)| series.push(y));
}

/// Hands over sample by sample.
pub(super) fn samples<T: Scalar>(outputs: &[Vec<T>], mut sink: impl FnMut(usize, &[T])) {
    let mut sample = Vec::with_capacity(outputs.len());
    for k in 0..outputs.first().map_or(0, Vec::len) {
        sample.clear();
        sample.extend(outputs.iter().map(|series| series[k]));
        sink(k, &sample);
    }
}

fn pass_one<T: Scalar>(element: Element, axis: &Axis, size: T, output: &mut Vec<T>) {
    let beyond = size - T::from_f64(size.real());
    match element {
        Element::Lag => Lag::new(size.real(), axis).pass(axis, output, beyond),
        Element::Delay => {
            let at = |k| {
                let stencil = axis.stencil(axis.before(k, size.real()));
                let value = sum(&stencil, stencil.weights, output);
                value - sum(&stencil, stencil.rates, output) * beyond
            };
            *output = (0..output.len()).map(at).collect();
        }
        // of inputs alone
        Element::Play | Element::RateLimit => {}
    }
}

fn sum<T: Scalar>(stencil: &Stencil, weights: [f64; 4], output: &[T]) -> T {
    let terms = weights.into_iter().zip(stencil.samples);
    let terms = terms.filter(|&(weight, _)| weight != 0.0);
    terms.fold(T::from_f64(0.0), |sum, (weight, sample)| {
        sum + T::from_f64(weight) * output[sample]
    })
}

/// The way back of [`pass`]: with x̄ = (∂J/∂recorded)ᵀ by output, then sample, in `bars`, it becomes (∂J/∂output)ᵀ.
/// `outputs` are those before their paths. The answer is ψ̄, by element of outputs.
pub(super) fn pass_back(
    model: &Model,
    axis: &Axis,
    sizes: &[f64],
    outputs: &[Vec<f64>],
    bars: &mut [Vec<f64>],
) -> Vec<f64> {
    // what each element was given
    let mut outputs = outputs.to_vec();
    let given = |(passed, &size): (&PathElement, &f64)| {
        let output = &mut outputs[passed.signal];
        let given = output.clone();
        pass_one(passed.element, axis, size, output);
        given
    };
    let elements = model.paths.of_outputs();
    let given: Vec<Vec<f64>> = elements.iter().zip(sizes).map(given).collect();
    let mut of_sizes = vec![0.0; elements.len()];
    for (place, passed) in elements.iter().enumerate().rev() {
        let (given, bars) = (&given[place], &mut bars[passed.signal]);
        of_sizes[place] = match passed.element {
            Element::Lag => lag_back(&Lag::new(sizes[place], axis), axis, given, bars),
            Element::Delay => delay_back(sizes[place], axis, given, bars),
            Element::Play | Element::RateLimit => 0.0,
        };
    }
    of_sizes
}

/// w̄_k = ± x̄_k + e w̄_(k+1), and what w_k was made of has it back: ȳ_k = x̄_k - g (w̄_k - w̄_(k+1)).
fn lag_back(lag: &Lag, axis: &Axis, given: &[f64], bars: &mut [f64]) -> f64 {
    let mut w = vec![0.0; given.len()];
    for k in 1..given.len() {
        let step = lag.step(axis, k - 1);
        w[k] = step.decay * w[k - 1] - step.gain * (given[k] - given[k - 1]);
    }
    let mut of_time = 0.0;
    // what the sample behind has for this one: for its w, and for its output
    let (mut kept, mut returned) = (0.0, 0.0);
    for k in (1..given.len()).rev() {
        let step = lag.step(axis, k - 1);
        let w_bar = lag.sign * bars[k] + kept;
        let change = given[k] - given[k - 1];
        of_time += w_bar * (step.decay_slope * w[k - 1] - step.gain_slope * change);
        bars[k] += returned - step.gain * w_bar;
        (kept, returned) = (step.decay * w_bar, step.gain * w_bar);
    }
    if let Some(first) = bars.first_mut() {
        *first += returned;
    }
    lag.sign * of_time
}

fn delay_back(delay: f64, axis: &Axis, given: &[f64], bars: &mut [f64]) -> f64 {
    let mut back = vec![0.0; given.len()];
    let mut of_delay = 0.0;
    for (k, bar) in bars.iter().enumerate() {
        let stencil = axis.stencil(axis.before(k, delay));
        for (weight, sample) in stencil.weights.into_iter().zip(stencil.samples) {
            back[sample] += weight * bar;
        }
        of_delay -= sum(&stencil, stencil.rates, given) * bar;
    }
    bars.copy_from_slice(&back);
    of_delay
}
