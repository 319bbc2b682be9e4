//! Modes of the motion: eigenvalues of the state matrix at the estimate, with error bounds.
//!
//! A(θ) = ∂f/∂x, A r = λ r, lᴴ A = λ lᴴ, and dλ/dθ = lᴴ (dA/dθ) r / (lᴴ r) (first-order perturbation, Golub and Van
//! Loan, Matrix Computations, sec. 7.2.2). Error bounds follow from the covariance of the estimate by the delta method;
//! fixed parameters count as known.
//!
//! Where A is not the same at all states and inputs, it is taken at the start of the segment: x0(θ) and the first
//! sample of the inputs, where a maneuver is trimmed.

use nalgebra::{Complex, DMatrix, DVector, Schur};

use super::error_bounds::ErrorBounds;
use super::mode_name::{mode_name, only_once};
use super::state_matrix::{StateMatrix, feeding_back, is_kinematic};
use crate::estimate::problem::Problem;
use crate::estimate::report::mode::{Measure, Mode};
use crate::flight::PhysicalQuantity;
use crate::model::Quantities;

/// Largest standard error of an eigenvalue, relative to its distance from the next one, at which the
/// perturbation is still of first order: at two standard errors the discriminant of a close pair has then
/// changed by less than itself.
const NEAR: f64 = 0.1;

/// States that take at least this share of the largest participation are named.
const TAKES_PART: f64 = 0.5;

/// The modes at θ, SI, fastest first; none for models of kinematics and where an entry is not finite.
pub(crate) fn modes(problem: &Problem, theta: &[f64], bounds: &ErrorBounds) -> Vec<Mode> {
    let model = &problem.model;
    if is_kinematic(model) {
        return Vec::new();
    }
    let states = feeding_back(model);
    let known = Quantities::of(&model.document);
    let quantities: Vec<_> = (states.iter())
        .map(|&state| known.get(&model.states[state].name))
        .collect();
    let mut all = Vec::new();
    for segment in 0..problem.segments.len() {
        let Some(matrix) = StateMatrix::at(problem, segment, theta, &states) else {
            continue;
        };
        let is_everywhere = matrix.is_everywhere;
        let label = (!is_everywhere).then(|| problem.segments[segment].label.clone());
        let found = of_matrix(problem, &states, &quantities, matrix, bounds, label);
        all.extend(found.unwrap_or_default());
        if is_everywhere {
            break;
        }
    }
    all
}

/// The modes of one state matrix; none where the decomposition fails.
fn of_matrix(
    problem: &Problem,
    states: &[usize],
    quantities: &[Option<PhysicalQuantity>],
    mut matrix: StateMatrix,
    bounds: &ErrorBounds,
    segment: Option<String>,
) -> Option<Vec<Mode>> {
    matrix.balance();
    let n = states.len();
    let eigenvalues =
        Schur::try_new(matrix.value.clone(), f64::EPSILON, 10_000)?.complex_eigenvalues();
    let mut modes = Vec::new();
    for (i, &eigenvalue) in eigenvalues.iter().enumerate() {
        if eigenvalue.im < 0.0 {
            continue;
        }
        let (left, right) = eigenvectors(&matrix.value, eigenvalue)?;
        let product = left.dotc(&right);
        let gradient: Vec<Complex<f64>> = (matrix.by_place.iter())
            .map(|by| left.dotc(&(by.map(Complex::from) * &right)) / product)
            .collect();
        let nearest = (eigenvalues.iter().enumerate())
            .filter(|&(j, _)| j != i)
            .map(|(_, other)| (other - eigenvalue).norm())
            .fold(f64::INFINITY, f64::min);
        let delta = Delta::new(bounds, &gradient, nearest);
        let share = |k: usize| (left[k].conj() * right[k]).norm();
        let shares: Vec<f64> = (0..n).map(share).collect();
        let name = mode_name(quantities, &shares, eigenvalue.im > 0.0);
        let largest = (0..n).map(share).fold(0.0, f64::max);
        let mut taking: Vec<usize> = (0..n)
            .filter(|&k| share(k) >= TAKES_PART * largest)
            .collect();
        taking.sort_by(|&a, &b| share(b).total_cmp(&share(a)));
        let names = (taking.into_iter())
            .map(|k| problem.model.states[states[k]].name.clone())
            .collect();
        modes.push(Mode {
            name,
            ..mode(eigenvalue, names, &delta, segment.clone())
        });
    }
    let mut names: Vec<_> = modes.iter().map(|mode| mode.name).collect();
    only_once(&mut names);
    (modes.iter_mut().zip(names)).for_each(|(mode, name)| mode.name = name);
    let size = |mode: &Mode| mode.real.value.hypot(mode.imaginary.value);
    modes.sort_by(|a, b| size(b).total_cmp(&size(a)));
    Some(modes)
}

type Eigenvector = DVector<Complex<f64>>;

