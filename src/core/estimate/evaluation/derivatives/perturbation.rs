//! ∂y/∂θ column by column: each parameter is perturbed in turn and the segment simulated again.
//!
//! All simulations go along the segment together, a stretch at a time, so that memory does not grow with the
//! length of the recording, but for models whose inputs or outputs have paths.

use nalgebra::{DMatrix, DVector};

use crate::estimate::likelihood::sums::{Product, Sums, mirror, pairs};
use crate::estimate::problem::missing::present;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::problem::{Problem, set_parameters};
use crate::model::Scalar;
use crate::simulate::{March, Standing};
use crate::stop;

/// Samples in a stretch.
pub(crate) const STRETCH: usize = 256;

/// Parameters smaller than this, SI, are perturbed as if they had this size: a bias of 0 has no size of its own.
const SMALLEST_SIZE: f64 = 1e-2;

/// The size of a parameter that relative steps refer to.
pub(crate) fn size(value: f64) -> f64 {
    value.abs().max(SMALLEST_SIZE)
}

/// A technique that simulates with one parameter changed.
pub(crate) trait Perturbation {
    type Number: Scalar;
    /// Simulations for each parameter.
    const RUNS: usize;
    /// The parameter as simulation `run` has it.
    fn perturbed(&self, run: usize, value: f64) -> Self::Number;
    /// ∂y/∂θ from y and what the simulations made of it.
    fn slope(&self, value: f64, y: f64, runs: &[Self::Number]) -> f64;
}

/// Residuals and columns of ∂y/∂θ over some consecutive samples of a segment.
pub(crate) struct Differentiated<'a> {
    /// z − y by output, then sample of the stretch.
    pub(crate) residuals: &'a [DVector<f64>],
    /// By output: samples by the segment's own columns.
    pub(crate) slopes: &'a [DMatrix<f64>],
}

