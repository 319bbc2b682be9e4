//! What inputs do between samples: where the other assumption explains the data far better, that is said.
//!
//! One evaluation with the other assumption at the estimate, and the step that would follow from there: what the cost
//! would come down to, to second order, with all parameters adjusted.

use nalgebra::DMatrix;

use crate::estimate::answer::Solution;
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::evaluation::normal_equations::NormalEquations;
use crate::estimate::options::Options;
use crate::estimate::options::estimator::Estimator;
use crate::estimate::problem::Problem;
use crate::flight::{Finding, FindingCode};
use crate::simulate::InputInterpolation;

/// Inputs that change by less than this share of their variance from one sample to the next, in the mean square, are as
/// good as the same on straight lines and in steps.
const JUMPS: f64 = 0.01;
/// -ln L must come down by this for each value that is fitted, and by [`LEAST`] in all: residuals a tenth smaller.
const BY_VALUE: f64 = 0.1;
const LEAST: f64 = 20.0;

pub(super) fn findings(problem: &Problem, solution: &Solution) -> Vec<Finding> {
    let options = &problem.options;
    let fit = options.estimator == Estimator::OutputError && solution.estimate.outcome.is_minimum();
    if !fit || problem.model.states.is_empty() || !jumps(problem) {
        return Vec::new();
    }
    let other = match options.input_interpolation {
        InputInterpolation::Linear => InputInterpolation::Hold,
        InputInterpolation::Hold => InputInterpolation::Linear,
    };
    let problem = Problem {
        options: Options {
            input_interpolation: other,
            ..options.clone()
        },
        ..problem.clone()
    };
    let mut evaluator = Evaluator::new(&problem);
    let Ok(equations) = NormalEquations::at(&mut evaluator, &solution.theta) else {
        return Vec::new();
    };
    let gain = solution.estimate.cost - reached(&equations);
    let values: usize = problem.counts.iter().sum();
    if gain < LEAST || gain < BY_VALUE * values as f64 {
        return Vec::new();
    }
    let (seen, option, remedy) = match other {
        InputInterpolation::Hold => (
            "inputs that are held between samples explain the data far better than straight lines do",
            "\"input_interpolation\": \"hold\" (--hold)",
            "as the commands of a computer are",
        ),
        InputInterpolation::Linear => (
            "inputs on straight lines between samples explain the data far better than held ones do",
            "\"input_interpolation\": \"linear\"",
            "as what a sensor measures mostly is",
        ),
    };
    let message = format!("{seen}: -ln L would come down by about {gain:.0}");
    let remedy = format!(
        "say {option} where that is what they do, {remedy}; where it is not, an input is late by half a sample"
    );
    let finding = Finding::new(FindingCode::InputInterpolation, message, remedy);
    vec![finding.at("/options/input_interpolation")]
}

/// What the cost would come down to by the step from here.
fn reached(equations: &NormalEquations) -> f64 {
    let information: DMatrix<f64> = equations.information.clone();
    let step = information
        .cholesky()
        .map(|factor| factor.solve(&equations.descent));
    let down = step.map_or(0.0, |step| 0.5 * step.dot(&equations.descent));
    equations.cost() - down.max(0.0)
}

/// Whether some input jumps from sample to sample.
fn jumps(problem: &Problem) -> bool {
    (0..problem.model.inputs.len()).any(|input| {
        let series = || {
            problem
                .segments
                .iter()
                .map(|segment| &segment.inputs[input])
        };
        let count = series().map(Vec::len).sum::<usize>() as f64;
        let mean = series().flatten().sum::<f64>() / count;
        let variance = series().flatten().map(|u| (u - mean).powi(2)).sum::<f64>() / count;
        let changes = series()
            .flat_map(|u| u.windows(2))
            .map(|pair| (pair[1] - pair[0]).powi(2));
        changes.sum::<f64>() / count > JUMPS * variance
    })
}
