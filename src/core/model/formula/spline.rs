//! The slope of a natural cubic spline through samples.

/// At each of the times, of which there are two or more.
pub(super) fn slopes(time: &[f64], values: &[f64]) -> Vec<f64> {
    let last = time.len() - 1;
    let step = |k: usize| time[k + 1] - time[k];
    let rise = |k: usize| (values[k + 1] - values[k]) / step(k);
    // second derivatives, 0 at the ends, by elimination from the first row on
    let mut diagonal = vec![1.0; last + 1];
    let mut curvature = vec![0.0; last + 1];
    for k in 1..last {
        let (before, behind) = (step(k - 1), step(k));
        let share = if k > 1 { before / diagonal[k - 1] } else { 0.0 };
        diagonal[k] = 2.0 * (before + behind) - share * before;
        curvature[k] = 6.0 * (rise(k) - rise(k - 1)) - share * curvature[k - 1];
    }
    for k in (1..last).rev() {
        curvature[k] = (curvature[k] - step(k) * curvature[k + 1]) / diagonal[k];
    }
    let slope = |k: usize| {
        if k < last {
            rise(k) - step(k) * (2.0 * curvature[k] + curvature[k + 1]) / 6.0
        } else {
            rise(k - 1) + step(k - 1) * (curvature[k - 1] + 2.0 * curvature[k]) / 6.0
        }
    };
    (0..=last).map(slope).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against scipy 1.17.1: `CubicSpline(t, x, bc_type='natural')(t, 1)`.
    #[test]
    fn slopes_are_those_of_scipy() {
        let time = [0.0, 0.4, 1.0, 1.5, 2.5, 3.0];
        let values = [1.0, 0.2, -0.7, 0.4, 2.0, 1.5];
        let expected = [
            -1.8819597663854641,
            -2.2360804672290726,
            0.5033419857235565,
            2.8678131083711875,
            -0.21356262167423748,
            -1.3932186891628813,
        ];
        for (found, expected) in slopes(&time, &values).iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
        assert_eq!(slopes(&[0.0, 2.0], &[1.0, 5.0]), [2.0, 2.0]);
    }
}
