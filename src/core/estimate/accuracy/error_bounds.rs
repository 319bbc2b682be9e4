//! The accuracy of an estimate: standard errors, correlations, and sets of unknowns that the data cannot tell apart.

use nalgebra::{DMatrix, DVector};

use super::absorbed::absorbed;
use super::coloured_residuals::{Colour, gradient_covariance};
use crate::estimate::descent::iterate::Iterate;
use crate::estimate::evaluation::evaluate::Evaluate;
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::likelihood::priors;
use crate::estimate::linear::definite::Definite;
use crate::estimate::linear::spectrum::Spectrum;
use crate::estimate::options::Noise;
use crate::estimate::options::error_bounds::ErrorBoundsKind;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::collinear::CollinearSet;
use crate::estimate::report::history::TimeHistory;
use crate::estimate::report::parameter::Bound;

/// Residuals below this share of what was measured are rounding, not noise: no sensor has ten digits.
const PERFECT: f64 = 1e-10;

/// Accuracy at an estimate, by place of θ.
pub(crate) struct ErrorBounds {
    /// Which kind the standard errors are of; none where they would mean nothing.
    pub kind: Option<ErrorBoundsKind>,
    /// None where held at a bound or not determined.
    pub standard_errors: Vec<Option<f64>>,
    /// Square root of the diagonal of F⁻¹.
    pub conventional: Vec<Option<f64>>,
    /// Of θ, SI: zero for what is held at a bound, and over the directions that the data see.
    pub covariance: DMatrix<f64>,
    /// Empty when some unknowns cannot be told apart, or errors are out of the range of numbers.
    pub correlation: Vec<Vec<f64>>,
    /// Sets of places of which the data see only some combinations, with a direction in which nothing changes.
    collinear: Vec<Collinear>,
}

impl ErrorBounds {
    /// At an iterate, whose time histories have the residuals.
    pub(crate) fn at(
        problem: &Problem,
        evaluator: &mut Evaluator<'_>,
        iterate: &Iterate,
        colour: &Colour,
        histories: &[TimeHistory],
    ) -> Self {
        let mut bounds = Self::conventional(&iterate.information, &iterate.held);
        let given = matches!(problem.options.noise, Noise::Given { .. });
        if is_perfect(problem, histories) {
            // a variance that was given still means what it says
            if !given {
                bounds.mean_nothing();
            }
        } else if problem.options.error_bounds == ErrorBoundsKind::Corrected {
            bounds.correct(evaluator, iterate, colour, histories);
        }
        bounds
    }

    /// From the information matrix; places held at a bound count as known.
    pub(crate) fn conventional(information: &DMatrix<f64>, held: &[Option<Bound>]) -> Self {
        let unknowns = held.len();
        let moving: Vec<usize> = (0..unknowns).filter(|&i| held[i].is_none()).collect();
        let own = information.select_rows(&moving).select_columns(&moving);
        let mut bounds = Self {
            kind: Some(ErrorBoundsKind::Conventional),
            standard_errors: Vec::new(),
            conventional: vec![None; unknowns],
            covariance: DMatrix::zeros(unknowns, unknowns),
            correlation: Vec::new(),
            collinear: Vec::new(),
        };
        if let Some((inverse, collinear)) = inverse(&own) {
            let in_places = |set: Collinear| {
                set.into_iter()
                    .map(|(i, component)| (moving[i], component))
                    .collect()
            };
            bounds.collinear = collinear.into_iter().map(in_places).collect();
            for (a, &i) in moving.iter().enumerate() {
                for (b, &j) in moving.iter().enumerate() {
                    bounds.covariance[(i, j)] = inverse[(a, b)];
                }
            }
            bounds.conventional = bounds.errors(&moving);
        }
        bounds.standard_errors.clone_from(&bounds.conventional);
        bounds.correlation = bounds.correlations();
        bounds
    }

    /// F⁻¹ becomes F⁻¹ B F⁻¹: with the colour of the residuals, and with what the fit absorbed by that put back.
    fn correct(
        &mut self,
        evaluator: &mut Evaluator<'_>,
        iterate: &Iterate,
        colour: &Colour,
        histories: &[TimeHistory],
    ) {
        let corrected = self.sandwich(evaluator, iterate, colour).and_then(|first| {
            let absorbed = absorbed(evaluator, &iterate.theta, &first)?;
            let noise = Colour::of_noise(histories, &absorbed);
            self.sandwich(evaluator, iterate, &noise)
        });
        if let Ok(corrected) = corrected {
            self.take(corrected);
        }
    }

