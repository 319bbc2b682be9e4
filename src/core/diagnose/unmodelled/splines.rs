//! Cubic B-splines over a range, evenly spaced.

#[derive(Clone, PartialEq, Debug)]
pub(super) struct Splines {
    from: f64,
    spacing: f64,
    pub count: usize,
}

impl Splines {
    /// `intervals` of them, at least one.
    pub(super) fn between(from: f64, to: f64, intervals: usize) -> Self {
        let intervals = intervals.max(1);
        Self {
            from,
            spacing: ((to - from) / intervals as f64).max(f64::MIN_POSITIVE),
            count: intervals + 3,
        }
    }

    /// The four splines that are not zero at x: the index of the first, and their values. Beyond the range, those at its
    /// end.
    pub(super) fn at(&self, x: f64) -> (usize, [f64; 4]) {
        let intervals = (self.count - 3) as f64;
        let at = ((x - self.from) / self.spacing).clamp(0.0, intervals);
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

    /// One spline at x.
    pub(super) fn value(&self, index: usize, x: f64) -> f64 {
        let (first, values) = self.at(x);
        let place = index.checked_sub(first);
        place
            .and_then(|place| values.get(place))
            .copied()
            .unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splines_add_up_to_one_and_follow_a_line() {
        let splines = Splines::between(1.0, 3.0, 4);
        assert_eq!(splines.count, 7);
        let sum = |sizes: &[f64], x: f64| -> f64 {
            let (first, values) = splines.at(x);
            sizes[first..].iter().zip(values).map(|(s, v)| s * v).sum()
        };
        let line: Vec<f64> = (0..7).map(|j| 1.0 + 0.5 * (f64::from(j) - 1.0)).collect();
        for k in 0..=20 {
            let x = 1.0 + 0.1 * f64::from(k);
            assert!((sum(&[1.0; 7], x) - 1.0).abs() < 1e-12);
            assert!((sum(&line, x) - x).abs() < 1e-12);
        }
        assert_eq!(splines.at(9.0), splines.at(3.0));
        assert!((splines.value(3, 2.0) - 4.0 / 6.0).abs() < 1e-12);
        assert_eq!(splines.value(6, 1.0), 0.0);
    }
}
