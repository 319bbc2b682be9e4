//! One look at the data for some unknowns: innovations, and with sensitivities the sums that a step is made of.

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector};

use super::gain::{Gain, Setting};
use super::layout::Layout;
use super::predictor::{Predicted, Predictor};
use super::start::{automatic_intensities, gain_noise};
use crate::estimate::likelihood::priors;
use crate::estimate::likelihood::sums::{Product, ResidualSums, Sums, mirror, pair, pairs};
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::options::{Noise, NoiseStructure};
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::problem::{Problem, set_parameters};
use crate::simulate::driven;

/// The likelihood of the innovations and its gradient, for a fixed covariance R in the gain.
pub struct FilterEquations {
    /// -ln L
    pub cost: f64,
    /// -∂J/∂ξ
    pub descent: DVector<f64>,
}

/// Evaluates a filter-error problem at any unknowns ξ: the free θ, then the free intensities, SI.
pub struct FilterEvaluator<'p> {
    pub(super) problem: &'p Problem,
    pub(super) layout: Layout,
    /// R in the gain to begin with.
    pub(super) start_noise: Weighting,
    predictor: Predictor<'p>,
    parameters: Vec<f64>,
    full: bool,
    /// Runs with sensitivities, and without, so far.
    pub(super) evaluations: usize,
    pub(super) simulations: usize,
}

/// The share of a state's prediction error that a sample takes away, in the segment where it is largest.
#[derive(Clone)]
pub(super) struct Share {
    pub value: f64,
    /// By place.
    pub slope: DVector<f64>,
}

impl<'p> FilterEvaluator<'p> {
    /// # Errors
    /// The measured outputs have no scatter to begin with.
    pub fn new(problem: &'p Problem) -> Result<Self, Unusable> {
        let start_noise = gain_noise(problem)?;
        let layout = Layout::new(problem, &automatic_intensities(problem, &start_noise)?);
        let full = matches!(
            problem.options.noise,
            Noise::Estimated {
                structure: NoiseStructure::Full
            }
        );
        Ok(Self {
            problem,
            layout,
            start_noise,
            predictor: Predictor::new(problem),
            parameters: Vec::new(),
            full,
            evaluations: 0,
            simulations: 0,
        })
    }

    /// The start values.
    pub fn start(&self) -> Vec<f64> {
        self.layout.start(self.problem)
    }

    /// Cost and gradient at ξ, with the start's R in the gain.
    ///
    /// # Errors
    /// There is no steady gain, or the predictions leave the range of numbers.
    pub fn at(&mut self, xi: &[f64]) -> Result<FilterEquations, Unusable> {
        let weight = self.start_noise.inverse.clone();
        let (sums, _) = self.sums(xi, &weight)?;
        let problem = self.problem;
        let weighting = Weighting::at(problem, xi, &sums.residuals)?;
        let mut prior = DVector::zeros(xi.len());
        priors::add_gradient(&problem.unknowns, xi, &mut prior);
        Ok(FilterEquations {
            cost: weighting.cost,
            descent: weighting.descent(&sums) - prior,
        })
    }

