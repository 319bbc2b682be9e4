//! Cost, gradient and Hessian at a θ.

use nalgebra::{DMatrix, DVector};

use super::evaluate::Evaluate;
use super::evaluator::Evaluator;
use crate::estimate::likelihood::priors;
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::options::Noise;
use crate::estimate::problem::unusable::Unusable;

/// All that an iteration needs to know at a θ, but for the small solve.
#[derive(Clone, Debug)]
pub struct NormalEquations {
    pub(crate) weighting: Weighting,
    /// The information matrix F.
    pub information: DMatrix<f64>,
    /// -∂J/∂θ
    pub descent: DVector<f64>,
    /// Where R is estimated, its change with θ takes U Uᵀ off the information matrix: U.
    pub(crate) relaxation: Option<DMatrix<f64>>,
}

impl NormalEquations {
    /// Simulates with sensitivities and sums up. θ holds the free unknowns, SI.
    ///
    /// # Errors
    /// The simulation leaves the range of numbers.
    pub fn at(evaluator: &mut Evaluator<'_>, theta: &[f64]) -> Result<Self, Unusable> {
        Self::by(evaluator, theta)
    }

    /// As [`Self::at`], in any domain.
    ///
    /// # Errors
    /// The θ gives no cost.
    pub(crate) fn by<'p>(
        evaluator: &mut impl Evaluate<'p>,
        theta: &[f64],
    ) -> Result<Self, Unusable> {
        let sums = evaluator.sums(theta)?;
        let problem = evaluator.problem();
        let noise = &problem.options.noise;
        let weighting = Weighting::at(problem, theta, &sums.residuals)?;
        let mut information = weighting.information(&sums);
        let mut descent = weighting.descent(&sums);
        priors::add(&problem.unknowns, theta, &mut information, &mut descent);
        Ok(Self {
            information,
            descent,
            relaxation: match noise {
                Noise::Estimated { .. } => Some(weighting.relaxation(&sums, &problem.counts)?),
                Noise::Given { .. } => None,
            },
            weighting,
        })
    }

    /// det R, SI: R of greatest likelihood for θ, or the one that was given.
    pub fn det_r(&self) -> f64 {
        self.weighting.det()
    }

    /// J: -ln L, and what the priors add to it.
    pub fn cost(&self) -> f64 {
        self.weighting.cost
    }
}
