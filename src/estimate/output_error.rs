//! The output-error method: Gauss-Newton or Levenberg-Marquardt on the likelihood concentrated in R.

use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector};

use super::evaluation::{Evaluator, LeftRange};
use super::fit::fits;
use super::information::Spectrum;
use super::likelihood::{NormalEquations, Weighting};
use super::options::Method;
use super::problem::Problem;
use super::report::{Bound, CollinearSet, Estimate, Iteration, Outcome, ParameterEstimate};
use super::step::{Newton, advanced, held};

/// Told of each iteration; may stop the solver.
pub type Observer<'o> = dyn FnMut(&Iteration) -> ControlFlow<()> + 'o;

/// Damping: where it starts, what success and failure make of it, and below what it is none.
const DAMPING_START: f64 = 1e-3;
const DAMPING_EASED: f64 = 1e-2;
const DAMPING_RAISED: f64 = 10.0;
const DAMPING_NONE: f64 = 1e-10;

/// How often a step may be shortened, or the damping raised, within one iteration.
const MOST_TRIALS: usize = 16;

/// The cost is a sum over all samples: differences below this share of it are rounding.
const ROUNDING: f64 = 1e-13;

/// Estimates θ from the start values of the problem. Returns the estimate and θ, SI.
///
/// # Errors
/// The start values' own simulation leaves the range of numbers, so that there is nothing to begin with.
pub fn output_error(
    problem: &Problem,
    observer: &mut Observer<'_>,
) -> Result<(Estimate, Vec<f64>), LeftRange> {
    let mut evaluator = Evaluator::new(problem);
    let mut current = Iterate::at(problem, &mut evaluator, problem.unknowns.start())?;
    let mut iteration = 0;
    let mut damping = match problem.options.method {
        Method::LevenbergMarquardt => DAMPING_START,
        Method::GaussNewton => 0.0,
    };
    let mut last = Taken::default();
    let (outcome, reason) = loop {
        let report = current.report(problem, iteration, &last);
        if observer(&report).is_break() {
            break (
                Outcome::Cancelled,
                format!("stopped on request after {iteration} iteration(s)"),
            );
        }
        let Some(newton) = &current.newton else {
            break (
                Outcome::Stalled,
                "the information matrix has entries that are not numbers".to_string(),
            );
        };
        let distance = newton.distance();
        if distance < problem.options.tolerance {
            break current.finished(problem, distance);
        }
        if iteration == problem.options.max_iterations {
            let reason = format!(
                "the budget of {iteration} iterations is used up; a further step would move the estimate by {distance:.1e} standard errors"
            );
            break (Outcome::Budget, reason);
        }
        match better(problem, &mut evaluator, &current, damping) {
            Search::Found(next, taken) => {
                damping = taken.next_damping;
                current = *next;
                last = taken;
                iteration += 1;
            }
            Search::Nothing { out_of_range: true } => {
                let reason = "every step tried leads to a simulation that leaves the range of numbers; start closer, or set bounds";
                break (Outcome::Diverged, reason.to_string());
            }
            Search::Nothing {
                out_of_range: false,
            } => {
                let reason = format!(
                    "no step lowers the cost any more, though the next one would be {distance:.1e} standard errors long"
                );
                break (Outcome::Stalled, reason);
            }
        }
    };
    let estimate = current.estimate(problem, &evaluator, iteration, outcome, reason);
    Ok((estimate, current.theta))
}

/// A θ and everything that is known there.
struct Iterate {
    theta: Vec<f64>,
    weighting: Weighting,
    information: DMatrix<f64>,
    held: Vec<Option<Bound>>,
    newton: Option<Newton>,
}

/// How an iterate was reached.
#[derive(Clone, Copy, Default)]
struct Taken {
    length: f64,
    damping: f64,
    halvings: usize,
    next_damping: f64,
}

enum Search {
    Found(Box<Iterate>, Taken),
    Nothing { out_of_range: bool },
}

