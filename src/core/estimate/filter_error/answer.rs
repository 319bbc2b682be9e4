//! The answer of the filter-error method, put together at its last iterate.

use nalgebra::{DMatrix, Schur};

use super::evaluation::FilterEvaluator;
use super::gain::Gain;
use super::iterate::Iterate;
use super::layout::Layout;
use crate::estimate::accuracy::coloured_residuals::Colour;
use crate::estimate::accuracy::error_bounds::ErrorBounds;
use crate::estimate::accuracy::fit::histories_of;
use crate::estimate::accuracy::halved_steps::{shifts_of, step, steps_per_sample};
use crate::estimate::answer::table::{Accuracy, table};
use crate::estimate::answer::{Ending, Solution, rows};
use crate::estimate::descent::stopped::Stopped;
use crate::estimate::problem::Problem;
use crate::estimate::problem::substeps::halved;
use crate::estimate::report::estimate::Estimate;
use crate::estimate::report::filter::{FilterEstimate, Pole, ProcessNoiseEstimate, SegmentGain};
use crate::estimate::report::integration::Integration;
use crate::simulate::StateMatrixAt;

pub(super) fn answer(
    evaluator: &mut FilterEvaluator<'_>,
    at: &Iterate,
    bounds: &ErrorBounds,
    iterations: usize,
    stopped: Stopped,
) -> Solution {
    let problem = evaluator.problem;
    let model = &problem.model;
    let mut modelled = vec![vec![Vec::new(); model.outputs.len()]; problem.segments.len()];
    let mut gains: Vec<SegmentGain> = Vec::new();
    // the last iterate was predicted before: what fails here failed there
    let _ = evaluator.innovations(&at.xi, &at.gain_noise.inverse, |index, gain, prediction| {
        if prediction.sample == 0 {
            gains.push(segment_gain(problem, index, gain));
        }
        let series = modelled[index].iter_mut().zip(prediction.outputs);
        series.for_each(|(series, &value)| series.push(value));
    });
    let histories = histories_of(problem, |index, _| std::mem::take(&mut modelled[index]));
    let layout = &evaluator.layout;
    let theta = &at.xi[..layout.parameters];
    let accuracy = Accuracy::new(&problem.unknowns, &at.information, &at.held, bounds);
    let distance = stopped.distance();
    let ending = Ending {
        problem,
        theta,
        stopped,
        iterations,
        evaluations: evaluator.evaluations,
        simulations: evaluator.simulations,
        weighting: &at.weighting,
        held: &at.held,
        bounds,
        histories: &histories,
        colour: &Colour::of(&histories),
    };
    let estimate = Estimate {
        integration: Some(integration(problem, at, bounds)),
        parameters: table(problem, theta, &accuracy),
        filter: Some(FilterEstimate {
            process_noise: process_noise(problem, layout, at, bounds),
            gain_covariance: rows(&at.gain_noise.covariance),
            gains,
        }),
        ..ending.estimate(|place| layout.name(problem, place))
    };
    Solution {
        theta: theta.to_vec(),
        covariance: at.weighting.covariance.clone(),
        distance,
        estimate,
        histories,
    }
}

/// How the model was stepped, and where the estimate would go with steps half as long.
fn integration(problem: &Problem, at: &Iterate, bounds: &ErrorBounds) -> Integration {
    let theta = &at.xi[..problem.unknowns.len()];
    let (mut fastest, mut parameters): (f64, _) = (0.0, Vec::new());
    for (index, segment) in problem.segments.iter().enumerate() {
        problem.unknowns.parameters(index, theta, &mut parameters);
        let mut matrix = StateMatrixAt::new(&problem.model, &parameters);
        let rates = matrix.rates_at_start(segment, &parameters);
        fastest = fastest.max(rates.fastest * step(segment));
    }
    let mut finer = problem.clone();
    for segment in &mut finer.segments {
        segment.substeps = halved(segment);
    }
    let there = FilterEvaluator::new(&finer).and_then(|mut evaluator| {
        Iterate::at(&mut evaluator, at.xi.clone(), at.gain_noise.clone())
    });
    let halved = there.ok().map(|there| {
        let change = &there.descent - &at.descent;
        shifts_of(&bounds.covariance, &bounds.standard_errors, &change)
    });
    Integration {
        steps_per_sample: steps_per_sample(problem),
        fastest,
        halved: halved.filter(|halved| halved.most.is_finite()),
    }
}

fn process_noise(
    problem: &Problem,
    layout: &Layout,
    at: &Iterate,
    bounds: &ErrorBounds,
) -> Vec<ProcessNoiseEstimate> {
    let states = problem
        .model
        .states
        .iter()
        .zip(&problem.model.document.states);
    let intensities = layout.intensities(&at.xi);
    let row = |(index, (state, (_, document)))| {
        let place = layout.place(index);
        let unit = match (document as &crate::model::State).unit.as_str() {
            "" | "-" => "1/s^0.5".to_string(),
            unit => format!("{unit}/s^0.5"),
        };
        let state: &crate::model::Quantity = state;
        let scale = state.unit.scale;
        let error = place.and_then(|place| bounds.standard_errors[place]);
        ProcessNoiseEstimate {
            state: state.name.clone(),
            unit,
            start: layout.start[index] / scale,
            estimate: intensities[index] / scale,
            standard_error: error.map(|error| error / scale),
            fixed: place.is_none(),
            at_bound: place.and_then(|place| at.held[place]),
        }
    };
    states.enumerate().map(row).collect()
}

fn segment_gain(problem: &Problem, index: usize, gain: &Gain) -> SegmentGain {
    let segment = &problem.segments[index];
    let states = gain.a.nrows();
    let identity = DMatrix::<f64>::identity(states, states);
    // one step of the integrator is the Taylor series of exp(A Δt) up to its order
    let order = problem.options.integrator.stage_count();
    let length = segment.steps.length(0);
    let count = segment.substeps.within(length);
    let flow = &gain.a * (length / count as f64);
    let step = (1..=order).rev().fold(identity.clone(), |sum, term| {
        &identity + &flow * sum / term as f64
    });
    let error = (0..count).fold(identity - &gain.k * &gain.c, |error, _| &step * error);
    SegmentGain {
        segment: segment.label.clone(),
        gain: rows(&gain.k),
        poles: poles(error),
    }
}

fn poles(matrix: DMatrix<f64>) -> Vec<Pole> {
    if matrix.is_empty() || !matrix.iter().all(|value| value.is_finite()) {
        return Vec::new();
    }
    let Some(schur) = Schur::try_new(matrix, f64::EPSILON, 10_000) else {
        return Vec::new();
    };
    let eigenvalues = schur.complex_eigenvalues();
    let pole = |value: &nalgebra::Complex<f64>| Pole {
        real: value.re,
        imaginary: value.im,
        magnitude: value.norm(),
    };
    eigenvalues.iter().map(pole).collect()
}