/// Left and right eigenvectors by inverse iteration: with the eigenvalue known to rounding, each solution of the
/// nearly singular equations is longer by its inverse distance, in the direction of the eigenvector.
fn eigenvectors(
    matrix: &DMatrix<f64>,
    eigenvalue: Complex<f64>,
) -> Option<(Eigenvector, Eigenvector)> {
    const ITERATIONS: usize = 3;
    let n = matrix.nrows();
    // off the eigenvalue by rounding, so that the equations can be solved
    let shift = eigenvalue + Complex::from(f64::EPSILON * matrix.norm());
    let shifted = matrix.map(Complex::from) - DMatrix::from_diagonal_element(n, n, shift);
    let vector = |of: DMatrix<Complex<f64>>| {
        let equations = of.lu();
        // no eigenvector of a model is likely to be at right angles to this
        let mut vector = DVector::from_fn(n, |k, _| Complex::new(1.0, 0.37 * (k as f64 + 1.0)));
        for _ in 0..ITERATIONS {
            vector = equations.solve(&vector)?;
            let length = vector.norm();
            vector.unscale_mut(length);
        }
        Some(vector)
    };
    Some((vector(shifted.adjoint())?, vector(shifted)?))
}

/// An eigenvalue in the words of flight mechanics.
fn mode(
    eigenvalue: Complex<f64>,
    states: Vec<String>,
    delta: &Delta<'_>,
    segment: Option<String>,
) -> Mode {
    let Complex { re, im } = eigenvalue;
    let frequency = eigenvalue.norm();
    let damping = -re / frequency;
    // each with its derivatives by Re λ and Im λ
    let measure = |value: f64, by_real: f64, by_imaginary: f64| {
        value
            .is_finite()
            .then(|| delta.measure(value, by_real, by_imaginary))
    };
    let oscillates = im > 0.0;
    let frequency_by = (re / frequency, im / frequency);
    let damping_by = (
        -1.0 / frequency - damping / frequency * frequency_by.0,
        -damping / frequency * frequency_by.1,
    );
    let halving = std::f64::consts::LN_2 / re.abs();
    let halving_by = -halving / re;
    let period = std::f64::consts::TAU / im;
    Mode {
        segment,
        name: None,
        states,
        real: delta.measure(re, 1.0, 0.0),
        imaginary: delta.measure(im, 0.0, if oscillates { 1.0 } else { 0.0 }),
        natural_frequency: (oscillates.then_some(()))
            .and_then(|()| measure(frequency, frequency_by.0, frequency_by.1)),
        damping_ratio: (oscillates.then_some(()))
            .and_then(|()| measure(damping, damping_by.0, damping_by.1)),
        period: (oscillates.then_some(())).and_then(|()| measure(period, 0.0, -period / im)),
        time_constant: ((!oscillates).then_some(()))
            .and_then(|()| measure(1.0 / re.abs(), -1.0 / (re * re.abs()), 0.0)),
        time_to_half: ((re < 0.0).then_some(())).and_then(|()| measure(halving, halving_by, 0.0)),
        time_to_double: ((re > 0.0).then_some(())).and_then(|()| measure(halving, halving_by, 0.0)),
        remark: delta.remark.to_string(),
    }
}

/// The delta method for functions of one eigenvalue.
struct Delta<'a> {
    bounds: &'a ErrorBounds,
    /// dλ/dθ by place.
    gradient: &'a [Complex<f64>],
    known: bool,
    remark: &'static str,
}

impl<'a> Delta<'a> {
    fn new(bounds: &'a ErrorBounds, gradient: &'a [Complex<f64>], nearest: f64) -> Self {
        let mut delta = Self {
            bounds,
            gradient,
            known: !bounds.correlation.is_empty() || bounds.standard_errors.is_empty(),
            remark: "",
        };
        if !delta.known {
            delta.remark = "no error bound: the data do not determine all parameters";
            return delta;
        }
        let (real, imaginary) = (delta.deviation(1.0, 0.0), delta.deviation(0.0, 1.0));
        // written so that NaN counts as near
        let is_apart = real.hypot(imaginary) <= NEAR * nearest;
        if !is_apart {
            delta.known = false;
            delta.remark = "too near to another eigenvalue for a linear error bound";
        }
        delta
    }

    fn deviation(&self, by_real: f64, by_imaginary: f64) -> f64 {
        let weights: Vec<f64> = (self.gradient.iter().zip(&self.bounds.standard_errors))
            .map(|(by, error)| (by_real * by.re + by_imaginary * by.im) * error.unwrap_or_default())
            .collect();
        let row = |(i, weight): (usize, &f64)| {
            let across = weights.iter().zip(&self.bounds.correlation[i]);
            weight * across.map(|(other, r)| other * r).sum::<f64>()
        };
        let variance: f64 = weights.iter().enumerate().map(row).sum();
        variance.max(0.0).sqrt()
    }

    fn measure(&self, value: f64, by_real: f64, by_imaginary: f64) -> Measure {
        let standard_error = self
            .known
            .then(|| self.deviation(by_real, by_imaginary))
            .filter(|error| error.is_finite());
        Measure {
            value,
            standard_error,
        }
    }
}
