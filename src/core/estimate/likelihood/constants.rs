//! The cost of outputs that stay at their means.

use nalgebra::DMatrix;

use super::weighting::Weighting;
use crate::estimate::problem::Problem;

/// -ln L of outputs that stay at their means: a start that is worse explains nothing.
pub(crate) fn cost_of_constants(problem: &Problem) -> Option<f64> {
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

/// Values less their mean; those that are not finite count as 0.
fn centred(values: &[f64]) -> Vec<f64> {
    let numbers: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    let mean = numbers.iter().sum::<f64>() / numbers.len().max(1) as f64;
    let less = |&value: &f64| if value.is_finite() { value - mean } else { 0.0 };
    values.iter().map(less).collect()
}
