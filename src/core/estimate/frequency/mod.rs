//! Estimation in the frequency domain, for linear models and for small motions about the start of a maneuver.
//!
//! ```text
//! J(θ, R) = Σ_k e_kᴴ S⁻¹ e_k + M ln|S| + const,   e_k = z(ω_k) - (C (iω_k - A)⁻¹ B + D) u(ω_k) - ...,   S = 2 R
//! ```
//!
//! over a band of M frequencies (Klein, J. Aircraft 17, 1980; Morelli and Klein, Aircraft System Identification, ch. 7): the
//! likelihood of complex normal residuals, whose real and imaginary parts count as two samples of the variance R. With
//! equation error z is iω times the transform of a measured state. A transform over a finite time also depends on the states
//! at its ends and on drifts; both are linear unknowns of each segment, estimated along with θ (`spectra`) and taken out of
//! its information (`reduced`).
//!
//! Biases, trim values and initial states do not show in a band without zero. So that there are time histories to look at,
//! they are fitted to these at the end, with all that was estimated held (`left_out`).

mod answer;
mod columns;
mod evaluator;
mod left_out;
mod linear;
mod path;
mod power;
mod reduced;
mod response;
mod spectra;
mod sums;
mod transformed;

use std::ops::ControlFlow;

use crate::estimate::accuracy::fit::histories;
use crate::estimate::answer::Solution;
use crate::estimate::descent::Descent;
use crate::estimate::descent::gauss_newton::descend_with;
use crate::estimate::evaluation::evaluate::Evaluate;
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::options::Options;
use crate::estimate::options::start::StartMethod;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::regression::Regression;
use crate::estimate::report::iteration::{Iteration, Outcome};
use crate::estimate::report::progress::{Observer, unobserved};
use answer::{Shown, answer};
use evaluator::FrequencyEvaluator;
use left_out::with_left_out;
pub(crate) use spectra::band_frequencies;
use transformed::Transformed;

/// Estimates θ by output error in the frequency domain.
///
/// # Errors
/// The options have no band. The start values give no finite frequency response.
pub fn output_error_frequency(
    problem: &Problem,
    observer: &mut Observer<'_>,
) -> Result<Solution, Unusable> {
    let options = problem.options.frequency.ok_or(Unusable::NoBand)?;
    let transformed = Transformed::new(problem, &options, 0);
    let start = start(problem, &transformed)?;
    let of_asked = |place: usize| Some(place);
    let descent = descend(problem, &transformed, &of_asked, start, observer)?;
    let theta = of_base(problem, &transformed, &descent.last.theta);
    let is_seen = |place: usize| transformed.place(place).is_some();
    let theta = with_left_out(problem, theta, is_seen);
    let shown = Shown {
        asked: problem,
        histories: histories(problem, &theta),
        theta,
        place: &of_asked,
    };
    let mut solution = answer(problem, descent, shown);
    let reason = reason("output error", problem, is_seen, &solution);
    solution.estimate.reason = reason;
    Ok(solution)
}

/// Estimates θ by equation error in the frequency domain. Outputs of the answer are the derivatives of the measured states,
/// and those recorded outputs that measure no state.
///
/// # Errors
/// The options have no band. No output measures a state. The regression has no finite residuals at the start values.
pub fn equation_error_frequency(
    problem: &Problem,
    observer: &mut Observer<'_>,
) -> Result<Solution, Unusable> {
    let Regressed {
        regression,
        transformed,
    } = Regressed::of(problem)?;
    let base = &regression.problem;
    let of_asked = |place: usize| regression.place(place);
    let start = transformed.problem.unknowns.start();
    let descent = descend(problem, &transformed, &of_asked, start, observer)?;
    let found = of_base(base, &transformed, &descent.last.theta);
    let is_seen = |place: usize| transformed.place(place).is_some();
    // in the time domain the same regression is one of smoothed signals
    let smoothed = Regression::new(problem).ok_or(Unusable::NoMeasuredState)?;
    let found = with_left_out(&smoothed.problem, found, is_seen);
    let shown = Shown {
        asked: problem,
        theta: smoothed.theta(&found),
        place: &of_asked,
        histories: histories(&smoothed.problem, &found),
    };
    let mut solution = answer(base, descent, shown);
    let is_seen = |place: usize| regression.place(place).is_some_and(is_seen);
    let mut reason = reason("equation error", problem, is_seen, &solution);
    if !regression.integrated.is_empty() {
        let states = regression.integrated.join(", ");
        reason += &format!("; no output measures {states}: from their equations");
    }
    solution.estimate.reason = reason;
    Ok(solution)
}

/// The regression of a problem, transformed.
struct Regressed {
    regression: Regression,
    transformed: Transformed,
}

