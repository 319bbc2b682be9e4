//! Where output error starts: values of the document, or values found before the first iteration.

mod automatic;
mod method;
mod multi_start;
mod nelder_mead;
mod report;

use std::ops::ControlFlow;

use nalgebra::DMatrix;

use super::equation_error::equation_error_start;
use super::estimator::{Progress, Watcher};
use super::evaluation::{Evaluator, Unusable};
use super::likelihood::Weighting;
use super::problem::Problem;
use super::shooting::multiple_shooting;
pub(super) use method::INTERVAL;
pub use method::StartMethod;
pub use report::{StartKind, StartReport};

/// A start for the iteration.
pub(super) struct Start {
    /// SI, within bounds.
    pub theta: Vec<f64>,
    /// Somebody asked to stop on the way.
    pub stopped: bool,
    /// Multiple shooting has not been tried, and may be where the iteration from here fails.
    pub may_shoot: bool,
}

/// Finds the start that the options ask for.
///
/// # Errors
/// The method asked for finds no θ that gives a cost.
pub(super) fn find_start(problem: &Problem, watcher: &mut Watcher<'_>) -> Result<Start, Unusable> {
    let theta = problem.unknowns.start();
    let found = |theta, stopped| Start {
        theta,
        stopped,
        may_shoot: false,
    };
    match &problem.options.start {
        StartMethod::Document {} => Ok(found(theta, false)),
        StartMethod::Automatic {} => automatic::automatic(problem, watcher),
        StartMethod::EquationError {} => {
            let (theta, evaluations) = equation_error_start(problem, &mut unobserved)?;
            let cost = cost(&mut Evaluator::new(problem), &theta).ok();
            let report = StartReport {
                method: StartKind::EquationError,
                evaluations,
                cost,
                text: "start values from equation error".to_string(),
            };
            let stopped = watcher(Progress::Start(&report)).is_break();
            Ok(found(theta, stopped))
        }
        StartMethod::NelderMead { max_evaluations } => {
            nelder_mead::nelder_mead(problem, theta, *max_evaluations, watcher)
        }
        StartMethod::MultiStart {
            starts,
            seed,
            spread,
        } => multi_start::multi_start(problem, *starts, *seed, *spread, watcher),
        StartMethod::MultipleShooting { interval } => {
            multiple_shooting(problem, theta, *interval, &mut |report| {
                watcher(Progress::Start(report))
            })
        }
    }
}

/// For iterations that are nobody's business.
pub(super) fn unobserved(_: &super::report::Iteration) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// -ln L at a θ, R concentrated.
///
/// # Errors
/// The θ gives no cost.
pub(super) fn cost(evaluator: &mut Evaluator<'_>, theta: &[f64]) -> Result<f64, Unusable> {
    let residuals = evaluator.residuals(theta)?;
    let problem = evaluator.problem();
    Weighting::at(problem, theta, &residuals).map(|weighting| weighting.cost)
}

/// -ln L of outputs that stay at their means: a start that is worse explains nothing.
pub(super) fn cost_of_constants(problem: &Problem) -> Option<f64> {
    let outputs = problem.model.outputs.len();
    let mut sums = DMatrix::zeros(outputs, outputs);
    for segment in &problem.segments {
        let centred: Vec<Vec<f64>> = segment.measured.iter().map(|z| centred(z)).collect();
        for i in 0..outputs {
            for j in 0..outputs {
                sums[(i, j)] += centred[i]
                    .iter()
                    .zip(&centred[j])
                    .map(|(a, b)| a * b)
                    .sum::<f64>();
            }
        }
    }
    let weighting = Weighting::new(&problem.options.noise, &sums, &problem.counts).ok()?;
    Some(weighting.cost)
}

/// Values less their mean; those that are no numbers count nothing.
fn centred(values: &[f64]) -> Vec<f64> {
    let numbers: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    let mean = numbers.iter().sum::<f64>() / numbers.len().max(1) as f64;
    let less = |&value: &f64| if value.is_finite() { value - mean } else { 0.0 };
    values.iter().map(less).collect()
}