    /// Calls `each` with the setting of each segment.
    fn settings(
        &mut self,
        xi: &[f64],
        weight: &DMatrix<f64>,
        mut each: impl FnMut(&mut Self, usize, &Setting<'_>) -> Result<(), Unusable>,
    ) -> Result<(), Unusable> {
        let problem = self.problem;
        let intensities = self.layout.intensities(xi);
        let theta = &xi[..self.layout.parameters];
        for (index, segment) in problem.segments.iter().enumerate() {
            let mut parameters = std::mem::take(&mut self.parameters);
            set_parameters(problem, index, theta, &mut parameters)?;
            let sizes = problem.model.paths.at(&parameters);
            let interpolation = problem.options.input_interpolation;
            let mut driven = driven(&problem.model, interpolation, segment, &sizes);
            if let Cow::Owned(driven) = &mut driven {
                driven.measured.clone_from(&segment.measured);
            }
            let setting = Setting {
                model: &problem.model,
                segment: &driven,
                parameters: &parameters,
                intensities: &intensities,
                weight,
            };
            let done = each(self, index, &setting);
            self.parameters = parameters;
            done?;
        }
        Ok(())
    }

    /// Innovations alone; `also` sees each prediction with its segment's index and gain.
    pub(super) fn innovations(
        &mut self,
        xi: &[f64],
        weight: &DMatrix<f64>,
        mut also: impl FnMut(usize, &Gain, &Predicted<'_>),
    ) -> Result<ResidualSums, Unusable> {
        self.simulations += 1;
        let outputs = self.problem.model.outputs.len();
        let full = self.full;
        let mut sums = DMatrix::zeros(outputs, outputs);
        self.settings(xi, weight, |this, index, setting| {
            let gain = gain(setting, index)?;
            let none = (&[][..], &[][..]);
            this.predictor
                .run(setting.segment, setting.parameters, &gain, none, |at| {
                    add_residuals(&mut sums, at.innovations, full);
                    also(index, &gain, at);
                });
            Ok(())
        })?;
        finished(sums)
    }

    /// Shows the gain of each segment to `each`.
    pub(super) fn gains(
        &mut self,
        xi: &[f64],
        weight: &DMatrix<f64>,
        mut each: impl FnMut(&Gain),
    ) -> Result<(), Unusable> {
        self.settings(xi, weight, |_, index, setting| {
            each(&gain(setting, index)?);
            Ok(())
        })
    }

    /// The sums, and by state its share.
    pub(super) fn sums(
        &mut self,
        xi: &[f64],
        weight: &DMatrix<f64>,
    ) -> Result<(Sums, Vec<Share>), Unusable> {
        self.evaluations += 1;
        let problem = self.problem;
        let (outputs, unknowns) = (problem.model.outputs.len(), self.layout.len());
        let full = self.full;
        let mut total = Sums::zeros(outputs, unknowns, full);
        let mut shares = Shares::new(problem.model.states.len());
        self.settings(xi, weight, |this, index, setting| {
            let gain = gain(setting, index)?;
            let (columns, places) = this.layout.columns(problem, index);
            let changes = gain.changes(setting, &columns);
            shares.add(&gain, &changes, &places, unknowns);
            let width = columns.len();
            let mut local = LocalSums::new(outputs, width, full);
            this.predictor.run(
                setting.segment,
                setting.parameters,
                &gain,
                (&columns, &changes),
                |at| {
                    add_residuals(&mut total.residuals, at.innovations, full);
                    local.add(at);
                },
            );
            local.add_to(&places, &mut total);
            Ok(())
        })?;
        mirror(&mut total.residuals);
        Ok((total.finite()?, shares.0))
    }

    /// The shares and their slopes by the intensities alone: quick, without a look at the data.
    pub(super) fn shares(
        &mut self,
        xi: &[f64],
        weight: &DMatrix<f64>,
    ) -> Result<Vec<Share>, Unusable> {
        let problem = self.problem;
        let unknowns = self.layout.len();
        let mut shares = Shares::new(problem.model.states.len());
        self.settings(xi, weight, |this, index, setting| {
            let gain = gain(setting, index)?;
            let (columns, places) = this.layout.columns(problem, index);
            let own = columns.len() - this.layout.free.len();
            let changes = gain.changes(setting, &columns[own..]);
            shares.add(&gain, &changes, &places[own..], unknowns);
            Ok(())
        })?;
        Ok(shares.0)
    }
}

fn gain(setting: &Setting<'_>, segment: usize) -> Result<Gain, Unusable> {
    Gain::steady(setting).ok_or(Unusable::NoSteadyGain { segment })
}

fn finished(mut sums: ResidualSums) -> Result<ResidualSums, Unusable> {
    mirror(&mut sums);
    if sums.iter().all(|value| value.is_finite()) {
        Ok(sums)
    } else {
        Err(Unusable::NotFinite)
    }
}

fn add_residuals(sums: &mut ResidualSums, e: &[f64], full: bool) {
    for i in 0..e.len() {
        for j in if full { 0..=i } else { i..=i } {
            sums[(i, j)] += e[i] * e[j];
        }
    }
}

/// By state, the share of the segment where it is largest.
struct Shares(Vec<Share>);

impl Shares {
    fn new(states: usize) -> Self {
        let none = Share {
            value: f64::NEG_INFINITY,
            slope: DVector::zeros(0),
        };
        Self(vec![none; states])
    }

    fn add(&mut self, gain: &Gain, changes: &[super::gain::Change], places: &[usize], len: usize) {
        for (state, (share, &value)) in self.0.iter_mut().zip(&gain.shares()).enumerate() {
            if value > share.value {
                let mut slope = DVector::zeros(len);
                for (change, &place) in changes.iter().zip(places) {
                    slope[place] += change.share[state];
                }
                *share = Share { value, slope };
            }
        }
    }
}

/// The sums of one segment, in its own columns.
struct LocalSums {
    width: usize,
    full: bool,
    /// By pair of outputs, then row, then column; where both outputs are the same only up to the diagonal.
    products: Vec<Vec<f64>>,
    /// By output i, then j, then column: Σ S_iᵀ e_j.
    gradients: Vec<Vec<Vec<f64>>>,
}

impl LocalSums {
    fn new(outputs: usize, width: usize, full: bool) -> Self {
        let others = if full { outputs } else { 1 };
        Self {
            width,
            full,
            products: vec![vec![0.0; width * width]; pairs(outputs, full).count()],
            gradients: vec![vec![vec![0.0; width]; others]; outputs],
        }
    }

    fn add(&mut self, at: &Predicted<'_>) {
        let width = self.width;
        if width == 0 {
            return;
        }
        let row = |i: usize| &at.slopes[i * width..(i + 1) * width];
        for i in 0..at.innovations.len() {
            for j in if self.full { 0..=i } else { i..=i } {
                let to = &mut self.products[pair(i, j, self.full)];
                for (a, (to, &factor)) in to.chunks_exact_mut(width).zip(row(i)).enumerate() {
                    let until = if i == j { a + 1 } else { width };
                    for (to, value) in to[..until].iter_mut().zip(row(j)) {
                        *to += factor * value;
                    }
                }
            }
            for (j, to) in self.gradients[i].iter_mut().enumerate() {
                let innovation = at.innovations[if self.full { j } else { i }];
                for (to, value) in to.iter_mut().zip(row(i)) {
                    *to += innovation * value;
                }
            }
        }
    }

    /// Adds to the sums of all segments; `places` are those of the columns among the unknowns.
    fn add_to(self, places: &[usize], total: &mut Sums) {
        let places: Vec<Option<usize>> = places.iter().copied().map(Some).collect();
        let places = vec![places; self.gradients.len()];
        let gradients = self.gradients.iter();
        let gradients = gradients.map(|of_output| of_output.iter().map(Vec::as_slice));
        let width = self.width;
        let product = |values: Vec<f64>| Product { values, width };
        total.add(places, gradients, self.products.into_iter().map(product));
    }
}