/// Looks for a θ of lower cost: by halving the step (Gauss-Newton) or by damping it more (Levenberg-Marquardt).
fn better(
    problem: &Problem,
    evaluator: &mut Evaluator<'_>,
    current: &Iterate,
    start_damping: f64,
) -> Search {
    let Some(newton) = &current.newton else {
        return Search::Nothing {
            out_of_range: false,
        };
    };
    let most = current.weighting.cost + ROUNDING * (1.0 + current.weighting.cost.abs());
    let mut damping = start_damping;
    let mut share = 1.0;
    let mut out_of_range = false;
    for trial in 0..MOST_TRIALS {
        let step = newton.step(damping);
        let theta = advanced(&problem.unknowns, &current.theta, &step, share);
        // the first trial is nearly always taken: its sensitivities are then not worked out twice
        let lower = trial == 0
            || match evaluator.residuals(&theta) {
                Ok(residuals) => {
                    Weighting::new(&problem.options.noise, &residuals, problem.samples())
                        .is_some_and(|weighting| weighting.cost <= most)
                }
                Err(_) => false,
            };
        let next = if lower {
            Some(Iterate::at(problem, evaluator, theta))
        } else {
            None
        };
        match next {
            Some(Ok(next)) if next.weighting.cost <= most => {
                let moved = DVector::from_iterator(
                    step.len(),
                    next.theta.iter().zip(&current.theta).map(|(a, b)| a - b),
                );
                let length = moved.dot(&(&current.information * &moved)).max(0.0).sqrt();
                let eased = damping * DAMPING_EASED;
                let next_damping = if eased < DAMPING_NONE { 0.0 } else { eased };
                return Search::Found(
                    Box::new(next),
                    Taken {
                        length,
                        damping,
                        halvings: trial,
                        next_damping,
                    },
                );
            }
            Some(Err(_)) => out_of_range = true,
            _ => {}
        }
        match problem.options.method {
            Method::GaussNewton => share *= 0.5,
            Method::LevenbergMarquardt => damping = (damping * DAMPING_RAISED).max(DAMPING_START),
        }
    }
    Search::Nothing { out_of_range }
}

impl Iterate {
    fn at(
        problem: &Problem,
        evaluator: &mut Evaluator<'_>,
        theta: Vec<f64>,
    ) -> Result<Self, LeftRange> {
        let equations = NormalEquations::at(evaluator, &theta)?;
        let held = held(&problem.unknowns, &theta, &equations.descent);
        let newton = Newton::new(
            &equations.information,
            equations.relaxation.as_ref(),
            &equations.descent,
            &held,
        );
        let NormalEquations {
            weighting,
            information,
            ..
        } = equations;
        Ok(Self {
            theta,
            weighting,
            information,
            held,
            newton,
        })
    }

    fn report(&self, problem: &Problem, number: usize, taken: &Taken) -> Iteration {
        Iteration {
            number,
            cost: self.weighting.cost,
            det_r: self.weighting.det(),
            variance: self
                .weighting
                .covariance
                .diagonal()
                .iter()
                .copied()
                .collect(),
            parameters: problem.in_own_units(&self.theta),
            gradient_norm: self.newton.as_ref().map_or(0.0, Newton::gradient_norm),
            step: taken.length,
            damping: taken.damping,
            halvings: taken.halvings,
        }
    }

    /// The outcome at a point from which no step of any length leads further down.
    fn finished(&self, problem: &Problem, distance: f64) -> (Outcome, String) {
        let collinear = self.collinear(problem);
        if !collinear.is_empty() {
            let sets: Vec<String> = collinear
                .iter()
                .map(|set| set.parameters.join(" + "))
                .collect();
            let reason = format!(
                "the data cannot tell apart, or cannot see: {}; fix one of each set, or fly a maneuver that separates them",
                sets.join("; ")
            );
            return (Outcome::Singular, reason);
        }
        let at_bound: Vec<String> = (0..self.held.len())
            .filter(|&i| self.held[i].is_some())
            .map(|i| problem.name(i))
            .collect();
        let reason = format!(
            "converged: a further step would move the estimate by {distance:.1e} standard errors"
        );
        if at_bound.is_empty() {
            (Outcome::Converged, reason)
        } else {
            (
                Outcome::AtBound,
                format!("{reason}; held at a bound: {}", at_bound.join(", ")),
            )
        }
    }

    fn moving(&self) -> Vec<usize> {
        (0..self.held.len())
            .filter(|&i| self.held[i].is_none())
            .collect()
    }

