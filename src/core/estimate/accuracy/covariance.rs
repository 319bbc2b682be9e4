//! An estimate that was kept, as numbers to go on with: θ and the covariance P of its errors, SI.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::estimate::problem::Problem;
use crate::estimate::problem::unknowns::Unknowns;
use crate::estimate::report::estimate::Estimate;
use crate::estimate::report::parameter::ParameterEstimate;

/// θ of an estimate, and what its errors carry over to.
pub(crate) struct Estimated {
    /// Free and fixed ones where they were estimated.
    pub unknowns: Unknowns,
    /// By place.
    pub theta: Vec<f64>,
    /// P; rows of unknowns without a standard error are zero.
    covariance: DMatrix<f64>,
    /// By place of θ: whether it has a standard error.
    is_known: Vec<bool>,
}

impl Estimated {
    /// The estimate of a problem, from its report.
    pub(crate) fn of(problem: &Problem, estimate: &Estimate) -> Self {
        let unknowns = &problem.unknowns;
        let unit = |index: usize| problem.model.parameters[unknowns.all[index].parameter].unit;
        let rows = estimate.parameters.iter().enumerate();
        let values: Vec<f64> = rows
            .map(|(index, row)| unit(index).to_si(row.estimate))
            .collect();
        let unknowns = unknowns.with_starts(&values);
        let correlation = &estimate.correlation;
        let is_whole = correlation.len() == unknowns.len();
        let errors: Vec<Option<f64>> = (unknowns.free.iter())
            .map(|&index| Some(estimate.parameters[index].standard_error? * unit(index).scale))
            .map(|error| error.filter(|error| is_whole && error.is_finite()))
            .collect();
        let covariance = |i: usize, j: usize| match (errors[i], errors[j]) {
            (Some(a), Some(b)) => a * b * correlation[i][j],
            _ => 0.0,
        };
        Self {
            theta: unknowns.start(),
            covariance: DMatrix::from_fn(errors.len(), errors.len(), covariance),
            is_known: errors.iter().map(Option::is_some).collect(),
            unknowns,
        }
    }

    /// The same estimate over the segments of another problem, whose shared parameters are where it has them and whose other
    /// parameters are held: what is free is shared.
    pub(crate) fn carried(problem: &Problem, estimate: &Estimate) -> Self {
        let unknowns = problem.unknowns.clone();
        let free: Vec<&ParameterEstimate> = estimate
            .parameters
            .iter()
            .filter(|row| !row.fixed)
            .collect();
        let is_whole = estimate.correlation.len() == free.len();
        // by place here: the place there, and the standard error, SI
        let there: Vec<Option<(usize, f64)>> = (0..unknowns.len())
            .map(|place| {
                let parameter = problem.parameter(place);
                let of =
                    |row: &&ParameterEstimate| row.segment.is_none() && row.name == parameter.name;
                let there = free.iter().position(of)?;
                let error = free[there].standard_error? * parameter.unit.scale;
                (is_whole && error.is_finite()).then_some((there, error))
            })
            .collect();
        let covariance = |i: usize, j: usize| match (there[i], there[j]) {
            (Some((i, a)), Some((j, b))) => a * b * estimate.correlation[i][j],
            _ => 0.0,
        };
        Self {
            theta: unknowns.start(),
            covariance: DMatrix::from_fn(there.len(), there.len(), covariance),
            is_known: there.iter().map(Option::is_some).collect(),
            unknowns,
        }
    }

    /// A root of P: R Rᵀ = P, by the eigenvectors of the correlations, so that units of any size do no harm.
    pub(crate) fn covariance_root(&self) -> DMatrix<f64> {
        let n = self.theta.len();
        let errors: Vec<f64> = (0..n)
            .map(|i| self.covariance[(i, i)].max(0.0).sqrt())
            .collect();
        let correlation = DMatrix::from_fn(n, n, |i, j| match errors[i] * errors[j] {
            0.0 => f64::from(u8::from(i == j)),
            product => self.covariance[(i, j)] / product,
        });
        let spectrum = SymmetricEigen::new(correlation);
        DMatrix::from_fn(n, n, |i, k| {
            errors[i] * spectrum.eigenvectors[(i, k)] * spectrum.eigenvalues[k].max(0.0).sqrt()
        })
    }

    /// P over some places.
    pub(crate) fn among(&self, places: &[usize]) -> DMatrix<f64> {
        (self.covariance).select_rows(places).select_columns(places)
    }

    /// Whether something with these slopes by some places depends on nothing that has no standard error.
    pub(crate) fn is_known(&self, places: &[usize], slopes: &[f64]) -> bool {
        let mut slopes = places.iter().zip(slopes);
        slopes.all(|(&place, slope)| self.is_known[place] || *slope == 0.0)
    }

    /// √(dᵀ P d) of a quantity with the derivatives d by place of θ; none where it depends on an unknown that has no
    /// standard error.
    pub(crate) fn standard_error(&self, derivatives: &[f64]) -> Option<f64> {
        let places: Vec<usize> = (0..derivatives.len())
            .filter(|&place| derivatives[place] != 0.0)
            .collect();
        let slopes: Vec<f64> = places.iter().map(|&place| derivatives[place]).collect();
        if !self.is_known(&places, &slopes) {
            return None;
        }
        let slopes = DVector::from_vec(slopes);
        let variance = slopes.dot(&(self.among(&places) * &slopes));
        Some(variance.max(0.0).sqrt()).filter(|error| error.is_finite())
    }
}
