//! Derivative techniques compared on a user's own problem: accuracy, operations, time, memory, iterations.
//!
//! After Machado 2022, section 4.3.1, whose tables and figure it makes anew: the error of the gradient against
//! the step (figure 8), operations (tables 9 to 13), times (tables 14 to 17), iterations.

mod clock;
mod descents;
mod gradients;
mod operations;
mod report;
mod underway;

use crate::estimate::evaluation::derivatives::adjoint::CostAndGradient;
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::evaluation::normal_equations::NormalEquations;
use crate::estimate::options::technique::Derivatives;
use crate::estimate::output_error::output_error;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unknowns::Unknowns;
use crate::estimate::problem::unusable::Unusable;
use clock::{Times, least, once};
use underway::Study;

pub use crate::estimate::report::study_step::StudyStep;
pub use clock::Clock;
pub use operations::{formula, operations, simulations};
pub use report::{
    CostPoint, DerivativeStudy, DescentResult, ErrorCurve, ErrorPoint, FormulaOperations,
    ProblemSize, TechniqueResult,
};
pub use underway::{Listener, NoStudy};

/// Unknowns of which the error is followed over all steps; of more, as many spread over all.
const MOST_FOLLOWED: usize = 24;

/// Most operations that a central-difference gradient may take, for a study of the problem to be made.
pub const MOST_OPERATIONS: u64 = 20_000_000_000;

/// Findings of a study: curves, techniques, costs and descents.
const FINDINGS: usize = 3 + 5 + 1 + descents::ALL.len();

/// Makes a study at the start values of a problem.
///
/// # Errors
/// The start values give no cost, or the listener wants no more.
pub fn study(
    problem: &Problem,
    clock: &dyn Clock,
    listener: &mut Listener<'_>,
) -> Result<DerivativeStudy, NoStudy> {
    let problem = with(problem, Derivatives::default());
    let theta = problem.unknowns.start();
    let equations = NormalEquations::at(&mut Evaluator::new(&problem), &theta)?;
    let error = |information: f64| {
        if information > 0.0 {
            information.sqrt().recip()
        } else {
            0.0
        }
    };
    let mut study = Study {
        errors: equations.information.diagonal().map(error),
        reference: -&equations.descent,
        weighting: equations.weighting,
        theta,
        problem,
        clock,
        listener,
        told: 0,
        findings: FINDINGS,
    };
    let size = study.size();
    let error_curves = study.error_curves()?;
    let techniques = study.techniques()?;
    let costs = study.costs()?;
    let descents = study.descents()?;
    Ok(DerivativeStudy {
        size,
        error_curves,
        techniques,
        costs,
        formula: formula(&size),
        descents,
    })
}

/// The same problem with another technique.
fn with(problem: &Problem, derivatives: Derivatives) -> Problem {
    let mut problem = problem.clone();
    problem.options.derivatives = derivatives;
    problem
}

impl Study<'_, '_> {
    fn error_curves(&mut self) -> Result<Vec<ErrorCurve>, NoStudy> {
        let count = self.theta.len();
        let followed = count.min(MOST_FOLLOWED);
        let places: Vec<usize> = (0..followed).map(|i| i * count / followed).collect();
        let decades = |exponents: &mut dyn Iterator<Item = i32>| -> Vec<f64> {
            exponents.map(|exponent| 10_f64.powi(exponent)).collect()
        };
        let real = decades(&mut (0..=16).map(|k| -k));
        let mut complex = decades(&mut (0..=10).map(|k| -2 * k));
        complex.extend([1e-30, 1e-50, 1e-100, 1e-150, 1e-200, 1e-250, 1e-300]);
        type Make = fn(f64) -> Derivatives;
        let kinds: [(Make, &[f64]); 3] = [
            (|step| Derivatives::ForwardDifference { step }, &real),
            (|step| Derivatives::CentralDifference { step }, &real),
            (|step| Derivatives::ComplexStep { step }, &complex),
        ];
        let mut curves = Vec::new();
        for (make, steps) in kinds {
            let mut points = Vec::new();
            for &step in steps {
                self.go_on()?;
                // a step too far is a finding, not the end
                let found = self.gradient(&make(step), &places).ok();
                let error = found.and_then(|found| self.error(&found, &places));
                points.push(ErrorPoint { step, error });
            }
            let curve = ErrorCurve {
                technique: make(0.1).name().to_string(),
                points,
            };
            let finding = match curve.best() {
                Some((step, error)) => format!(
                    "{}: the gradient's error is least, {error:.1e}, with the step {step:.0e}",
                    curve.technique
                ),
                None => format!("{}: no step gives a gradient", curve.technique),
            };
            self.tell(finding)?;
            curves.push(curve);
        }
        Ok(curves)
    }

