//! Shapes of a force over the time of a flight: cubic B-splines, evenly spaced.

/// The splines of one flight.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Shapes {
    spacing: f64,
    pub count: usize,
    /// Seconds from the flight's first sample to each.
    pub elapsed: Vec<f64>,
}

/// Samples between two knots, at least: what is quicker cannot be told from noise.
const FEWEST_SAMPLES: f64 = 3.0;

impl Shapes {
    /// Splines with knots `spacing` seconds apart, or so far that there are `most` intervals.
    pub(super) fn over(elapsed: Vec<f64>, spacing: f64, most: usize) -> Self {
        let duration = elapsed.last().copied().unwrap_or(0.0);
        let step = duration / elapsed.len().max(2).saturating_sub(1) as f64;
        let spacing = spacing.max(FEWEST_SAMPLES * step);
        let intervals = ((duration / spacing).ceil() as usize).clamp(1, most);
        Self {
            spacing: (duration / intervals as f64).max(f64::MIN_POSITIVE),
            count: intervals + 3,
            elapsed,
        }
    }

    /// The four shapes that are not zero at a time: the index of the first, and their values.
    pub(super) fn at(&self, seconds: f64) -> (usize, [f64; 4]) {
        let at = (seconds / self.spacing).max(0.0);
        let interval = (at.floor() as usize).min(self.count - 4);
        let u = at - interval as f64;
        let v = 1.0 - u;
        let values = [
            v * v * v / 6.0,
            (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0,
            (3.0 * v * v * v - 6.0 * v * v + 4.0) / 6.0,
            u * u * u / 6.0,
        ];
        (interval, values)
    }

    /// One shape, sample by sample.
    pub(super) fn shape(&self, index: usize) -> Vec<f64> {
        let of = |seconds: &f64| {
            let (first, values) = self.at(*seconds);
            index
                .checked_sub(first)
                .and_then(|place| values.get(place))
                .copied()
                .unwrap_or(0.0)
        };
        self.elapsed.iter().map(of).collect()
    }

    /// The sum of all shapes, each with its size, at a time.
    pub(super) fn sum(&self, sizes: &[f64], seconds: f64) -> f64 {
        let (first, values) = self.at(seconds);
        sizes[first..]
            .iter()
            .zip(values)
            .map(|(size, value)| size * value)
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_add_up_to_one_and_follow_a_line() {
        let elapsed: Vec<f64> = (0..101).map(|k| f64::from(k) * 0.02).collect();
        let shapes = Shapes::over(elapsed, 0.5, 100);
        assert_eq!(shapes.count, 7);
        let ones = vec![1.0; shapes.count];
        let line: Vec<f64> = (0..7).map(|j| 0.5 * (f64::from(j) - 1.0)).collect();
        for &seconds in &shapes.elapsed {
            assert!((shapes.sum(&ones, seconds) - 1.0).abs() < 1e-12);
            assert!((shapes.sum(&line, seconds) - seconds).abs() < 1e-12);
        }
        let third = shapes.shape(3);
        assert!((third[50] - 4.0 / 6.0).abs() < 1e-12);
        assert_eq!((third[0], third[100]), (0.0, 0.0));
    }

    #[test]
    fn a_short_flight_has_fewer_shapes_than_samples() {
        let elapsed: Vec<f64> = (0..10).map(|k| f64::from(k) * 0.02).collect();
        assert!(Shapes::over(elapsed, 0.01, 100).count <= 6);
    }
}
