//! A transfer function with delay, fitted to a response.
//!
//! The cost is J = 20/n Σ W_γ (W_g (20 log |Ĥ|/|H|)² + W_p (∠Ĥ - ∠H)²) with magnitudes in dB, phases in degrees, W_g = 1,
//! W_p = 0.01745 and W_γ = (1.58 (1 - exp(-γ²)))² (Tischler and Remple, ch. 11). It starts from linear least squares on
//! H D = N, weighted anew by 1/|D|² (Sanathanan and Koerner 1963), for some delays, and goes down by Levenberg-Marquardt.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::options::TransferFunctionOrder;
use super::report::TransferFunction;

/// The weights of magnitude and phase.
const MAGNITUDE: f64 = 1.0;
const PHASE: f64 = 0.01745;

const MOST_ITERATIONS: usize = 100;
/// Rounds of the linear start.
const ROUNDS: usize = 10;

/// One point of a response.
#[derive(Clone, Copy, Debug)]
pub struct Weighted {
    /// rad/s
    pub omega: f64,
    /// H
    pub response: Complex64,
    /// γ²
    pub coherence: f64,
}

/// Fits a transfer function; `None` where there are no more numbers than unknowns, or nothing fits.
pub fn fitted(points: &[Weighted], order: TransferFunctionOrder) -> Option<TransferFunction> {
    let unknowns = order.numerator + 1 + order.denominator + usize::from(order.delay);
    let usable: Vec<Weighted> = points
        .iter()
        .copied()
        .filter(|p| p.response.norm() > 0.0 && p.coherence > 0.0 && p.omega > 0.0)
        .collect();
    if 2 * usable.len() <= unknowns {
        return None;
    }
    // frequencies about one: powers of s stay of one size
    let unit = usable.iter().map(|p| p.omega.ln()).sum::<f64>() / usable.len() as f64;
    let unit = unit.exp();
    let problem = Problem {
        points: &usable,
        order,
        unit,
        unknowns,
    };
    let longest = if order.delay { 1.0 / unit } else { 0.0 };
    let delays = [0.0, 0.1, 0.3].map(|share| share * longest);
    let starts = delays
        .iter()
        .filter_map(|&delay| problem.linear_start(delay));
    let best = starts.min_by(|a, b| problem.cost(a).total_cmp(&problem.cost(b)))?;
    let (best, iterations) = problem.descend(best);
    problem.report(&best, iterations)
}

struct Problem<'p> {
    points: &'p [Weighted],
    order: TransferFunctionOrder,
    /// rad/s
    unit: f64,
    unknowns: usize,
}