impl Regressed {
    fn of(problem: &Problem) -> Result<Self, Unusable> {
        let options = problem.options.frequency.ok_or(Unusable::NoBand)?;
        let mut regression = Regression::recorded(problem).ok_or(Unusable::NoMeasuredState)?;
        regression.problem.options = Options {
            noise: problem.options.noise.clone(),
            input_interpolation: problem.options.input_interpolation,
            ..regression.problem.options.clone()
        };
        let measured = &regression.measured;
        let mut transformed = Transformed::new(&regression.problem, &options, measured.len());
        transformed.take_paths_off(problem, measured);
        Ok(Self {
            regression,
            transformed,
        })
    }
}

/// Goes down from a start; the observer hears of the unknowns of the problem that was asked about, of which `of_asked` gives
/// the place in the one that was transformed.
fn descend<'t>(
    asked: &Problem,
    transformed: &'t Transformed,
    of_asked: &dyn Fn(usize) -> Option<usize>,
    start: Vec<f64>,
    observer: &mut Observer<'_>,
) -> Result<Descent<FrequencyEvaluator<'t>>, Unusable> {
    let unmoved = asked.in_own_units(&asked.unknowns.start());
    let solved: Vec<Option<usize>> = (0..unmoved.len())
        .map(|place| transformed.place(of_asked(place)?))
        .collect();
    let mut told = |iteration: &Iteration| -> ControlFlow<()> {
        let mut iteration = iteration.clone();
        let own = std::mem::replace(&mut iteration.parameters, unmoved.clone());
        for (value, place) in iteration.parameters.iter_mut().zip(&solved) {
            if let Some(place) = *place {
                *value = own[place];
            }
        }
        observer(&iteration)
    };
    descend_with(FrequencyEvaluator::new(transformed), start, &mut told)
}

/// θ of the problem that was transformed: what does not show in the frequency response stays at its start.
fn of_base(base: &Problem, transformed: &Transformed, found: &[f64]) -> Vec<f64> {
    let mut theta = base.unknowns.start();
    for (place, value) in transformed.places.iter().zip(found) {
        if let Some(place) = *place {
            theta[place] = *value;
        }
    }
    theta
}

/// Where output error starts from: the start values as given, those of equation error, or the better of the two.
fn start(problem: &Problem, transformed: &Transformed) -> Result<Vec<f64>, Unusable> {
    let given = transformed.problem.unknowns.start();
    if problem.options.start == (StartMethod::Document {}) {
        return Ok(given);
    }
    let regressed = equation_error_start(problem, transformed);
    if problem.options.start == (StartMethod::EquationError {}) {
        return regressed;
    }
    let Ok(regressed) = regressed else {
        return Ok(given);
    };
    let mut evaluator = FrequencyEvaluator::new(transformed);
    let mut cost = |theta: &[f64]| {
        let residuals = evaluator.residuals(theta).ok()?;
        let weighting = Weighting::at(&transformed.problem, theta, &residuals).ok()?;
        Some(weighting.cost)
    };
    let is_better = match (cost(&regressed), cost(&given)) {
        (Some(regressed), Some(given)) => regressed < given,
        (regressed, _) => regressed.is_some(),
    };
    Ok(if is_better { regressed } else { given })
}

/// The parameters of equation error in the frequency domain, in the places of output error.
fn equation_error_start(
    problem: &Problem,
    transformed: &Transformed,
) -> Result<Vec<f64>, Unusable> {
    let regressed = Regressed::of(problem)?;
    let base = &regressed.regression.problem;
    let evaluator = FrequencyEvaluator::new(&regressed.transformed);
    let start = regressed.transformed.problem.unknowns.start();
    let descent = descend_with(evaluator, start, &mut unobserved)?;
    let found = of_base(base, &regressed.transformed, &descent.last.theta);
    let found = regressed.regression.theta(&found);
    let start = transformed.problem.unknowns.start();
    let places = transformed.places.iter().zip(start);
    Ok(places
        .map(|(place, start)| place.map_or(start, |place| found[place]))
        .collect())
}

/// The estimator's reason, with what it looked at and what it left out.
fn reason(
    estimator: &str,
    problem: &Problem,
    is_seen: impl Fn(usize) -> bool,
    solution: &Solution,
) -> String {
    let estimate = &solution.estimate;
    let count: usize = (estimate.frequency.iter())
        .flat_map(|frequency| &frequency.segments)
        .map(|segment| segment.frequencies)
        .sum();
    let mut reason = format!(
        "{estimator} in the frequency domain, at {count} frequencies: {}",
        estimate.reason
    );
    let left: Vec<String> = (0..problem.unknowns.len())
        .filter(|&place| !is_seen(place))
        .map(|place| problem.name(place))
        .collect();
    if !left.is_empty() && estimate.outcome != Outcome::Cancelled {
        reason += &format!(
            "; no frequency of the band shows these, which were fitted to the time histories with all others held, or left at the start: {}",
            left.join(", ")
        );
    }
    reason
}
