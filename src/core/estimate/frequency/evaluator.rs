//! One look at the transforms for a θ: y = (C (iω - A)⁻¹ B + D) u + what ends and trends add, and its derivatives by θ.

use num_complex::Complex64;

use super::columns::Columns;
use super::linear::Linearisation;
use super::response::{Response, Sizes};
use super::transformed::Transformed;
use crate::estimate::problem::unusable::Unusable;
use crate::simulate::path_out_of_bounds;
use crate::stop;

/// Evaluates a transformed problem at any θ.
pub(super) struct FrequencyEvaluator<'p> {
    transformed: &'p Transformed,
    linearisation: Linearisation<'p>,
    parameters: Vec<f64>,
    /// Looks with derivatives so far.
    pub evaluations: usize,
    /// Looks without.
    pub simulations: usize,
}

/// What there is at one frequency of a segment.
pub(super) struct At<'a> {
    /// By output: measured less modelled.
    pub residuals: &'a [Complex64],
    /// By output, then column: the derivative of what is modelled. Empty where it was not asked for.
    pub rows: &'a [Complex64],
}

impl<'p> FrequencyEvaluator<'p> {
    pub(super) fn new(transformed: &'p Transformed) -> Self {
        Self {
            transformed,
            linearisation: Linearisation::of(&transformed.problem.model),
            parameters: Vec::new(),
            evaluations: 0,
            simulations: 0,
        }
    }

    pub(super) fn transformed(&self) -> &'p Transformed {
        self.transformed
    }

    /// Goes along the frequencies of a segment and hands what there is at each to `sink`.
    ///
    /// # Errors
    /// A delay is too long, or the frequency response is not finite.
    pub(super) fn sweep(
        &mut self,
        segment: usize,
        theta: &[f64],
        columns: Option<&Columns>,
        mut sink: impl FnMut(At<'_>),
    ) -> Result<(), Unusable> {
        let transformed = self.transformed;
        let problem = &transformed.problem;
        self.set(segment, theta)?;
        let own = problem.model.document.parameters.len();
        let linear = (self.linearisation).at(&transformed.points[segment], &self.parameters);
        if !linear.is_finite() {
            return Err(Unusable::NotFinite);
        }
        let sizes = Sizes::at(problem, &self.parameters[..own], columns);
        let response = Response {
            problem,
            spectra: &transformed.spectra[segment],
            linear: &linear,
            sizes: &sizes,
            ends: &self.parameters[own..],
            columns,
        };
        let mut room = response.room();
        for frequency in 0..response.spectra.omega.len() {
            stop::check();
            response
                .at(frequency, &mut room)
                .ok_or(Unusable::NotFinite)?;
            sink(At {
                residuals: &room.residuals,
                rows: &room.rows,
            });
        }
        Ok(())
    }

    fn set(&mut self, segment: usize, theta: &[f64]) -> Result<(), Unusable> {
        let problem = &self.transformed.problem;
        (problem.unknowns).parameters(segment, theta, &mut self.parameters);
        let own = &self.parameters[..problem.model.document.parameters.len()];
        match path_out_of_bounds(&problem.model, &problem.segments[segment], own) {
            Some(place) => Err(Unusable::Path { segment, place }),
            None => Ok(()),
        }
    }
}
