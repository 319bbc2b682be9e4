//! The gradient of the cost with R held, by each technique, and nothing else: what the study times and compares.

use nalgebra::DVector;

use crate::estimate::evaluation::derivatives::adjoint::CostAndGradient;
use crate::estimate::evaluation::derivatives::central_difference::CentralDifference;
use crate::estimate::evaluation::derivatives::complex_step::ComplexStep;
use crate::estimate::evaluation::derivatives::forward_difference::ForwardDifference;
use crate::estimate::evaluation::derivatives::perturbation::{Perturbation, columns};
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::options::technique::Derivatives;
use crate::estimate::problem::Problem;
use crate::estimate::problem::missing::present;
use crate::estimate::problem::unusable::{Unusable, left_range};
use crate::simulate::Sensitivities;

/// ∂J/∂θ at some places of θ. The adjoint makes R anew from the same residuals, as it always does.
pub(super) fn gradient(
    problem: &Problem,
    technique: &Derivatives,
    theta: &[f64],
    places: &[usize],
    weighting: &Weighting,
) -> Result<DVector<f64>, Unusable> {
    match *technique {
        Derivatives::ForwardDifference { step } => perturbed(
            &ForwardDifference { step },
            problem,
            theta,
            places,
            weighting,
        ),
        Derivatives::CentralDifference { step } => perturbed(
            &CentralDifference { step },
            problem,
            theta,
            places,
            weighting,
        ),
        Derivatives::ComplexStep { step } => {
            perturbed(&ComplexStep { step }, problem, theta, places, weighting)
        }
        Derivatives::ForwardSensitivities {} => {
            direct(problem, theta, weighting).map(|all| all.select_rows(places))
        }
        Derivatives::Adjoint { .. } => CostAndGradient::new(problem)
            .at(theta)
            .map(|(_, all)| all.select_rows(places)),
    }
}

fn perturbed<P: Perturbation>(
    technique: &P,
    problem: &Problem,
    theta: &[f64],
    places: &[usize],
    weighting: &Weighting,
) -> Result<DVector<f64>, Unusable> {
    let mut total = DVector::zeros(problem.unknowns.len());
    let outputs = problem.model.outputs.len();
    let (mut residual, mut weighted) = (vec![0.0; outputs], vec![0.0; outputs]);
    for index in 0..problem.segments.len() {
        let mut own: Vec<f64> = Vec::new();
        let at = columns(technique, problem, index, theta, places, |stretch| {
            own.resize(stretch.slopes[0].ncols(), 0.0);
            for k in 0..stretch.residuals[0].len() {
                residual
                    .iter_mut()
                    .zip(stretch.residuals)
                    .for_each(|(to, e)| *to = e[k]);
                weighting.weighted(&residual, &mut weighted);
                for (slopes, &e) in stretch.slopes.iter().zip(&weighted) {
                    for (column, own) in own.iter_mut().enumerate() {
                        *own -= slopes[(k, column)] * e;
                    }
                }
            }
        })?;
        at.iter()
            .zip(&own)
            .for_each(|(&place, value)| total[place] += value);
    }
    Ok(total.select_rows(places))
}

fn direct(
    problem: &Problem,
    theta: &[f64],
    weighting: &Weighting,
) -> Result<DVector<f64>, Unusable> {
    let (options, columns) = (&problem.options, &problem.columns);
    let (integrator, interpolation) = (options.integrator, options.input_interpolation);
    let mut machinery = Sensitivities::new(&problem.model, columns, integrator, interpolation);
    let outputs = problem.model.outputs.len();
    let (mut residual, mut weighted) = (vec![0.0; outputs], vec![0.0; outputs]);
    let mut total = DVector::zeros(problem.unknowns.len());
    let mut parameters = Vec::new();
    for (index, segment) in problem.segments.iter().enumerate() {
        problem.unknowns.parameters(index, theta, &mut parameters);
        let mut own: Vec<Vec<f64>> = (0..outputs)
            .map(|output| vec![0.0; columns.of_output(output).len()])
            .collect();
        let done = machinery.run(segment, &parameters, |block| {
            for k in 0..block.len {
                for (output, e) in residual.iter_mut().enumerate() {
                    let measured = segment.measured[output][block.first + k];
                    *e = present(measured - block.output(output)[k], measured);
                }
                weighting.weighted(&residual, &mut weighted);
                for (output, own) in own.iter_mut().enumerate() {
                    for (to, slope) in own.iter_mut().zip(block.row(output, k)) {
                        *to -= slope * weighted[output];
                    }
                }
            }
        });
        done.map_err(|diverged| left_range(index, &diverged))?;
        for (output, own) in own.iter().enumerate() {
            for (&parameter, value) in columns.of_output(output).iter().zip(own) {
                if let Some(place) = problem.unknowns.place(index, parameter) {
                    total[place] += value;
                }
            }
        }
    }
    Ok(total)
}
