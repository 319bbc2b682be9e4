//! What the length of integration steps does to an estimate: where it would go if each step were halved.
//!
//! With Δy what halving the steps adds to the outputs, one Gauss-Newton step says where the estimate goes:
//!
//! ```text
//! Δθ = -F⁻¹ Σ_k S_kᵀ R⁻¹ Δy_k,   |Δθ_i| / σ_i ≤ √(Σ_k Δy_kᵀ R⁻¹ Δy_k)
//! ```
//!
//! with σ the square root of the diagonal of F⁻¹ (Cauchy-Schwarz). The bound takes a simulation without sensitivities; only
//! where it is not small, the sensitivities are looked at too. Of a method of order p, the shift is all but one part in
//! 2^p of the whole error.

use nalgebra::{DMatrix, DVector};

use super::error_bounds::ErrorBounds;
use crate::estimate::descent::iterate::Iterate;
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::problem::Problem;
use crate::estimate::problem::substeps::halved;
use crate::estimate::report::history::TimeHistory;
use crate::estimate::report::integration::{HalvedSteps, Integration};
use crate::simulate::{Block, Outputs, Rates, Segment, StateMatrixAt};

/// A bound below this is answer enough.
const SMALL: f64 = 0.02;

/// At the end of an output-error estimation, whose histories are those of the iterate.
pub(crate) fn integration(
    problem: &Problem,
    evaluator: &mut Evaluator<'_>,
    at: &Iterate,
    bounds: &ErrorBounds,
    histories: &[TimeHistory],
) -> Integration {
    let mut fastest: f64 = 0.0;
    let mut changes = Vec::new();
    let mut square = 0.0;
    let mut machinery = Outputs::new(
        &problem.model,
        problem.options.integrator,
        problem.options.input_interpolation,
    );
    evaluator.simulations += 1;
    let mut parameters = Vec::new();
    for (index, segment) in problem.segments.iter().enumerate() {
        problem
            .unknowns
            .parameters(index, &at.theta, &mut parameters);
        let change = changed(&mut machinery, segment, &parameters, &histories[index]);
        let rates = rates_along(problem, &machinery, segment, &parameters);
        fastest = fastest.max(rates.fastest * step(segment));
        square += size(&change, &at.weighting.inverse);
        changes.push(change);
    }
    Integration {
        steps_per_sample: steps_per_sample(problem),
        fastest,
        halved: bounds
            .kind
            .is_some()
            .then(|| {
                let most = square.sqrt();
                if most <= SMALL {
                    return Some(HalvedSteps {
                        most,
                        shifts: Vec::new(),
                    });
                }
                let pull = pull(problem, evaluator, at, &changes)?;
                Some(shifts(at, &bounds.standard_errors, &-pull))
            })
            .flatten()
            .filter(|halved| halved.most.is_finite()),
    }
}

/// By segment.
pub(crate) fn steps_per_sample(problem: &Problem) -> Vec<usize> {
    problem
        .segments
        .iter()
        .map(Segment::most_substeps)
        .collect()
}

/// The longest integration step, s.
pub(crate) fn step(segment: &Segment) -> f64 {
    segment.steps.longest() / segment.most_substeps() as f64
}

/// Δθ in standard errors, for a descent direction that halving the steps adds.
pub(crate) fn shifts(at: &Iterate, errors: &[Option<f64>], descent: &DVector<f64>) -> HalvedSteps {
    let covariance = ErrorBounds::conventional(&at.information, &at.held).covariance;
    shifts_of(&covariance, errors, descent)
}

/// As [`shifts`], with F⁻¹.
pub(crate) fn shifts_of(
    covariance: &DMatrix<f64>,
    errors: &[Option<f64>],
    descent: &DVector<f64>,
) -> HalvedSteps {
    let moved = covariance * descent;
    let shift = |(error, moved): (&Option<f64>, &f64)| {
        let shift = moved / (*error)?;
        shift.is_finite().then_some(shift)
    };
    let shifts: Vec<Option<f64>> = errors.iter().zip(moved.iter()).map(shift).collect();
    let most = shifts.iter().flatten();
    HalvedSteps {
        most: most.fold(0.0, |most, shift| most.max(shift.abs())),
        shifts,
    }
}

/// Δy by output, then sample: 0 where nothing was measured, and everywhere where halved steps leave the range of numbers,
/// which whole ones do not.
fn changed(
    machinery: &mut Outputs<'_>,
    segment: &Segment,
    parameters: &[f64],
    history: &TimeHistory,
) -> Vec<Vec<f64>> {
    let finer = Segment {
        substeps: halved(segment),
        ..segment.clone()
    };
    let mut change: Vec<Vec<f64>> = vec![Vec::with_capacity(segment.len()); segment.measured.len()];
    let run = machinery.run(&finer, parameters, |first, y| {
        for ((change, y), series) in change.iter_mut().zip(y).zip(&history.outputs) {
            let before = series.model[first..].iter().zip(&series.measured[first..]);
            change.extend(
                y.iter()
                    .zip(before)
                    .map(|(y, (before, z))| match z.is_nan() {
                        true => 0.0,
                        false => y - before,
                    }),
            );
        }
    });
    if run.is_err() {
        change.iter_mut().for_each(|change| {
            change.clear();
            change.resize(segment.len(), 0.0);
        });
    }
    change
}

/// Along the states that the last run of the machinery went through.
fn rates_along(
    problem: &Problem,
    machinery: &Outputs<'_>,
    segment: &Segment,
    parameters: &[f64],
) -> Rates {
    let mut matrix = StateMatrixAt::new(&problem.model, parameters);
    let at_start = matrix.rates_at_start(segment, parameters);
    if matrix.is_constant() {
        return at_start;
    }
    let passed = machinery.passed().iter();
    passed
        .map(|(sample, state)| matrix.rates(segment, *sample, state))
        .fold(at_start, Rates::and)
}

/// Σ_k Δy_kᵀ R⁻¹ Δy_k
fn size(change: &[Vec<f64>], inverse: &DMatrix<f64>) -> f64 {
    let mut sum = 0.0;
    for (i, a) in change.iter().enumerate() {
        for (j, b) in change.iter().enumerate() {
            if inverse[(i, j)] != 0.0 {
                sum += inverse[(i, j)] * a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            }
        }
    }
    sum
}

/// Σ_k S_kᵀ R⁻¹ Δy_k, by place of θ.
fn pull(
    problem: &Problem,
    evaluator: &mut Evaluator<'_>,
    at: &Iterate,
    changes: &[Vec<Vec<f64>>],
) -> Option<DVector<f64>> {
    let inverse = &at.weighting.inverse;
    let mut total = DVector::zeros(at.theta.len());
    evaluator.evaluations += 1;
    for (index, change) in changes.iter().enumerate() {
        let add = |block: &Block<'_>| {
            for i in 0..change.len() {
                let places: Vec<Option<usize>> = (problem.columns.of_output(i).iter())
                    .map(|&parameter| problem.unknowns.place(index, parameter))
                    .collect();
                for k in 0..block.len {
                    let weighted: f64 = (change.iter().enumerate())
                        .map(|(j, change)| inverse[(i, j)] * change[block.first + k])
                        .sum();
                    for (place, s) in places.iter().zip(block.row(i, k)) {
                        if let Some(place) = *place {
                            total[place] += weighted * s;
                        }
                    }
                }
            }
        };
        evaluator.sweep(&at.theta, index, add).ok()?;
    }
    Some(total)
}
