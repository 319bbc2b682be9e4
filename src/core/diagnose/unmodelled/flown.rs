//! Flights as a model sees them near its fit: residuals, and what moves with everything that is free.

use std::ops::Range;

use nalgebra::DMatrix;

use crate::diagnose::case::Case;
use crate::diagnose::fitted::Fitted;
use crate::diagnose::stack::{Layout, sensitivities};
use crate::estimate::{ErrorBoundsKind, Problem, Role, Unknowns, predict};
use crate::model::Per;

/// Residuals and their sensitivities: what a metric is made from.
#[derive(Clone)]
pub(super) struct Samples {
    pub layout: Layout,
    /// Measured minus model; NaN where there is no sample.
    pub residual: Vec<f64>,
    /// ∂y/∂θ of all that is free, one column each.
    pub declared: DMatrix<f64>,
}

/// A model along some flights, linearised at θ.
pub(super) struct Flown {
    pub problem: Problem,
    pub theta: Vec<f64>,
    pub samples: Samples,
    /// So many of the flights were fitted, and come first; the others were predicted.
    pub fitted: usize,
}

/// What belongs to a flight is estimated on it to the end.
const ITERATIONS: usize = 50;

impl Flown {
    /// The flights that a model was fitted to. `None` where the simulation leaves the range of numbers.
    pub(super) fn fitted(fitted: &Fitted) -> Option<Self> {
        let flights = fitted.problem.segments.len();
        let residual = fitted.residual.clone();
        Self::at(
            fitted.problem.clone(),
            fitted.theta.clone(),
            residual,
            flights,
        )
    }

    /// The flights that a model was fitted to, and those held out to validate it.
    pub(super) fn all(case: &Case, fitted: &Fitted) -> Option<Self> {
        let problem = &fitted.problem;
        let held_out = case.held_out(Role::Validation, problem).ok()?;
        let mut predicting = problem.clone();
        predicting.options.error_bounds = ErrorBoundsKind::Conventional;
        predicting.options.max_iterations = ITERATIONS;
        let mut known: Vec<Vec<f64>> = (0..problem.segments.len())
            .map(|segment| parameters(problem, &fitted.theta, segment))
            .collect();
        let mut residual = fitted.residual.clone();
        let mut segments = problem.segments.clone();
        for flight in held_out {
            let (theta, covariance) = (&fitted.theta, &fitted.covariance);
            let (prediction, history) = predict(&predicting, theta, covariance, &flight);
            let mut values = Vec::new();
            let own = &flight.unknowns;
            own.parameters(0, &own.start(), &mut values);
            for (parameter, info) in problem.model.parameters.iter().enumerate() {
                let mut rows = prediction.parameters.iter();
                if info.document.per == Per::Job {
                    values[parameter] = known[0][parameter];
                } else if let Some(row) = rows.find(|row| row.name == info.name) {
                    values[parameter] = info.unit.to_si(row.estimate);
                }
            }
            known.push(values);
            let outputs = history?.outputs;
            residual.extend(outputs.iter().flat_map(|output| &output.residual));
            segments.push(flight.segment);
        }
        let start = |parameter: usize, segment: usize| Ok::<f64, ()>(known[segment][parameter]);
        let unknowns = Unknowns::new(&problem.model, segments.len(), start).ok()?;
        let unknowns =
            unknowns.held_elsewhere(&problem.model, |at, label| segments[at].label == label);
        let theta = unknowns.start();
        let options = problem.options.clone();
        let all = Problem::new(problem.model.clone(), segments, unknowns, options);
        Self::at(all, theta, residual, problem.segments.len())
    }

    fn at(problem: Problem, theta: Vec<f64>, residual: Vec<f64>, fitted: usize) -> Option<Self> {
        let layout = Layout::of(&problem);
        let unknowns = &problem.unknowns;
        let places = (0..unknowns.len()).map(|place| unknowns.at(place).parameter);
        let mut free: Vec<usize> = places.collect();
        free.sort_unstable();
        free.dedup();
        // a parameter of each flight has a column for each, also for those in which it is held
        let flights = problem.segments.len();
        let of = |&parameter: &usize| {
            let count = match problem.model.parameters[parameter].document.per {
                Per::Job => 1,
                Per::Maneuver => flights,
            };
            (0..count).map(move |flight| (parameter, flight))
        };
        let columns: Vec<Vec<f64>> = sensitivities(&problem, &layout, &theta, &free)
            .ok()?
            .into_iter()
            .zip(free.iter().flat_map(of))
            .filter(|(_, (parameter, flight))| unknowns.place(*flight, *parameter).is_some())
            .map(|(column, _)| column)
            .collect();
        let declared = DMatrix::from_fn(layout.len, columns.len(), |row, column| {
            columns[column][row]
        });
        Some(Self {
            problem,
            theta,
            samples: Samples {
                layout,
                residual,
                declared,
            },
            fitted,
        })
    }

    /// All parameters of the model along a segment.
    pub(super) fn parameters(&self, segment: usize) -> Vec<f64> {
        parameters(&self.problem, &self.theta, segment)
    }

    /// The rows of a segment in a column.
    pub(super) fn rows(&self, segment: usize) -> Range<usize> {
        let series = self.samples.layout.series.iter();
        let mut series = series.filter(|series| series.segment == segment);
        let first = series.next().map_or(0..0, |series| series.range.clone());
        let last = series.next_back();
        first.start..last.map_or(first.end, |last| last.range.end)
    }
}

fn parameters(problem: &Problem, theta: &[f64], segment: usize) -> Vec<f64> {
    let mut values = Vec::new();
    problem.unknowns.parameters(segment, theta, &mut values);
    values
}