/// Runs along a segment and hands each stretch to `sink`. `places` are those of θ to differentiate by; the answer
/// says which of them the segment has columns for, in their order.
///
/// # Errors
/// The unperturbed simulation leaves the range of numbers.
pub(crate) fn columns<P: Perturbation>(
    technique: &P,
    problem: &Problem,
    index: usize,
    theta: &[f64],
    places: &[usize],
    mut sink: impl FnMut(&Differentiated<'_>),
) -> Result<Vec<usize>, Unusable> {
    let (model, options) = (&problem.model, &problem.options);
    let (segment, outputs) = (&problem.segments[index], model.outputs.len());
    let mut values = Vec::new();
    set_parameters(problem, index, theta, &mut values)?;
    let parameter = |place: usize| problem.unknowns.at(place).parameter;
    let own = |place: &usize| problem.unknowns.place(index, parameter(*place)) == Some(*place);
    let own: Vec<usize> = places.iter().copied().filter(own).collect();

    let mut plain = March::new(model, options.integrator, options.input_interpolation);
    let mut base = plain.start(&values);
    let mut march = March::new(model, options.integrator, options.input_interpolation);
    let mut changed: Vec<P::Number> = values.iter().map(|&v| Scalar::from_f64(v)).collect();
    let mut standings: Vec<Standing<P::Number>> = Vec::new();
    for &place in &own {
        let (at, value) = (parameter(place), values[parameter(place)]);
        for run in 0..P::RUNS {
            changed[at] = technique.perturbed(run, value);
            standings.push(march.start(&changed));
        }
        changed[at] = Scalar::from_f64(value);
    }

    let stretch = March::<f64>::stretch(model, segment, STRETCH);
    for first in (0..segment.len()).step_by(stretch) {
        let until = (first + stretch).min(segment.len());
        let len = until - first;
        let mut y = vec![DVector::zeros(len); outputs];
        plain.advance(&mut base, segment, &values, until, |k, sample| {
            y.iter_mut()
                .zip(sample)
                .for_each(|(y, &v)| y[k - first] = v);
        });
        if !base.is_finite() {
            return Err(Unusable::LeftRange {
                segment: index,
                sample: first,
            });
        }
        let mut slopes = vec![DMatrix::zeros(len, own.len()); outputs];
        let zero = <P::Number as Scalar>::from_f64(0.0);
        // by output and sample, then run
        let mut made = vec![zero; outputs * len * P::RUNS];
        for (column, &place) in own.iter().enumerate() {
            let (at, value) = (parameter(place), values[parameter(place)]);
            for run in 0..P::RUNS {
                changed[at] = technique.perturbed(run, value);
                let standing = &mut standings[column * P::RUNS + run];
                march.advance(standing, segment, &changed, until, |k, sample| {
                    for (i, &v) in sample.iter().enumerate() {
                        made[(i * len + k - first) * P::RUNS + run] = v;
                    }
                });
            }
            changed[at] = Scalar::from_f64(value);
            for (i, slopes) in slopes.iter_mut().enumerate() {
                for k in 0..len {
                    let runs = &made[(i * len + k) * P::RUNS..][..P::RUNS];
                    slopes[(k, column)] = technique.slope(value, y[i][k], runs);
                }
            }
        }
        for (i, y) in y.iter_mut().enumerate() {
            let measured = &segment.measured[i][first..until];
            y.iter_mut()
                .zip(measured)
                .for_each(|(y, z)| *y = present(z - *y, *z));
            for k in (0..len).filter(|&k| measured[k].is_nan()) {
                slopes[i].row_mut(k).fill(0.0);
            }
        }
        sink(&Differentiated {
            residuals: &y,
            slopes: &slopes,
        });
    }
    Ok(own)
}

/// The sums that a step is made of; `full` where all pairs of outputs count.
pub(crate) fn sums<P: Perturbation>(
    technique: &P,
    problem: &Problem,
    theta: &[f64],
    full: bool,
) -> Result<Sums, Unusable> {
    let outputs = problem.model.outputs.len();
    let places: Vec<usize> = (0..problem.unknowns.len()).collect();
    let mut total = Sums::zeros(outputs, places.len(), full);
    for index in 0..problem.segments.len() {
        let mut local: Option<LocalSums> = None;
        let own = columns(technique, problem, index, theta, &places, |stretch| {
            let width = stretch.slopes[0].ncols();
            let local = local.get_or_insert_with(|| LocalSums::zeros(outputs, width, full));
            local.add(stretch, full);
        })?;
        if let Some(local) = local {
            local.add_to(&own, &mut total);
        }
    }
    mirror(&mut total.residuals);
    total.finite()
}

/// The sums of one segment, in its own columns.
struct LocalSums {
    /// Residuals and gradients.
    sums: Sums,
    /// By pair of outputs (i, j): Σ S_jᵀ S_i.
    products: Vec<DMatrix<f64>>,
}

impl LocalSums {
    fn zeros(outputs: usize, width: usize, full: bool) -> Self {
        Self {
            sums: Sums::zeros(outputs, width, full),
            products: vec![DMatrix::zeros(width, width); pairs(outputs, full).count()],
        }
    }

    fn add(&mut self, stretch: &Differentiated<'_>, full: bool) {
        let (slopes, residuals) = (stretch.slopes, stretch.residuals);
        for (product, (i, j)) in self.products.iter_mut().zip(pairs(slopes.len(), full)) {
            stop::check();
            self.sums.residuals[(i, j)] += residuals[i].dot(&residuals[j]);
            product.gemm_tr(1.0, &slopes[j], &slopes[i], 1.0);
        }
        for i in 0..slopes.len() {
            for (j, gradient) in self.sums.gradients[i].iter_mut().enumerate() {
                let residual = &residuals[if full { j } else { i }];
                gradient.gemv_tr(1.0, &slopes[i], residual, 1.0);
            }
        }
    }

    /// Adds to the sums of all segments; `places` are those of the columns in θ.
    fn add_to(self, places: &[usize], total: &mut Sums) {
        let width = places.len();
        let places: Vec<Option<usize>> = places.iter().copied().map(Some).collect();
        let places = vec![places; self.sums.gradients.len()];
        total.residuals += &self.sums.residuals;
        let gradients = self.sums.gradients.iter();
        let gradients = gradients.map(|of_output| of_output.iter().map(DVector::as_slice));
        // column by column of Σ S_jᵀ S_i is row by row of Σ S_iᵀ S_j
        let product = |product: DMatrix<f64>| Product {
            values: product.as_slice().to_vec(),
            width,
        };
        let products = self.products.into_iter().map(product);
        total.add(places, gradients, products);
    }
}
