//! How much a gradient scatters when residuals are coloured.
//!
//! An estimate moves by F⁻¹ Σ_k S_kᵀ R⁻¹ e_k with the noise e, so that its covariance is
//!
//! ```text
//! F⁻¹ B F⁻¹,   B = Σ_k Σ_l S_kᵀ R⁻¹ Γ(k − l) R⁻¹ S_l
//! ```
//!
//! (Maine, Iliff, NASA RP-1168; Morelli, Klein, J. Guidance 20(1), 1997; Jategaonkar ch. 5), which is F⁻¹ only
//! where Γ is R at lag 0 and nothing else. Γ comes from an autoregressive model of each output's residual (den
//! Haan, Levin 1997) rather than from a window of its sample values: B then is a sum of squares of filtered
//! sensitivities, never negative, in a memory of as many rows as the model's order however long the recording is.
//! What the fit absorbed of the noise is put back first (`absorbed`).
//! Residuals of different outputs are correlated as their white innovations are.

use nalgebra::{DMatrix, SymmetricEigen};

use super::autoregression::{Autoregression, most_lags};
use crate::estimate::evaluation::evaluate::Evaluate;
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::history::TimeHistory;
use crate::simulate::Block;
use crate::stop;

/// A segment's end leaves a filter ringing; this many samples of it count.
const MOST_RINGING: usize = 10_000;

/// Of a filter's state: what is left of it, relative to its largest, that counts no more.
const SILENCE: f64 = 1e-6;

/// The colour of all residuals.
pub(crate) struct Colour {
    /// By output.
    pub models: Vec<Autoregression>,
    /// A square root of the covariance of the innovations, outputs by outputs.
    pub root: DMatrix<f64>,
}

impl Colour {
    /// Of the residuals of all segments as they are; lags count in samples. Missing samples (NaN) do not count.
    pub(crate) fn of(histories: &[TimeHistory]) -> Self {
        Self::of_noise(histories, &[])
    }

    /// Of the noise that left these residuals to a fit which absorbed some of it: by output, then lag, a sum over
    /// samples.
    pub(crate) fn of_noise(histories: &[TimeHistory], absorbed: &[Vec<f64>]) -> Self {
        let outputs = histories.first().map_or(0, |history| history.outputs.len());
        let model = |i: usize| {
            let series = || histories.iter().map(move |h| &*h.outputs[i].residual);
            let count = series().flatten().filter(|e| e.is_finite()).count();
            let lags = 0..=most_lags(count);
            let autocovariance: Vec<f64> = lags
                .map(|lag| {
                    let missing = absorbed.get(i).map_or(0.0, |by_lag| by_lag[lag]);
                    let seen: f64 = series().map(|e| lagged(e, lag)).sum();
                    (seen + missing) / count as f64
                })
                .collect();
            Autoregression::fit(&autocovariance, count)
        };
        let models: Vec<Autoregression> = (0..outputs).map(model).collect();
        let innovations: Vec<Vec<f64>> = (models.iter().enumerate())
            .map(|(i, model)| {
                let all = histories.iter().map(|h| &*h.outputs[i].residual);
                all.flat_map(|e| innovations(e, model)).collect()
            })
            .collect();
        let deviation = |i: usize| models[i].variance.sqrt();
        let covariance = DMatrix::from_fn(outputs, outputs, |i, j| {
            deviation(i) * deviation(j) * correlation(&innovations[i], &innovations[j], i == j)
        });
        Self {
            root: root(covariance),
            models,
        }
    }
}

/// Σ_k e_k e_(k+lag)
fn lagged(e: &[f64], lag: usize) -> f64 {
    stop::check();
    let pairs = e.iter().zip(e.iter().skip(lag));
    pairs.map(|(a, b)| a * b).filter(|v| v.is_finite()).sum()
}

/// w_k = e_k − Σ_m a_m e_(k+m), backwards in time; NaN where it cannot be told.
fn innovations<'e>(e: &'e [f64], model: &'e Autoregression) -> impl Iterator<Item = f64> + 'e {
    (0..e.len()).map(|k| {
        let predicted: f64 = (model.coefficients.iter().enumerate())
            .map(|(m, a)| a * e.get(k + 1 + m).copied().unwrap_or(f64::NAN))
            .sum();
        e[k] - predicted
    })
}

fn correlation(a: &[f64], b: &[f64], same: bool) -> f64 {
    if same {
        return 1.0;
    }
    stop::check();
    let both = a.iter().zip(b);
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (a, b) in both.filter(|(a, b)| a.is_finite() && b.is_finite()) {
        ab += a * b;
        aa += a * a;
        bb += b * b;
    }
    let correlation = ab / (aa * bb).sqrt();
    if correlation.is_finite() {
        correlation
    } else {
        0.0
    }
}

/// A matrix whose square is `covariance`; what missing samples made negative of it is none.
pub(crate) fn root(covariance: DMatrix<f64>) -> DMatrix<f64> {
    let deviation = covariance.diagonal().map(f64::sqrt);
    let scale = deviation.map(|d| if d > 0.0 { d.recip() } else { 0.0 });
    // as correlations: units must not decide what is rounding
    let scaled = DMatrix::from_diagonal(&scale) * &covariance * DMatrix::from_diagonal(&scale);
    let Some(eigen) = SymmetricEigen::try_new(scaled, f64::EPSILON, 10_000) else {
        return DMatrix::from_diagonal(&deviation);
    };
    let roots = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
    DMatrix::from_diagonal(&deviation) * eigen.eigenvectors * DMatrix::from_diagonal(&roots)
}

