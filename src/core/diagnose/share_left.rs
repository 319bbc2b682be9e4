//! How much of an output a model leaves.

/// The share of an output's variance, about its mean in each flight, that is left: of pairs of what was measured and its
/// residual, NaN where there is no sample. `None` of an output that stands still.
pub(super) fn share_left<'s>(flights: impl Iterator<Item = (&'s [f64], &'s [f64])>) -> Option<f64> {
    let (mut left, mut all) = (0.0, 0.0);
    for (measured, residual) in flights {
        let there = || measured.iter().filter(|z| z.is_finite());
        let mean = there().sum::<f64>() / there().count().max(1) as f64;
        all += there().map(|z| (z - mean).powi(2)).sum::<f64>();
        let residual = residual.iter().filter(|e| e.is_finite());
        left += residual.map(|e| e * e).sum::<f64>();
    }
    (all > 0.0).then(|| left / all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bias_is_left_and_a_mean_is_none() {
        let measured = [5.0, 7.0, f64::NAN, 6.0];
        let share = |residual: &[f64]| share_left([(&measured[..], residual)].into_iter());
        assert_eq!(share(&[0.0, 0.0, f64::NAN, 0.0]), Some(0.0));
        assert_eq!(share(&[-1.0, 1.0, f64::NAN, 0.0]), Some(1.0));
        assert_eq!(share(&[0.5, 0.5, f64::NAN, 0.0]), Some(0.25));
        let still = [2.0; 4];
        assert_eq!(share_left([(&still[..], &still[..])].into_iter()), None);
    }
}