    /// F⁻¹ becomes F⁻¹ B F⁻¹, B the covariance of the gradient.
    pub(crate) fn correct_with(&mut self, scatter: &DMatrix<f64>) {
        let corrected = &self.covariance * scatter * &self.covariance;
        if corrected.iter().all(|v| v.is_finite()) {
            self.take((&corrected + corrected.transpose()) * 0.5);
        }
    }

    /// Another covariance of θ.
    fn take(&mut self, corrected: DMatrix<f64>) {
        let determined = |i: &usize| self.conventional[*i].is_some();
        let places: Vec<usize> = (0..self.conventional.len()).filter(determined).collect();
        self.covariance = corrected;
        self.standard_errors = self.errors(&places);
        self.correlation = self.correlations();
        self.kind = Some(ErrorBoundsKind::Corrected);
    }

    /// F⁻¹ B F⁻¹; what priors know is in B as it is in F.
    fn sandwich(
        &self,
        evaluator: &mut Evaluator<'_>,
        iterate: &Iterate,
        colour: &Colour,
    ) -> Result<DMatrix<f64>, Unusable> {
        let inverse = &iterate.weighting.inverse;
        let mut scatter = gradient_covariance(evaluator, &iterate.theta, inverse, colour)?;
        priors::add_information(&evaluator.problem().unknowns, &mut scatter);
        let corrected = &self.covariance * scatter * &self.covariance;
        if corrected.iter().all(|v| v.is_finite()) {
            Ok((&corrected + corrected.transpose()) * 0.5)
        } else {
            Err(Unusable::NotFinite)
        }
    }

    pub(crate) fn mean_nothing(&mut self) {
        let unknowns = self.conventional.len();
        self.kind = None;
        self.standard_errors = vec![None; unknowns];
        self.conventional = vec![None; unknowns];
        self.correlation = Vec::new();
    }

    /// Square roots of the covariance's diagonal at `places`, but for members of a collinear set.
    fn errors(&self, places: &[usize]) -> Vec<Option<f64>> {
        let is_member = |place: usize| self.collinear.iter().flatten().any(|m| m.0 == place);
        let mut errors = vec![None; self.conventional.len()];
        for &place in places.iter().filter(|&&place| !is_member(place)) {
            errors[place] = Some(self.covariance[(place, place)].sqrt()).filter(|e| e.is_finite());
        }
        errors
    }

    fn correlations(&self) -> Vec<Vec<f64>> {
        if !self.collinear.is_empty() {
            return Vec::new();
        }
        let deviation: DVector<f64> = self.covariance.diagonal().map(f64::sqrt);
        let unknowns = deviation.len();
        let correlation = |i: usize, j: usize| match (i == j, self.covariance[(i, j)]) {
            (true, _) => 1.0,
            (false, 0.0) => 0.0,
            (false, covariance) => covariance / (deviation[i] * deviation[j]),
        };
        let row = |i: usize| (0..unknowns).map(|j| correlation(i, j)).collect();
        let rows: Vec<Vec<f64>> = (0..unknowns).map(row).collect();
        if rows.iter().flatten().all(|value| value.is_finite()) {
            rows
        } else {
            Vec::new()
        }
    }

    /// The collinear sets by name; `name` gives what the unknown at a place is called, and the SI value of its unit.
    pub(crate) fn collinear(&self, name: impl Fn(usize) -> (String, f64)) -> Vec<CollinearSet> {
        (self.collinear.iter())
            .map(|members| CollinearSet::named(members, &name))
            .collect()
    }
}

/// Members of a set of unknowns that cannot be told apart, by their places.
type Collinear = Vec<(usize, f64)>;

/// F⁻¹ over the directions that the data see, and the sets of unknowns of which they see only some combinations.
fn inverse(information: &DMatrix<f64>) -> Option<(DMatrix<f64>, Vec<Collinear>)> {
    let diagonal = information.diagonal();
    if let Some(definite) = Definite::of(information, &diagonal) {
        return Some((definite.inverse(), Vec::new()));
    }
    let spectrum = Spectrum::of(information, &diagonal)?;
    Some((spectrum.inverse(), spectrum.collinear()))
}

/// Whether the model reproduces an output that tells of parameters to rounding, as simulated data without noise
/// are: R then is rounding, and so is every error bound.
fn is_perfect(problem: &Problem, histories: &[TimeHistory]) -> bool {
    let power =
        |output: usize, pick: fn(&crate::estimate::report::history::OutputSeries) -> &Vec<f64>| {
            let all = histories.iter().flat_map(|h| pick(&h.outputs[output]));
            all.filter(|v| v.is_finite()).map(|v| v * v).sum::<f64>()
        };
    (0..problem.model.outputs.len())
        .filter(|&output| !problem.columns.of_output(output).is_empty())
        .any(|i| power(i, |s| &s.residual) <= PERFECT * PERFECT * power(i, |s| &s.measured))
}
