//! Shapes of a force over the time of a flight.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::splines::Splines;
use crate::simulate::Segment;
use crate::stop;

/// The splines in time of one flight.
#[derive(Clone, Debug)]
pub(super) struct Shapes {
    splines: Splines,
    pub count: usize,
    /// Seconds from the flight's first sample to each.
    pub elapsed: Vec<f64>,
}

/// Samples between two knots, at least: what is quicker cannot be told from noise.
const FEWEST_SAMPLES: f64 = 3.0;

/// Of shapes that hardly any sample sees.
const RIDGE: f64 = 1e-9;

/// Shapes of all flights together, at most, and products that one sum over all samples may take: time and memory have an
/// end, however much was flown.
const MOST_SHAPES: usize = 240;
const MOST_PRODUCTS: usize = 100_000_000;

/// With fewer intervals over a flight a force is no history.
const FEWEST_INTERVALS: usize = 4;

/// How fine a force is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knots {
    /// s
    pub spacing: f64,
    /// Intervals of one flight, at most.
    pub most: usize,
}

impl Shapes {
    /// Of some flights, each sample with so many outputs; coarser where there is much to sum. `None` where even the coarsest
    /// would take too long.
    pub(super) fn along(segments: &[Segment], outputs: usize, knots: Knots) -> Option<Vec<Self>> {
        let samples: usize = segments.iter().map(Segment::len).sum();
        let by_products = (MOST_PRODUCTS / (samples * outputs).max(1)).isqrt();
        let by_number = MOST_SHAPES / segments.len().max(1);
        let intervals = by_products.min(by_number).checked_sub(3)?;
        let of = |segment: &Segment| {
            Self::over(segment.elapsed(), knots.spacing, intervals.min(knots.most))
        };
        (intervals >= FEWEST_INTERVALS).then(|| segments.iter().map(of).collect())
    }

    /// Knots are `spacing` seconds apart, or so far that there are `most` intervals.
    pub(super) fn over(elapsed: Vec<f64>, spacing: f64, most: usize) -> Self {
        let duration = elapsed.last().copied().unwrap_or(0.0);
        let step = duration / elapsed.len().max(2).saturating_sub(1) as f64;
        let spacing = spacing.max(FEWEST_SAMPLES * step);
        let intervals = ((duration / spacing).ceil() as usize).clamp(1, most);
        let splines = Splines::between(0.0, duration, intervals);
        Self {
            count: splines.count,
            splines,
            elapsed,
        }
    }

    /// One shape, sample by sample.
    pub(super) fn shape(&self, index: usize) -> Vec<f64> {
        stop::check();
        let of = |seconds: &f64| self.splines.value(index, *seconds);
        self.elapsed.iter().map(of).collect()
    }

    /// The force at each sample.
    pub(super) fn force(&self, sizes: &[f64]) -> Vec<f64> {
        let of = |seconds: &f64| {
            let (first, values) = self.splines.at(*seconds);
            let pairs = sizes[first..].iter().zip(values);
            pairs.map(|(size, value)| size * value).sum()
        };
        self.elapsed.iter().map(of).collect()
    }

    /// Variance of the force at each sample, from the sizes' covariance.
    pub(super) fn variance(&self, covariance: &DMatrix<f64>) -> Vec<f64> {
        let of = |(k, seconds): (usize, &f64)| {
            stop::check_sometimes(k);
            let (first, values) = self.splines.at(*seconds);
            let values = DVector::from_column_slice(&values);
            let block = covariance.view((first, first), (4, 4));
            (block * &values).dot(&values).max(0.0)
        };
        self.elapsed.iter().enumerate().map(of).collect()
    }

    /// What finds the sizes whose force follows a time history best.
    pub(super) fn fit(&self) -> Option<Fit<'_>> {
        let mut gram = DMatrix::identity(self.count, self.count) * RIDGE;
        for (k, &seconds) in self.elapsed.iter().enumerate() {
            stop::check_sometimes(k);
            let (first, values) = self.splines.at(seconds);
            for (i, a) in values.iter().enumerate() {
                for (j, b) in values.iter().enumerate() {
                    gram[(first + i, first + j)] += a * b;
                }
            }
        }
        Some(Fit {
            shapes: self,
            factor: Cholesky::new(gram)?,
        })
    }
}

/// See [`Shapes::fit`].
pub(super) struct Fit<'s> {
    shapes: &'s Shapes,
    factor: Cholesky<f64, Dyn>,
}

impl Fit<'_> {
    pub(super) fn sizes(&self, force: &[f64]) -> DVector<f64> {
        stop::check();
        let mut moment = DVector::zeros(self.shapes.count);
        for (&seconds, force) in self.shapes.elapsed.iter().zip(force) {
            let (first, values) = self.shapes.splines.at(seconds);
            for (i, value) in values.iter().enumerate() {
                moment[first + i] += value * force;
            }
        }
        self.factor.solve(&moment)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn elapsed(samples: u32) -> Vec<f64> {
        (0..samples).map(|k| f64::from(k) * 0.02).collect()
    }

    #[test]
    fn a_short_flight_has_fewer_shapes_than_samples() {
        assert!(Shapes::over(elapsed(10), 0.01, 100).count <= 6);
        assert_eq!(Shapes::over(elapsed(101), 0.5, 100).count, 7);
    }

    #[test]
    fn a_smooth_history_comes_back() {
        let shapes = Shapes::over(elapsed(301), 0.25, 100);
        let history: Vec<f64> = shapes.elapsed.iter().map(|t| (2.0 * t).sin()).collect();
        let sizes = shapes.fit().unwrap().sizes(&history);
        let back = shapes.force(sizes.as_slice());
        let off = history.iter().zip(&back).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-3);
        let covariance = DMatrix::identity(shapes.count, shapes.count);
        let at_a_knot = shapes.variance(&covariance)[0];
        assert!((at_a_knot - 0.5).abs() < 1e-9, "{at_a_knot}");
    }
}
