//! Descent from step to step with what gradients tell of the Hessian (BFGS), within bounds.

use nalgebra::{DMatrix, DVector};

use super::line_search::{Probe, strong_wolfe};

/// A function to be minimised.
pub trait Objective {
    /// Cost and gradient; none where there is no cost.
    fn evaluate(&mut self, theta: &[f64]) -> Option<(f64, DVector<f64>)>;
}

impl<F: FnMut(&[f64]) -> Option<(f64, DVector<f64>)>> Objective for F {
    fn evaluate(&mut self, theta: &[f64]) -> Option<(f64, DVector<f64>)> {
        self(theta)
    }
}

/// The update of the inverse Hessian after a step.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Update {
    /// The inverse Hessian, by Broyden, Fletcher, Goldfarb and Shanno.
    Bfgs,
    /// Nothing but how far to go: steepest descent in the metric of the initial inverse Hessian.
    None,
}

/// A step that was taken.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Moved {
    /// √(sᵀ y): in standard errors where the cost is quadratic.
    pub length: f64,
    /// Cost and gradient were evaluated this often.
    pub evaluations: usize,
}

/// No step lowers the cost.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("no step lowers the cost")]
pub struct NoWay;

/// A share of |s||y| below which sᵀy says nothing of the curvature.
const LEAST_CURVATURE: f64 = 1e-10;

/// An iterate, and the idea of the Hessian that goes with it.
#[derive(Clone, Debug)]
pub struct Optimiser {
    /// Where it is.
    pub theta: Vec<f64>,
    /// The cost there.
    pub cost: f64,
    /// The gradient of the cost there.
    pub gradient: DVector<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    inverse: DMatrix<f64>,
    update: Update,
    /// The scale of the inverse Hessian is not known yet.
    unscaled: bool,
    /// Of the last step: steepest descent starts where that ended.
    last: f64,
}

impl Optimiser {
    /// `inverse` is the first idea of the inverse Hessian. Where only its shape is known (`unscaled`), the
    /// first step goes a tenth of it, and its scale is taken from what that shows (Nocedal, Wright, eq. 6.20).
    pub fn new(
        (theta, cost, gradient): (Vec<f64>, f64, DVector<f64>),
        bounds: (Vec<f64>, Vec<f64>),
        inverse: DMatrix<f64>,
        unscaled: bool,
        update: Update,
    ) -> Self {
        let (lower, upper) = bounds;
        Self {
            theta,
            cost,
            gradient,
            lower,
            upper,
            inverse,
            update,
            unscaled,
            last: 1.0,
        }
    }

    /// Another idea of the inverse Hessian, whose scale is known.
    pub fn restart(&mut self, inverse: DMatrix<f64>) {
        self.inverse = inverse;
        self.unscaled = false;
    }

    /// Square roots of the diagonal of the inverse Hessian.
    pub fn errors(&self) -> DVector<f64> {
        self.inverse.diagonal().map(|v| v.max(0.0).sqrt())
    }

    /// Length of a full step in standard errors, √(gᵀ H⁻¹ g), as far as H is known.
    pub fn distance(&self) -> f64 {
        (-self.direction().dot(&self.gradient)).max(0.0).sqrt()
    }

    /// −H⁻¹ g over what no bound holds.
    fn direction(&self) -> DVector<f64> {
        let n = self.theta.len();
        let at_lower = |i: usize| self.theta[i] <= self.lower[i];
        let at_upper = |i: usize| self.theta[i] >= self.upper[i];
        let mut held: Vec<bool> = (0..n)
            .map(|i| {
                let descent = -self.gradient[i];
                (at_lower(i) && descent < 0.0) || (at_upper(i) && descent > 0.0)
            })
            .collect();
        loop {
            let free = DVector::from_fn(n, |i, _| if held[i] { 0.0 } else { self.gradient[i] });
            let mut direction = -(&self.inverse * free);
            (0..n).filter(|&i| held[i]).for_each(|i| direction[i] = 0.0);
            // the gradient leads away from a bound, but the direction into it
            let leaves = |i: &usize| {
                (at_lower(*i) && direction[*i] < 0.0) || (at_upper(*i) && direction[*i] > 0.0)
            };
            let also: Vec<usize> = (0..n).filter(|i| !held[*i]).filter(leaves).collect();
            if also.is_empty() {
                return direction;
            }
            also.into_iter().for_each(|i| held[i] = true);
        }
    }