/// B at θ, in θ's places; `inverse` is R⁻¹.
pub(crate) fn gradient_covariance(
    evaluator: &mut Evaluator<'_>,
    theta: &[f64],
    inverse: &DMatrix<f64>,
    colour: &Colour,
) -> Result<DMatrix<f64>, Unusable> {
    let problem = evaluator.problem();
    let mut total = DMatrix::zeros(theta.len(), theta.len());
    evaluator.evaluations += 1;
    for (index, segment) in problem.segments.iter().enumerate() {
        // columns of this segment: its own places of θ
        let mut places: Vec<usize> = (0..problem.model.parameters.len())
            .filter_map(|parameter| problem.unknowns.place(index, parameter))
            .collect();
        places.sort_unstable();
        let column = |parameter: usize| {
            let place = problem.unknowns.place(index, parameter)?;
            places.binary_search(&place).ok()
        };
        let columns = (0..problem.model.outputs.len())
            .map(|i| {
                problem
                    .columns
                    .of_output(i)
                    .iter()
                    .map(|&p| column(p))
                    .collect()
            })
            .collect();
        let mut filter = Filter::new(columns, places.len(), inverse, colour);
        evaluator.sweep(theta, index, |block| filter.add(block, &segment.measured))?;
        let own = filter.end();
        for (a, &row) in places.iter().enumerate() {
            for (b, &column) in places.iter().enumerate() {
                total[(row, column)] += own[(a, b)];
            }
        }
    }
    Ok(total)
}

/// Filters R⁻¹ S along one segment as the noise is coloured, and sums up the squares.
struct Filter<'c> {
    colour: &'c Colour,
    inverse: &'c DMatrix<f64>,
    /// By output: where the entries of its rows of ∂y/∂θ stand.
    columns: Vec<Vec<Option<usize>>>,
    width: usize,
    /// By output: filtered rows, the latest last; as many from before as the order asks for, then the block's.
    filtered: Vec<Vec<f64>>,
    sum: DMatrix<f64>,
}

impl<'c> Filter<'c> {
    fn new(
        columns: Vec<Vec<Option<usize>>>,
        width: usize,
        inverse: &'c DMatrix<f64>,
        colour: &'c Colour,
    ) -> Self {
        let before = |model: &Autoregression| vec![0.0; model.coefficients.len() * width];
        Self {
            filtered: colour.models.iter().map(before).collect(),
            sum: DMatrix::zeros(width, width),
            colour,
            inverse,
            columns,
            width,
        }
    }

    /// u_j(k) = Σ_i (R⁻¹)_ij S_i(k) + Σ_m a_jm u_j(k − m)
    fn add(&mut self, block: &Block<'_>, measured: &[Vec<f64>]) {
        for (j, measured) in measured.iter().enumerate() {
            stop::check();
            for k in 0..block.len {
                let at = self.begin_row(j);
                if measured[block.first + k].is_finite() {
                    let row = &mut self.filtered[j][at..];
                    for (i, columns) in self.columns.iter().enumerate() {
                        let weight = self.inverse[(i, j)];
                        if weight != 0.0 {
                            for (column, s) in columns.iter().zip(block.row(i, k)) {
                                if let Some(column) = *column {
                                    row[column] += weight * s;
                                }
                            }
                        }
                    }
                }
            }
        }
        self.square(block.len);
    }

    /// A row more, with what the rows before make of it; where it begins.
    fn begin_row(&mut self, output: usize) -> usize {
        let rows = &mut self.filtered[output];
        let at = rows.len();
        rows.resize(at + self.width, 0.0);
        let (before, row) = rows.split_at_mut(at);
        if self.width > 0 {
            let latest_first = before.rchunks_exact(self.width);
            for (a, earlier) in (self.colour.models[output].coefficients.iter()).zip(latest_first) {
                row.iter_mut()
                    .zip(earlier)
                    .for_each(|(to, from)| *to += a * from);
            }
        }
        at
    }

    /// Adds the squares of the latest `len` rows, and forgets all that the next ones do not need.
    fn square(&mut self, len: usize) {
        let outputs = self.columns.len();
        let latest = |j: usize| {
            let rows = &self.filtered[j];
            DMatrix::from_column_slice(self.width, len, &rows[rows.len() - len * self.width..])
        };
        let rows: Vec<DMatrix<f64>> = (0..outputs).map(latest).collect();
        for w in 0..outputs {
            stop::check();
            let mut mixed = DMatrix::zeros(self.width, len);
            for (j, rows) in rows.iter().enumerate() {
                let share = self.colour.root[(j, w)];
                if share != 0.0 {
                    mixed.zip_apply(rows, |to, from| *to += share * from);
                }
            }
            self.sum.gemm(1.0, &mixed, &mixed.transpose(), 1.0);
        }
        for (rows, model) in self.filtered.iter_mut().zip(&self.colour.models) {
            let kept = rows.len() - model.coefficients.len() * self.width;
            rows.drain(..kept);
        }
    }

    /// Lets the filters ring out; the sum.
    fn end(mut self) -> DMatrix<f64> {
        const TOGETHER: usize = 16;
        let begin = self.sizes();
        let is_silent = |now: &[f64]| {
            now.iter()
                .zip(&begin)
                .all(|(now, then)| *now <= SILENCE * then)
        };
        for _ in 0..MOST_RINGING / TOGETHER {
            if is_silent(&self.sizes()) {
                break;
            }
            for j in 0..self.columns.len() {
                for _ in 0..TOGETHER {
                    self.begin_row(j);
                }
            }
            self.square(TOGETHER);
        }
        self.sum
    }

    /// By output: the largest entry that later rows will build on.
    fn sizes(&self) -> Vec<f64> {
        let largest = |rows: &Vec<f64>| rows.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        self.filtered.iter().map(largest).collect()
    }
}