    fn techniques(&mut self) -> Result<Vec<TechniqueResult>, NoStudy> {
        let places = self.all_places();
        let mut rows = Vec::new();
        let mut costs = Vec::new();
        for technique in Derivatives::all() {
            let clock = self.clock;
            let (found, times) = least(clock, || self.gradient(&technique, &places));
            let found = found?;
            let own = with(&self.problem, technique);
            let (estimated, whole) =
                once(clock, || output_error(&own, &mut |_| (self.listener)(None)));
            let estimate = estimated?.estimate;
            self.go_on()?;
            costs.push(estimate.cost);
            let reference = matches!(technique, Derivatives::ForwardSensitivities {});
            let row = TechniqueResult {
                technique: technique.name().to_string(),
                gradient_error: self.error(&found, &places).filter(|_| !reference),
                operations: operations(&self.problem, &technique),
                simulations: simulations(&self.problem, &technique),
                bytes: self.bytes(&technique)?,
                cpu_seconds: times.cpu,
                wall_seconds: times.wall,
                iterations: estimate.iterations,
                outcome: estimate.outcome.name().to_string(),
                estimation_wall_seconds: whole.wall,
                estimation_cpu_seconds: whole.cpu,
                cost_excess: 0.0,
            };
            self.tell(format!(
                "{}: {} after {} iterations",
                row.technique, row.outcome, row.iterations
            ))?;
            rows.push(row);
        }
        let lowest = costs.iter().copied().fold(f64::INFINITY, f64::min);
        for (row, cost) in rows.iter_mut().zip(costs) {
            row.cost_excess = cost - lowest;
        }
        Ok(rows)
    }

    fn bytes(&self, technique: &Derivatives) -> Result<usize, Unusable> {
        Ok(match technique {
            Derivatives::Adjoint { .. } => {
                let mut adjoint = CostAndGradient::new(&self.problem);
                adjoint.at(&self.theta)?;
                adjoint.bytes()
            }
            Derivatives::ForwardSensitivities {} => operations::sensitivity_bytes(&self.problem),
            other => operations::perturbation_bytes(&self.problem, other),
        })
    }

    /// One gradient with 1, 2, 4, ... and all of the unknowns free.
    fn costs(&mut self) -> Result<Vec<CostPoint>, NoStudy> {
        let parameters: usize = self.problem.model.parameters.len();
        let free = |problem: &Problem| problem.unknowns.len();
        let mut points: Vec<CostPoint> = Vec::new();
        let mut count = 1;
        while points
            .last()
            .is_none_or(|last| last.unknowns < self.theta.len())
            && count <= 2 * parameters
        {
            self.go_on()?;
            let some = restricted(&self.problem, count);
            let unknowns = free(&some);
            count *= 2;
            if unknowns == 0 || points.last().is_some_and(|last| last.unknowns == unknowns) {
                continue;
            }
            let theta = some.unknowns.start();
            let (direct, adjoint) = (Derivatives::default(), Derivatives::adjoint());
            let time = |technique: &Derivatives| -> Result<Times, Unusable> {
                let places: Vec<usize> = (0..unknowns).collect();
                let (done, times) = least(self.clock, || {
                    gradients::gradient(&some, technique, &theta, &places, &self.weighting)
                });
                done.map(|_| times)
            };
            points.push(CostPoint {
                unknowns,
                direct_operations: operations(&some, &direct),
                adjoint_operations: operations(&some, &adjoint),
                direct_wall_seconds: time(&direct)?.wall,
                adjoint_wall_seconds: time(&adjoint)?.wall,
            });
        }
        if let Some(last) = points.last() {
            let ratio = last.direct_operations as f64 / last.adjoint_operations as f64;
            let unknowns = last.unknowns;
            self.tell(format!(
                "a direct gradient by {unknowns} unknowns takes {ratio:.2} times the operations of an adjoint one"
            ))?;
        }
        Ok(points)
    }
}

/// The same problem with only the first `count` of its free parameters free.
fn restricted(problem: &Problem, count: usize) -> Problem {
    let mut model = problem.model.clone();
    let mut left = count;
    for (parameter, info) in model.parameters.iter_mut().enumerate() {
        let mut unknowns = problem
            .unknowns
            .all
            .iter()
            .filter(|u| u.parameter == parameter);
        let free = unknowns.any(|unknown| !unknown.fixed) && left > 0;
        info.document.fixed = !free;
        left -= usize::from(free);
    }
    let start = |parameter: usize, segment: usize| -> Result<f64, std::convert::Infallible> {
        let own = |u: &&crate::estimate::problem::unknowns::Unknown| {
            u.parameter == parameter && u.segment.is_none_or(|own| own == segment)
        };
        let unknown = problem.unknowns.all.iter().find(own);
        Ok(unknown.map_or(0.0, |unknown| unknown.start))
    };
    let Ok(unknowns) = Unknowns::new(&model, problem.segments.len(), start);
    let unknowns = unknowns.held_elsewhere(&model, |segment, label| {
        problem.segments[segment].label == label
    });
    Problem::new(
        model,
        problem.segments.clone(),
        unknowns,
        problem.options.clone(),
    )
}
