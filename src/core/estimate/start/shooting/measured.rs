//! The first nodes and the size of the noise, from smoothed measurements.

use nalgebra::DVector;

use super::beginning::beginning;
use super::intervals::{Cut, Nodes};
use crate::estimate::options::Noise;
use crate::estimate::problem::Problem;
use crate::estimate::regression::measured::measured_states;
use crate::estimate::regression::smoothing::smoothed;

/// A state's noise is taken as at least this share of its range.
const LEAST_NOISE: f64 = 1e-3;
/// For states that no output measures.
const UNMEASURED_NOISE: f64 = 1e-2;

/// Nodes from measured states, and the noise of each state; states that no output measures are simulated from interval
/// to interval.
pub(super) fn first_nodes(cut: &Cut<'_>, theta: &[f64]) -> (Nodes, DVector<f64>) {
    let problem = cut.problem;
    let model = &problem.model;
    let states = model.states.len();
    let mut noise = DVector::zeros(states);
    let mut nodes: Nodes = Vec::new();
    let mut parameters = Vec::new();
    for (segment, intervals) in cut.intervals.iter().enumerate() {
        problem.unknowns.parameters(segment, theta, &mut parameters);
        let data = &problem.segments[segment];
        let time = data.elapsed();
        let mut known = vec![None; states];
        for at in measured_states(model, &parameters) {
            let smooth = smoothed(&time, &at.read(model, data, &parameters));
            noise[at.state] = f64::max(noise[at.state], smooth.noise);
            known[at.state] = Some(smooth.value);
        }
        let zero = DVector::zeros(states);
        let initial = beginning(problem, segment, theta, &zero).map_or(zero, |own| own.jump);
        let mut own: Vec<DVector<f64>> = Vec::new();
        for (index, interval) in intervals.iter().enumerate() {
            let mut node = match own.last() {
                Some(last) => cut.end(segment, index - 1, theta, last, None),
                None => initial.clone(),
            };
            for (state, values) in known.iter().enumerate() {
                if let Some(values) = values {
                    node[state] = values[interval.first];
                } else if !node[state].is_finite() {
                    node[state] = own.last().map_or(0.0, |last| last[state]);
                }
            }
            own.push(node);
        }
        nodes.push(own);
    }
    for state in 0..states {
        let all = || nodes.iter().flatten().map(|node| node[state]);
        let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        let size = all().fold(0.0, |size: f64, x| size.max(x.abs()));
        let range = if high > low { high - low } else { size };
        let least = if noise[state] > 0.0 {
            LEAST_NOISE
        } else {
            UNMEASURED_NOISE
        };
        noise[state] = f64::max(noise[state], least * range);
        if noise[state] == 0.0 {
            noise[state] = 1.0;
        }
    }
    (nodes, noise)
}

/// The problem with R held at what smoothing takes from each output. Where pieces follow a wrong θ badly, an R estimated
/// from their residuals weighs the outputs that θ explains worst least, and may lead into a valley far off.
pub(super) fn with_measured_noise(problem: &Problem) -> Problem {
    let variance = |output: usize| {
        let (mut squares, mut samples, mut size) = (0.0, 0.0, 0.0);
        for segment in &problem.segments {
            let values = &segment.measured[output];
            let smooth = smoothed(&segment.elapsed(), values);
            let count = values.len() as f64;
            squares += count * smooth.noise * smooth.noise;
            size += smooth.value.iter().map(|value| value * value).sum::<f64>();
            samples += count;
        }
        let least = LEAST_NOISE * LEAST_NOISE * size / samples;
        match f64::max(squares / samples, least) {
            variance if variance > 0.0 => variance,
            _ => 1.0,
        }
    };
    let mut given = problem.clone();
    given.options.noise = Noise::Given {
        variance: (0..problem.model.outputs.len()).map(variance).collect(),
    };
    given
}
