//! A θ on the way, and everything that is known there.

use nalgebra::DMatrix;

use super::step::{Newton, held};
use crate::estimate::evaluation::evaluate::Evaluate;
use crate::estimate::evaluation::normal_equations::NormalEquations;
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::iteration::Iteration;
use crate::estimate::report::parameter::Bound;

pub(crate) struct Iterate {
    /// SI.
    pub theta: Vec<f64>,
    pub weighting: Weighting,
    pub information: DMatrix<f64>,
    /// By place of θ: the bound against which the descent direction pushes.
    pub held: Vec<Option<Bound>>,
    /// None where the information matrix cannot be decomposed.
    pub newton: Option<Newton>,
}

/// How an iterate was reached.
#[derive(Clone, Copy, Default)]
pub(crate) struct Taken {
    /// Of the step, in standard errors.
    pub length: f64,
    pub damping: f64,
    /// Of the damped step, what was taken.
    pub share: f64,
    pub halvings: usize,
}

impl Iterate {
    pub(crate) fn at<'p>(
        problem: &Problem,
        evaluator: &mut impl Evaluate<'p>,
        theta: Vec<f64>,
    ) -> Result<Self, Unusable> {
        let equations = NormalEquations::by(evaluator, &theta)?;
        let held = held(&problem.unknowns, &theta, &equations.descent);
        let newton = Newton::new(
            &equations.information,
            equations.relaxation.as_ref(),
            &equations.descent,
            &held,
        );
        let NormalEquations {
            weighting,
            information,
            ..
        } = equations;
        Ok(Self {
            theta,
            weighting,
            information,
            held,
            newton,
        })
    }

    pub(crate) fn report(&self, problem: &Problem, number: usize, taken: &Taken) -> Iteration {
        Iteration {
            number,
            cost: self.weighting.cost,
            det_r: self.weighting.det(),
            variance: self
                .weighting
                .covariance
                .diagonal()
                .iter()
                .copied()
                .collect(),
            parameters: problem.in_own_units(&self.theta),
            gradient_norm: self.newton.as_ref().map_or(0.0, Newton::gradient_norm),
            step: taken.length,
            damping: taken.damping,
            halvings: taken.halvings,
        }
    }
}
