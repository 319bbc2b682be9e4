//! A force as a smooth curve over one quantity.

use nalgebra::{DMatrix, DVector};

use super::quantities::Quantity;
use super::shapes::Shapes;
use super::splines::Splines;

/// Intervals of a curve between the ends of what was flown: six to eight knots tell any bend that flights can.
const INTERVALS: usize = 6;

/// The splines of a curve, and what each of them is as a force in time.
pub(super) struct Curve {
    pub splines: Splines,
    /// By flight: the sizes of the shapes in time, one column for each spline of the curve.
    pub sizes: Vec<DMatrix<f64>>,
}

impl Curve {
    /// Over the range of a quantity in all flights.
    pub(super) fn over(quantity: &Quantity, shapes: &[Shapes]) -> Option<Self> {
        let (least, most) = quantity.range(quantity.values.len());
        let splines = Splines::between(least, most, INTERVALS);
        let of = |index: usize| {
            let spline =
                |values: &Vec<f64>| values.iter().map(|&x| splines.value(index, x)).collect();
            quantity
                .values
                .iter()
                .map(spline)
                .collect::<Vec<Vec<f64>>>()
        };
        let histories: Vec<Vec<Vec<f64>>> = (0..splines.count).map(of).collect();
        let sizes = in_time(&histories, shapes)?;
        Some(Self { splines, sizes })
    }

    /// Its values at some places, for sizes of its splines.
    pub(super) fn values(&self, sizes: &DVector<f64>, at: &[f64]) -> Vec<f64> {
        let of = |&x: &f64| {
            let (first, values) = self.splines.at(x);
            let pairs = values.iter().enumerate();
            pairs.map(|(i, value)| value * sizes[first + i]).sum()
        };
        at.iter().map(of).collect()
    }

    /// The variance of those.
    pub(super) fn variances(&self, covariance: &DMatrix<f64>, at: &[f64]) -> Vec<f64> {
        let of = |&x: &f64| {
            let (first, values) = self.splines.at(x);
            let values = DVector::from_column_slice(&values);
            let block = covariance.view((first, first), (4, 4));
            (block * &values).dot(&values).max(0.0)
        };
        at.iter().map(of).collect()
    }
}

/// By flight, the sizes of the shapes in time that follow some histories, one column each. `histories` are by column, then
/// flight.
pub(super) fn in_time(histories: &[Vec<Vec<f64>>], shapes: &[Shapes]) -> Option<Vec<DMatrix<f64>>> {
    let of = |(flight, shapes): (usize, &Shapes)| {
        let fit = shapes.fit()?;
        let columns = histories.iter().map(|history| fit.sizes(&history[flight]));
        Some(DMatrix::from_columns(&columns.collect::<Vec<_>>()))
    };
    shapes.iter().enumerate().map(of).collect()
}
