//! The columns that a structure is chosen from.

use nalgebra::{DMatrix, DVector};

/// Terms over the samples, and what they are to explain.
#[derive(Clone, Debug)]
pub struct Candidates {
    /// By column: what the term is called.
    pub names: Vec<String>,
    /// Samples by terms, without the constant.
    pub columns: DMatrix<f64>,
    /// What is to be explained, z.
    pub response: DVector<f64>,
    /// Whether a constant is in the model from the start.
    pub constant: bool,
}

/// A column that the others explain but for this share of its square is one of them, to rounding.
pub(super) const DEPENDENT: f64 = 1e-10;

impl Candidates {
    pub(super) fn samples(&self) -> usize {
        self.response.len()
    }

    /// The constant, if there is one, and the columns of some terms.
    pub(super) fn design(&self, terms: &[usize]) -> DMatrix<f64> {
        let constant = usize::from(self.constant);
        let mut design = DMatrix::from_element(self.samples(), terms.len() + constant, 1.0);
        for (place, &term) in terms.iter().enumerate() {
            design
                .column_mut(place + constant)
                .copy_from(&self.columns.column(term));
        }
        design
    }

    /// Σ(z - z̄)²
    pub(super) fn variation(&self) -> f64 {
        let mean = self.response.mean();
        self.response.iter().map(|z| (z - mean).powi(2)).sum()
    }
}
