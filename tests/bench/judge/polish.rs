//! Fits under noise whose colour is known: output error, and then one step of least squares on whitened residuals, since
//! output error alone takes the noise for white.

use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector};
use serde_json::Value;
use trimtab_core::estimate::{Estimate, Problem, Solution, StartMethod, estimate};
use trimtab_core::model::ModelDocument;

use crate::job::plan;
use crate::likelihood::{Residuals, innovations, of_histories};
use crate::noise::Noise;
use crate::record::Recording;

/// What a fit leaves of the flights that it is made to; in words why there is none. Standard deviations of the noise are
/// `known`, or those of what is left.
pub(crate) fn fitted(
    document: &ModelDocument,
    recordings: &[Recording],
    options: &Value,
    noises: &[Noise],
    known: Option<&[f64]>,
) -> Result<Residuals, String> {
    let flights: Vec<&Recording> = recordings.iter().filter(|r| r.fitted).collect();
    let mut problem = plan("estimate", document, &flights, options)?.problem;
    let solution = solve(&problem).ok_or("it leaves the range of numbers")?;
    let left = of_histories(&solution.histories);
    if noises.iter().all(|noise| !noise.is_coloured()) {
        return Ok(left);
    }
    let theta = values(&problem, &solution.estimate);
    problem.options.max_iterations = 0;
    problem.options.start = StartMethod::Document {};
    Ok(stepped(&mut problem, &theta, &left, noises, known).unwrap_or(left))
}

fn solve(problem: &Problem) -> Option<Solution> {
    estimate(problem, &mut |_| ControlFlow::Continue(())).ok()
}

/// Free unknowns: place among all of them, value and a step of half a standard error, SI.
fn values(problem: &Problem, estimate: &Estimate) -> Vec<(usize, f64, f64)> {
    let of = |&place: &usize| {
        let unknown = &problem.unknowns.all[place];
        let info = &problem.model.parameters[unknown.parameter];
        let label = unknown
            .segment
            .map(|segment| &problem.segments[segment].label);
        let is_it = |row: &&trimtab_core::estimate::ParameterEstimate| {
            let same_flight = row.segment.is_none() || row.segment.as_ref() == label;
            row.name == info.name && same_flight
        };
        let row = estimate.parameters.iter().find(is_it)?;
        let value = info.unit.to_si(row.estimate);
        let error = row.standard_error.filter(|e| e.is_finite() && *e > 0.0);
        let step = error.map_or(1e-5 * value.abs().max(1e-3), |e| 0.5 * e * info.unit.scale);
        Some((place, value, step))
    };
    problem.unknowns.free.iter().filter_map(of).collect()
}

/// Residuals with unknowns at these values.
fn at(problem: &mut Problem, theta: &[(usize, f64, f64)]) -> Option<Residuals> {
    for (place, value, _) in theta {
        let unknown = &mut problem.unknowns.all[*place];
        unknown.start = value.clamp(unknown.lower, unknown.upper);
    }
    Some(of_histories(&solve(problem)?.histories))
}

/// Residuals after a step of whitened least squares, if it is one for the better.
fn stepped(
    problem: &mut Problem,
    theta: &[(usize, f64, f64)],
    left: &Residuals,
    noises: &[Noise],
    known: Option<&[f64]>,
) -> Option<Residuals> {
    let white = innovations(left, noises);
    let deviations = known.map_or_else(
        || white.iter().map(|w| mean_square(w).sqrt()).collect(),
        <[f64]>::to_vec,
    );
    let scaled = |white: &[Vec<f64>]| -> Vec<f64> {
        let of =
            |(w, deviation): (&Vec<f64>, &f64)| w.iter().map(|w| w / deviation).collect::<Vec<_>>();
        white.iter().zip(&deviations).flat_map(of).collect()
    };
    let start = scaled(&white);
    let mut columns = Vec::new();
    for j in 0..theta.len() {
        let mut moved = theta.to_vec();
        moved[j].1 += moved[j].2;
        let there = scaled(&innovations(&at(problem, &moved)?, noises));
        columns.push(DVector::from_iterator(
            start.len(),
            there.iter().zip(&start).map(|(a, b)| a - b),
        ));
    }
    let matrix = DMatrix::from_columns(&columns);
    let normal = matrix.transpose() * &matrix;
    let right = -(matrix.transpose() * DVector::from_vec(start.clone()));
    let step = normal.svd(true, true).solve(&right, 1e-9).ok()?;
    let mut moved = theta.to_vec();
    moved
        .iter_mut()
        .zip(step.iter())
        .for_each(|(unknown, by)| unknown.1 += by * unknown.2);
    let there = at(problem, &moved)?;
    let squares = |white: &[Vec<f64>]| scaled(white).iter().map(|w| w * w).sum::<f64>();
    (squares(&innovations(&there, noises)) < squares(&white)).then_some(there)
}

fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64
}