    /// One step.
    ///
    /// # Errors
    /// No step lowers the cost.
    pub fn step(&mut self, objective: &mut impl Objective) -> Result<Moved, NoWay> {
        let direction = self.direction();
        let slope = direction.dot(&self.gradient);
        if slope >= 0.0 || !slope.is_finite() {
            return Err(NoWay);
        }
        let room = |i: usize| match direction[i] {
            d if d > 0.0 => (self.upper[i] - self.theta[i]) / d,
            d if d < 0.0 => (self.lower[i] - self.theta[i]) / d,
            _ => f64::INFINITY,
        };
        let longest = (0..self.theta.len())
            .map(room)
            .fold(f64::INFINITY, f64::min);
        let first = if self.unscaled {
            0.1 / (-slope).sqrt()
        } else if self.update == Update::None {
            2.0 * self.last
        } else {
            1.0
        };
        let start = Probe {
            length: 0.0,
            cost: self.cost,
            slope,
        };
        let mut evaluations = 0;
        let mut best: Vec<(f64, Vec<f64>, DVector<f64>)> = Vec::new();
        let found = strong_wolfe(start, first, longest, |length| {
            evaluations += 1;
            let theta = self.at(&direction, length);
            let (cost, gradient) = objective.evaluate(&theta)?;
            let slope = gradient.dot(&direction);
            best.push((length, theta, gradient));
            Some(Probe {
                length,
                cost,
                slope,
            })
        })
        .ok_or(NoWay)?;
        let taken = best
            .into_iter()
            .rfind(|(length, ..)| *length == found.length);
        let (_, theta, gradient) = taken.ok_or(NoWay)?;
        let moved = theta.iter().zip(&self.theta).map(|(a, b)| a - b);
        let s = DVector::from_iterator(theta.len(), moved);
        let y = &gradient - &self.gradient;
        self.learn(&s, &y);
        self.last = found.length;
        (self.theta, self.cost, self.gradient) = (theta, found.cost, gradient);
        Ok(Moved {
            length: s.dot(&y).max(0.0).sqrt(),
            evaluations,
        })
    }

    fn at(&self, direction: &DVector<f64>, length: f64) -> Vec<f64> {
        let moved =
            |i: usize| (self.theta[i] + length * direction[i]).clamp(self.lower[i], self.upper[i]);
        (0..self.theta.len()).map(moved).collect()
    }

    fn learn(&mut self, s: &DVector<f64>, y: &DVector<f64>) {
        let curvature = s.dot(y);
        let spread = y.dot(&(&self.inverse * y));
        if self.update == Update::None {
            self.unscaled = false;
            return;
        }
        if curvature <= LEAST_CURVATURE * s.norm() * y.norm() {
            return;
        }
        if std::mem::take(&mut self.unscaled) {
            self.inverse *= curvature / spread;
        }
        // H⁻¹ + (1 + yᵀH⁻¹y/sᵀy) s sᵀ/sᵀy − (H⁻¹y sᵀ + s yᵀH⁻¹)/sᵀy
        let hy = &self.inverse * y;
        let factor = (1.0 + y.dot(&hy) / curvature) / curvature;
        self.inverse.ger(factor, s, s, 1.0);
        self.inverse.ger(-1.0 / curvature, &hy, s, 1.0);
        self.inverse.ger(-1.0 / curvature, s, &hy, 1.0);
    }
}
