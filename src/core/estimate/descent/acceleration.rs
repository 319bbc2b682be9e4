//! Anderson's acceleration (J. ACM 12, 1965) of the Gauss-Newton iteration: the last steps tell about the next.
//!
//! The Hessian of a step leaves out the curvature of the model. Where residuals are not small the full step then falls
//! short, or goes too far, by about the same share each time along a few directions, and the iteration closes in by a
//! constant factor. The differences of the last iterates x and of their full steps d show these directions:
//!
//! ```text
//! s = d_k − (ΔX + ΔD) γ,   γ = argmin ‖d_k − ΔD γ‖
//! ```
//!
//! with lengths in standard errors. It is a proposal: who takes it looks at the cost first.

use std::collections::VecDeque;

use nalgebra::{DMatrix, DVector};

use super::step::length;
use crate::estimate::linear::definite::Definite;

/// Full steps longer than this, in standard errors, are far away: they tell about the places they were made at.
const FARTHEST: f64 = 10.0;

/// Differences that are looked at.
const MOST_DIFFERENCES: usize = 3;

/// The proposal is at most so many times as long as the full step.
const LONGEST: f64 = 5.0;

#[derive(Default)]
pub(crate) struct Acceleration {
    past: VecDeque<Past>,
}

/// An iterate, and the full step from there.
struct Past {
    theta: DVector<f64>,
    step: DVector<f64>,
    /// Of the step, in standard errors.
    length: f64,
}

impl Acceleration {
    /// Forgets iterates that no longer tell about this place.
    pub(crate) fn forget(&mut self) {
        self.past.clear();
    }

    /// The step to try in place of the full `step` from θ, if earlier ones told.
    pub(crate) fn propose(
        &mut self,
        theta: &[f64],
        step: DVector<f64>,
        information: &DMatrix<f64>,
    ) -> Option<DVector<f64>> {
        let length = length(&step, information);
        if length > FARTHEST || self.past.back().is_some_and(|last| last.length <= length) {
            self.forget();
        }
        if length > FARTHEST {
            return None;
        }
        let theta = DVector::from_column_slice(theta);
        self.past.push_back(Past {
            theta,
            step,
            length,
        });
        if self.past.len() > MOST_DIFFERENCES + 1 {
            self.past.pop_front();
        }
        let most = self.past.len() - 1;
        (1..=most)
            .rev()
            .find_map(|count| self.by_differences(count, information))
    }

    fn by_differences(&self, count: usize, information: &DMatrix<f64>) -> Option<DVector<f64>> {
        let now = self.past.back()?;
        let first = self.past.len() - 1 - count;
        let pairs = || {
            self.past
                .iter()
                .skip(first)
                .zip(self.past.iter().skip(first + 1))
        };
        let steps: Vec<DVector<f64>> = pairs().map(|(a, b)| &b.step - &a.step).collect();
        let steps = DMatrix::from_columns(&steps);
        let weighted = information * &steps;
        let gram = steps.tr_mul(&weighted);
        // none where the differences are not independent
        let gram = Definite::of(&gram, &gram.diagonal())?;
        let shares = gram.solve(&weighted.tr_mul(&now.step), 0.0);
        let mut proposal = now.step.clone();
        for ((a, b), share) in pairs().zip(shares.iter()) {
            proposal -= (&b.theta - &a.theta + &b.step - &a.step) * *share;
        }
        let length = length(&proposal, information);
        (length.is_finite() && length <= LONGEST * now.length).then_some(proposal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear iteration x → x + d(x) with d = A (x* − x) is solved as soon as there are as many differences as
    /// directions in which it falls short.
    #[test]
    fn a_linear_iteration_ends_at_once() {
        let end = DVector::from_column_slice(&[1.0, -2.0, 30.0]);
        let full = |x: &DVector<f64>| {
            (&end - x).component_mul(&DVector::from_column_slice(&[1.0, 0.6, 0.3]))
        };
        let information = DMatrix::from_diagonal(&DVector::from_column_slice(&[4.0, 1.0, 0.01]));
        let mut acceleration = Acceleration::default();
        let mut x = DVector::zeros(3);
        let mut steps = 0;
        while (&x - &end).norm() > 1e-9 {
            let step = full(&x);
            let proposal = acceleration.propose(x.as_slice(), step.clone(), &information);
            x += proposal.unwrap_or(step);
            steps += 1;
            // two shares fall short: two differences, and the step that learns from them
            assert!(steps < 6, "{x}");
        }
    }

    #[test]
    fn nothing_is_learnt_from_steps_that_grow_or_stay_alike() {
        let information = DMatrix::identity(2, 2);
        let mut acceleration = Acceleration::default();
        let mut propose = |x: f64, step: [f64; 2]| {
            acceleration.propose(&[x, 0.0], DVector::from_column_slice(&step), &information)
        };
        assert!(propose(0.0, [1.0, 0.0]).is_none());
        assert!(propose(1.0, [2.0, 0.0]).is_none());
        // nearly the same step again would be taken as one of endless length
        assert!(propose(3.0, [1.99, 0.0]).is_none());
    }
}
