//! Sums over the data that a step is made of, by output and unweighted: R is known only when all residuals are.

use nalgebra::{DMatrix, DVector};

use crate::estimate::problem::unusable::Unusable;

/// Σ e eᵀ over all samples, outputs by outputs; only the diagonal unless R is full.
pub(crate) type ResidualSums = DMatrix<f64>;

#[derive(Clone, Debug)]
pub(crate) struct Sums {
    pub residuals: ResidualSums,
    /// By output i, then j: Σ S_iᵀ e_j over all samples, in θ's places. One j, that is i, unless R is full.
    pub gradients: Vec<Vec<DVector<f64>>>,
    /// Those of each segment: in θ's places they would fill many large matrices, with zeros for the most part.
    products: Vec<Products>,
}

/// By output: where the columns of its sensitivities stand in θ; `None` for what is no unknown.
pub(crate) type Places = Vec<Vec<Option<usize>>>;

/// For each pair of outputs (i, j), j ≤ i: Σ S_iᵀ S_j over the samples of a segment, in the columns of its own
/// sensitivities.
#[derive(Clone, Debug)]
struct Products {
    places: Places,
    /// By pair; see [`pairs`]. Where i = j only the lower triangle counts.
    of_pairs: Vec<Product>,
}

#[derive(Clone, Debug)]
pub(crate) struct Product {
    /// Row by row.
    pub values: Vec<f64>,
    /// Of a row, with what fills it up.
    pub width: usize,
}

impl Sums {
    /// Nothing yet; `full` where all pairs of outputs count.
    pub(crate) fn zeros(outputs: usize, unknowns: usize, full: bool) -> Self {
        let columns = if full { outputs } else { 1 };
        Self {
            residuals: DMatrix::zeros(outputs, outputs),
            gradients: vec![vec![DVector::zeros(unknowns); columns]; outputs],
            products: Vec::new(),
        }
    }

    /// # Errors
    /// A residual or a derivative is not a finite number.
    pub(crate) fn finite(self) -> Result<Self, Unusable> {
        let products = self.products.iter().flat_map(|part| &part.of_pairs);
        let mut values = products.flat_map(|product| &product.values);
        if self.residuals.iter().all(|v| v.is_finite()) && values.all(|v| v.is_finite()) {
            Ok(self)
        } else {
            Err(Unusable::NotFinite)
        }
    }

    /// Adds what a segment has in its own columns: Σ S_iᵀ e_j by i, then j, and Σ S_iᵀ S_j by [`pairs`].
    pub(crate) fn add<'g>(
        &mut self,
        places: Places,
        gradients: impl IntoIterator<Item = impl IntoIterator<Item = &'g [f64]>>,
        of_pairs: impl IntoIterator<Item = Product>,
    ) {
        for ((places, own), to) in places.iter().zip(gradients).zip(&mut self.gradients) {
            for (own, to) in own.into_iter().zip(to) {
                for (value, place) in own.iter().zip(places) {
                    if let Some(place) = *place {
                        to[place] += value;
                    }
                }
            }
        }
        let of_pairs = of_pairs.into_iter().collect();
        self.products.push(Products { places, of_pairs });
    }

    /// Σ Sᵀ W S over all samples, in θ's places.
    pub(crate) fn weighted(&self, weight: &DMatrix<f64>) -> DMatrix<f64> {
        let unknowns = self.gradients[0][0].len();
        let mut total = DMatrix::zeros(unknowns, unknowns);
        for part in &self.products {
            part.add_weighted(weight, &mut total);
        }
        total
    }
}

impl Products {
    fn add_weighted(&self, weight: &DMatrix<f64>, total: &mut DMatrix<f64>) {
        let outputs = self.places.len();
        let full = self.of_pairs.len() > outputs;
        for (product, (i, j)) in self.of_pairs.iter().zip(pairs(outputs, full)) {
            let weight = weight[(i, j)];
            for (a, &row) in self.places[i].iter().enumerate() {
                let Some(row) = row else { continue };
                let values = &product.values[a * product.width..][..product.width];
                // where both outputs are the same, the upper triangle is the lower one
                let columns = if i == j { a } else { values.len() };
                for (value, &column) in values[..columns].iter().zip(&self.places[j]) {
                    let Some(column) = column else { continue };
                    total[(row, column)] += value * weight;
                    total[(column, row)] += value * weight;
                }
                if i == j {
                    total[(row, row)] += values[a] * weight;
                }
            }
        }
    }
}

/// The pairs of outputs (i, j), j ≤ i, that count: each with itself alone, unless R is full.
pub(crate) fn pairs(outputs: usize, full: bool) -> impl Iterator<Item = (usize, usize)> {
    (0..outputs).flat_map(move |i| (if full { 0 } else { i }..=i).map(move |j| (i, j)))
}

/// Where, among [`pairs`], the pair of outputs (i, j), j ≤ i, is kept.
pub(crate) fn pair(i: usize, j: usize, full: bool) -> usize {
    if full { i * (i + 1) / 2 + j } else { i }
}

/// The upper triangle from the lower one.
pub(crate) fn mirror(sums: &mut DMatrix<f64>) {
    for i in 0..sums.nrows() {
        for j in 0..i {
            sums[(j, i)] = sums[(i, j)];
        }
    }
}
