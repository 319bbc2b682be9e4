//! Unknowns on the way, and everything that is known there.

use nalgebra::{DMatrix, DVector};

use super::evaluation::FilterEvaluator;
use super::limit::Limit;
use crate::estimate::descent::iterate::Taken;
use crate::estimate::descent::step::Newton;
use crate::estimate::likelihood::priors;
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::options::Noise;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::iteration::Iteration;
use crate::estimate::report::parameter::Bound;

/// R as it stands in the gain: that of an earlier iterate.
#[derive(Clone)]
pub(super) struct GainNoise {
    pub covariance: DMatrix<f64>,
    pub inverse: DMatrix<f64>,
}

impl GainNoise {
    pub(super) fn of(weighting: &Weighting) -> Self {
        Self {
            covariance: weighting.covariance.clone(),
            inverse: weighting.inverse.clone(),
        }
    }
}

pub(super) struct Iterate {
    /// SI.
    pub xi: Vec<f64>,
    pub gain_noise: GainNoise,
    pub weighting: Weighting,
    /// Reduced where the gain is at its limit, as the next two are.
    pub information: DMatrix<f64>,
    relaxation: Option<DMatrix<f64>>,
    descent: DVector<f64>,
    /// By place: the bound against which the descent direction pushes.
    pub held: Vec<Option<Bound>>,
    pub limit: Limit,
    /// None where the information matrix cannot be decomposed.
    pub newton: Option<Newton>,
}

impl Iterate {
    pub(super) fn at(
        evaluator: &mut FilterEvaluator<'_>,
        xi: Vec<f64>,
        gain_noise: GainNoise,
    ) -> Result<Self, Unusable> {
        let problem = evaluator.problem;
        let (sums, shares) = evaluator.sums(&xi, &gain_noise.inverse)?;
        let noise = &problem.options.noise;
        let weighting = Weighting::at(problem, &xi, &sums.residuals)?;
        let mut information = weighting.information(&sums);
        let mut descent = weighting.descent(&sums);
        priors::add(&problem.unknowns, &xi, &mut information, &mut descent);
        let limit = Limit::new(&evaluator.layout, &shares, &descent);
        let information = limit.reduction.tr_mul(&(information * &limit.reduction));
        let descent = limit.reduction.tr_mul(&descent);
        let relaxation = match noise {
            Noise::Estimated { .. } => {
                let columns = weighting.relaxation(&sums, &problem.counts)?;
                Some(limit.reduction.tr_mul(&columns))
            }
            Noise::Given { .. } => None,
        };
        let held = held(evaluator, &xi, &descent, &limit);
        let newton = Newton::new(&information, relaxation.as_ref(), &descent, &held);
        Ok(Self {
            xi,
            gain_noise,
            weighting,
            information,
            relaxation,
            descent,
            held,
            limit,
            newton,
        })
    }

    /// How far R in the gain is from that of the innovations, in standard errors of R.
    pub(super) fn lag(&self, problem: &Problem) -> f64 {
        let (gain, now) = (&self.gain_noise.covariance, &self.weighting.covariance);
        let square = |(i, &count): (usize, &usize)| {
            0.5 * count as f64 * (now[(i, i)] / gain[(i, i)]).ln().powi(2)
        };
        let counts = problem.counts.iter().enumerate();
        counts.map(square).sum::<f64>().sqrt()
    }

    /// The step of all unknowns for a damping λ. What would go beyond a bound goes as far as that, and the others take
    /// the step that goes with it: an intensity f shows as f² only, so that where it is small its step is as long as
    /// 1/f, and what the others would do along with the whole of it leads nowhere.
    pub(super) fn step(
        &self,
        evaluator: &FilterEvaluator<'_>,
        newton: &Newton,
        damping: f64,
    ) -> DVector<f64> {
        let mut held = self.held.clone();
        let mut to_bounds = DVector::zeros(self.xi.len());
        let mut step = newton.step(damping);
        loop {
            let whole = &self.limit.reduction * &step;
            let beyond = |place: usize| {
                let (lower, upper) = evaluator.layout.limits(evaluator.problem, place);
                let there = self.xi[place] + whole[place];
                if there < lower {
                    Some((place, Bound::Lower, lower - self.xi[place]))
                } else if there > upper {
                    Some((place, Bound::Upper, upper - self.xi[place]))
                } else {
                    None
                }
            };
            let free = (0..held.len()).filter(|&place| held[place].is_none());
            let beyond: Vec<_> = free.filter_map(beyond).collect();
            if beyond.is_empty() {
                return whole;
            }
            for (place, bound, way) in beyond {
                held[place] = Some(bound);
                to_bounds[place] = way;
            }
            step.copy_from(&to_bounds);
            if held.iter().any(Option::is_none) {
                let descent = &self.descent - &self.information * &to_bounds;
                let relaxation = self.relaxation.as_ref();
                let Some(others) = Newton::new(&self.information, relaxation, &descent, &held)
                else {
                    return whole;
                };
                step += others.step(damping);
            }
        }
    }

    pub(super) fn report(
        &self,
        evaluator: &FilterEvaluator<'_>,
        number: usize,
        taken: &Taken,
    ) -> Iteration {
        let layout = &evaluator.layout;
        let in_own_units = |(place, value): (usize, &f64)| {
            let problem = evaluator.problem;
            if place < layout.parameters {
                problem.unit(place).from_si(*value)
            } else {
                value / layout.name(problem, place).1
            }
        };
        let variance = self.weighting.covariance.diagonal();
        Iteration {
            number,
            cost: self.weighting.cost,
            det_r: self.weighting.det(),
            variance: variance.iter().copied().collect(),
            parameters: self.xi.iter().enumerate().map(in_own_units).collect(),
            gradient_norm: self.newton.as_ref().map_or(0.0, Newton::gradient_norm),
            step: taken.length,
            damping: taken.damping,
            halvings: taken.halvings,
        }
    }
}

/// Which places are at a bound that the descent direction pushes against.
fn held(
    evaluator: &FilterEvaluator<'_>,
    xi: &[f64],
    descent: &DVector<f64>,
    limit: &Limit,
) -> Vec<Option<Bound>> {
    let bound = |(place, &value): (usize, &f64)| {
        let (lower, upper) = evaluator.layout.limits(evaluator.problem, place);
        if limit.places.contains(&place) {
            Some(Bound::Upper)
        } else if value <= lower && descent[place] < 0.0 {
            Some(Bound::Lower)
        } else if value >= upper && descent[place] > 0.0 {
            Some(Bound::Upper)
        } else {
            None
        }
    };
    xi.iter().enumerate().map(bound).collect()
}
