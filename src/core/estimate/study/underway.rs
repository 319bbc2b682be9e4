//! A study on its way: what it is made of, and who is told of it.

use std::ops::ControlFlow;

use nalgebra::DVector;

use super::clock::Clock;
use super::gradients;
use super::report::ProblemSize;
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::options::technique::Derivatives;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::study_step::StudyStep;

/// Told of each finding, and of nothing new from time to time; may stop the study.
pub type Listener<'o> = dyn FnMut(Option<&StudyStep>) -> ControlFlow<()> + 'o;

/// Why a study comes to no end.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
pub enum NoStudy {
    /// The listener wanted no more.
    #[error("stopped on request")]
    Stopped,
    /// The start values give no cost.
    #[error(transparent)]
    Unusable(#[from] Unusable),
}

pub(super) struct Study<'a, 'o> {
    pub problem: Problem,
    pub theta: Vec<f64>,
    pub weighting: Weighting,
    /// The standard error that each unknown would have if it were the only one.
    pub errors: DVector<f64>,
    pub reference: DVector<f64>,
    pub clock: &'a dyn Clock,
    pub listener: &'a mut Listener<'o>,
    /// Findings told so far, and in all.
    pub told: usize,
    pub findings: usize,
}

impl Study<'_, '_> {
    pub(super) fn size(&self) -> ProblemSize {
        ProblemSize {
            samples: self.problem.samples(),
            states: self.problem.model.states.len(),
            outputs: self.problem.model.outputs.len(),
            unknowns: self.problem.unknowns.len(),
            stages: self.problem.options.integrator.stage_count(),
        }
    }

    pub(super) fn tell(&mut self, finding: String) -> Result<(), NoStudy> {
        self.told += 1;
        let step = StudyStep {
            number: self.told,
            of: self.findings,
            finding,
        };
        match (self.listener)(Some(&step)) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(NoStudy::Stopped),
        }
    }

    pub(super) fn go_on(&mut self) -> Result<(), NoStudy> {
        match (self.listener)(None) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(NoStudy::Stopped),
        }
    }

    /// Error of some components of the gradient, relative to the same components of the reference.
    pub(super) fn error(&self, found: &DVector<f64>, places: &[usize]) -> Option<f64> {
        let errors = self.errors.select_rows(places);
        let reference = self.reference.select_rows(places);
        let error = (found - &reference).component_mul(&errors).norm();
        // at a minimum there is no gradient to be relative to, but standard errors still are
        let size = reference.component_mul(&errors).norm().max(1.0);
        Some(error / size).filter(|error| error.is_finite())
    }

    pub(super) fn gradient(
        &self,
        technique: &Derivatives,
        places: &[usize],
    ) -> Result<DVector<f64>, Unusable> {
        gradients::gradient(
            &self.problem,
            technique,
            &self.theta,
            places,
            &self.weighting,
        )
    }

    pub(super) fn all_places(&self) -> Vec<usize> {
        (0..self.theta.len()).collect()
    }
}