    fn spectrum(&self) -> Option<Spectrum> {
        let moving = self.moving();
        let own = self
            .information
            .select_rows(&moving)
            .select_columns(&moving);
        Spectrum::of(&own, &own.diagonal())
    }

    fn collinear(&self, problem: &Problem) -> Vec<CollinearSet> {
        let moving = self.moving();
        let sets = self
            .spectrum()
            .map_or(Vec::new(), |spectrum| spectrum.collinear());
        let named = |members: Vec<(usize, f64)>| {
            let own_unit = |&(i, component): &(usize, f64)| {
                let place = moving[i];
                (
                    problem.name(place),
                    component
                        / problem.model.parameters[problem.unknowns.at(place).parameter]
                            .unit
                            .scale,
                )
            };
            let (parameters, mut direction): (Vec<String>, Vec<f64>) =
                members.iter().map(own_unit).unzip();
            let largest = direction
                .iter()
                .fold(0.0, |a: f64, b| if b.abs() > a.abs() { *b } else { a });
            direction
                .iter_mut()
                .for_each(|component| *component /= largest);
            CollinearSet {
                parameters,
                direction,
            }
        };
        sets.into_iter().map(named).collect()
    }

    fn estimate(
        &self,
        problem: &Problem,
        evaluator: &Evaluator<'_>,
        iterations: usize,
        outcome: Outcome,
        reason: String,
    ) -> Estimate {
        let collinear = self.collinear(problem);
        let moving = self.moving();
        let covariance = self.spectrum().map(|spectrum| spectrum.inverse());
        let mut standard_errors: Vec<Option<f64>> = vec![None; self.theta.len()];
        let mut correlation = Vec::new();
        if let Some(covariance) = &covariance {
            let error = |i: usize| covariance[(i, i)].sqrt();
            for (i, &place) in moving.iter().enumerate() {
                let unseen = collinear
                    .iter()
                    .any(|set| set.parameters.contains(&problem.name(place)));
                standard_errors[place] = Some(error(i)).filter(|e| !unseen && e.is_finite());
            }
            if collinear.is_empty() {
                let n = self.theta.len();
                correlation = vec![vec![0.0; n]; n];
                (0..n).for_each(|i| correlation[i][i] = 1.0);
                for (a, &i) in moving.iter().enumerate() {
                    for (b, &j) in moving.iter().enumerate().filter(|&(b, _)| b != a) {
                        correlation[i][j] = covariance[(a, b)] / (error(a) * error(b));
                    }
                }
            }
        }
        let covariance = &self.weighting.covariance;
        Estimate {
            outcome,
            reason,
            iterations,
            evaluations: evaluator.evaluations,
            simulations: evaluator.simulations,
            cost: self.weighting.cost,
            det_r: self.weighting.det(),
            noise_covariance: covariance
                .row_iter()
                .map(|row| row.iter().copied().collect())
                .collect(),
            outputs: fits(problem, &self.theta),
            parameters: self.table(problem, &standard_errors),
            correlation,
            collinear,
            samples: problem.samples(),
        }
    }

    /// All parameters, fixed ones too, in the order of the document.
    fn table(&self, problem: &Problem, standard_errors: &[Option<f64>]) -> Vec<ParameterEstimate> {
        let unknowns = &problem.unknowns;
        let row = |(index, unknown): (usize, &super::Unknown)| {
            let info = &problem.model.parameters[unknown.parameter];
            let own = |value: f64| (value - info.unit.offset) / info.unit.scale;
            let place = unknowns.free.iter().position(|&i| i == index);
            ParameterEstimate {
                name: info.name.clone(),
                unit: info.document.unit.clone(),
                segment: unknown
                    .segment
                    .map(|segment| problem.segments[segment].label.clone()),
                start: own(unknown.start),
                estimate: own(place.map_or(unknown.start, |place| self.theta[place])),
                standard_error: place
                    .and_then(|place| standard_errors[place])
                    .map(|error| error / info.unit.scale),
                fixed: unknown.fixed,
                at_bound: place.and_then(|place| self.held[place]),
            }
        };
        unknowns.all.iter().enumerate().map(row).collect()
    }
}