impl Problem<'_> {
    /// Numerator, denominator and delay of some unknowns, at ω.
    fn parts(&self, unknowns: &DVector<f64>, omega: f64) -> (Complex64, Complex64, f64) {
        let s = Complex64::new(0.0, omega / self.unit);
        let (b, a) = (self.order.numerator + 1, self.order.denominator);
        let sum = |range: std::ops::Range<usize>, last: Complex64| {
            range.rev().fold(last, |sum, i| sum * s + unknowns[i])
        };
        let numerator = sum(0..b, Complex64::ZERO);
        let denominator = sum(b..b + a, Complex64::ONE);
        let delay = if self.order.delay {
            unknowns[b + a]
        } else {
            0.0
        };
        (numerator, denominator, delay)
    }

    fn model(&self, unknowns: &DVector<f64>, omega: f64) -> Complex64 {
        let (numerator, denominator, delay) = self.parts(unknowns, omega);
        numerator / denominator * Complex64::from_polar(1.0, -omega / self.unit * delay)
    }

    /// Weighted errors: of the magnitude in dB, then of the phase in degrees, for each point; their squares add up to J.
    fn errors(&self, unknowns: &DVector<f64>) -> DVector<f64> {
        let share = (20.0 / self.points.len() as f64).sqrt();
        let mut errors = DVector::zeros(2 * self.points.len());
        for (k, point) in self.points.iter().enumerate() {
            let ratio = self.model(unknowns, point.omega) / point.response;
            let weight = share * coherence_weight(point.coherence);
            errors[2 * k] = weight * MAGNITUDE.sqrt() * 20.0 * ratio.norm().log10();
            errors[2 * k + 1] = weight * PHASE.sqrt() * ratio.arg().to_degrees();
        }
        errors
    }

    fn cost(&self, unknowns: &DVector<f64>) -> f64 {
        let cost = self.errors(unknowns).norm_squared();
        if cost.is_finite() {
            cost
        } else {
            f64::INFINITY
        }
    }

    /// ∂errors/∂unknowns: of ln H the real part is that of the magnitude, the imaginary part the phase.
    fn slopes(&self, unknowns: &DVector<f64>) -> DMatrix<f64> {
        let share = (20.0 / self.points.len() as f64).sqrt();
        let (b, a) = (self.order.numerator + 1, self.order.denominator);
        let mut slopes = DMatrix::zeros(2 * self.points.len(), self.unknowns);
        for (k, point) in self.points.iter().enumerate() {
            let s = Complex64::new(0.0, point.omega / self.unit);
            let (numerator, denominator, _) = self.parts(unknowns, point.omega);
            let weight = share * coherence_weight(point.coherence);
            let mut put = |column: usize, slope: Complex64| {
                let decibels = 20.0 / std::f64::consts::LN_10 * slope.re;
                slopes[(2 * k, column)] = weight * MAGNITUDE.sqrt() * decibels;
                slopes[(2 * k + 1, column)] = weight * PHASE.sqrt() * slope.im.to_degrees();
            };
            (0..b).for_each(|i| put(i, s.powu(i as u32) / numerator));
            (0..a).for_each(|i| put(b + i, -s.powu(i as u32) / denominator));
            if self.order.delay {
                put(b + a, -s);
            }
        }
        slopes
    }

    /// Linear least squares on N - H e^(τs) (D - s^n) = H e^(τs) s^n, real and imaginary parts.
    fn linear_start(&self, delay: f64) -> Option<DVector<f64>> {
        let delay = delay * self.unit;
        let (b, a) = (self.order.numerator + 1, self.order.denominator);
        let mut found = DVector::zeros(self.unknowns);
        if self.order.delay {
            found[b + a] = delay;
        }
        let mut weights = vec![1.0; self.points.len()];
        for _ in 0..ROUNDS {
            let mut rows = DMatrix::zeros(2 * self.points.len(), b + a);
            let mut right = DVector::zeros(2 * self.points.len());
            for (k, point) in self.points.iter().enumerate() {
                let s = Complex64::new(0.0, point.omega / self.unit);
                let response = point.response * Complex64::from_polar(1.0, s.im * delay);
                let weight = weights[k] * coherence_weight(point.coherence) / response.norm();
                let mut put = |column: usize, value: Complex64| {
                    rows[(2 * k, column)] = value.re * weight;
                    rows[(2 * k + 1, column)] = value.im * weight;
                };
                (0..b).for_each(|i| put(i, s.powu(i as u32)));
                (0..a).for_each(|i| put(b + i, -response * s.powu(i as u32)));
                let last = response * s.powu(a as u32) * weight;
                (right[2 * k], right[2 * k + 1]) = (last.re, last.im);
            }
            let solved = rows.svd(true, true).solve(&right, 1e-12).ok()?;
            found.rows_mut(0, b + a).copy_from(&solved);
            for (weight, point) in weights.iter_mut().zip(self.points) {
                let (_, denominator, _) = self.parts(&found, point.omega);
                *weight = denominator.norm().recip();
            }
            if !weights.iter().all(|weight| weight.is_finite()) {
                return None;
            }
        }
        Some(found)
    }

    /// Levenberg-Marquardt; the unknowns where no step is better any more.
    fn descend(&self, mut at: DVector<f64>) -> (DVector<f64>, usize) {
        let (mut cost, mut damping) = (self.cost(&at), 1e-3);
        for iteration in 0..MOST_ITERATIONS {
            let (errors, slopes) = (self.errors(&at), self.slopes(&at));
            let normal = slopes.tr_mul(&slopes);
            let gradient = slopes.tr_mul(&errors);
            let mut better = None;
            for _ in 0..12 {
                let mut damped = normal.clone();
                for i in 0..self.unknowns {
                    damped[(i, i)] += damping * normal[(i, i)].max(f64::MIN_POSITIVE);
                }
                let step = damped.cholesky().map(|factor| factor.solve(&gradient));
                let next = step.map(|step| &at - step);
                let there = next.as_ref().map_or(f64::INFINITY, |next| self.cost(next));
                if there < cost {
                    damping = (damping * 0.1).max(1e-12);
                    better = next.map(|next| (next, there));
                    break;
                }
                damping *= 10.0;
            }
            let Some((next, there)) = better else {
                return (at, iteration);
            };
            let settled = cost - there <= 1e-12 * cost;
            (at, cost) = (next, there);
            if settled {
                return (at, iteration + 1);
            }
        }
        (at, MOST_ITERATIONS)
    }

    /// In seconds again.
    fn report(&self, at: &DVector<f64>, iterations: usize) -> Option<TransferFunction> {
        let cost = self.cost(at);
        if !cost.is_finite() {
            return None;
        }
        let (b, a) = (self.order.numerator + 1, self.order.denominator);
        // with s = unit s': b_i s'^i / s'^n, of which the last denominator is one
        let scale = |i: usize| {
            let power = if i < b {
                a as i32 - i as i32
            } else {
                a as i32 - (i - b) as i32
            };
            self.unit.powi(power)
        };
        let scales: Vec<f64> = (0..b + a)
            .map(scale)
            .chain(self.order.delay.then(|| self.unit.recip()))
            .collect();
        let values: Vec<f64> = at.iter().zip(&scales).map(|(v, scale)| v * scale).collect();
        let slopes = self.slopes(at);
        let left = (2 * self.points.len() - self.unknowns) as f64;
        let inverse = slopes.tr_mul(&slopes).try_inverse();
        let error = |i: usize| {
            let variance = inverse.as_ref()?[(i, i)] * cost / left;
            Some(variance.sqrt() * scales[i]).filter(|error| error.is_finite())
        };
        Some(TransferFunction {
            numerator: values[..b].to_vec(),
            denominator: values[b..b + a].iter().copied().chain([1.0]).collect(),
            delay: values.get(b + a).copied().unwrap_or(0.0),
            standard_errors: (0..self.unknowns).map(error).collect(),
            cost,
            magnitude_weight: MAGNITUDE,
            phase_weight: PHASE,
            points: self.points.len(),
            iterations,
        })
    }
}

/// √W_γ
fn coherence_weight(coherence: f64) -> f64 {
    1.58 * (1.0 - (-coherence).exp())
}
