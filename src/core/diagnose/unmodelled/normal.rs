//! What flights say of a force's sizes, in the metric of a colour.

use nalgebra::{DMatrix, DVector};

/// What the flights say of a force's sizes.
#[derive(Clone, Debug)]
pub(super) struct Normal {
    /// G
    pub gram: DMatrix<f64>,
    /// b
    pub moment: DVector<f64>,
    /// (W S)ᵀ span
    pub imitated: DMatrix<f64>,
}

impl Normal {
    /// What they say of fewer numbers that the sizes are made of: c = B β.
    pub(super) fn through(&self, made: &DMatrix<f64>) -> Self {
        Self {
            gram: made.tr_mul(&(&self.gram * made)),
            moment: made.tr_mul(&self.moment),
            imitated: made.tr_mul(&self.imitated),
        }
    }
}
