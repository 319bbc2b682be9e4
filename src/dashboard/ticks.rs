//! Round numbers along an axis.

use crate::estimate::five_digits;

/// Three to eight round numbers between two.
pub(super) fn steps(low: f64, high: f64) -> Vec<f64> {
    let rough = (high - low) / 3.0;
    let power = 10f64.powf(rough.log10().floor());
    let of = [5.0, 2.0, 1.0].map(|digit| digit * power);
    let step = of.into_iter().find(|step| *step <= rough).unwrap_or(power);
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    (first..=last).take(12).map(|k| k as f64 * step).collect()
}

/// What binary fractions leave behind is rounded off.
pub(super) fn tidy(value: f64) -> String {
    let size = value.abs();
    let text = if value == 0.0 || (1e-3..1e5).contains(&size) {
        ((value * 1e9).round() / 1e9).to_string()
    } else {
        five_digits(value)
    };
    text.replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_a_few_round_numbers() {
        assert_eq!(steps(-0.9, 1.1), [-0.5, 0.0, 0.5, 1.0]);
        assert_eq!(steps(3.0, 11.0), [4.0, 6.0, 8.0, 10.0]);
        assert!(steps(0.0, f64::MIN_POSITIVE).len() <= 12);
        let round: Vec<String> = steps(-0.36, 0.48).into_iter().map(tidy).collect();
        assert_eq!(round, ["\u{2212}0.2", "0", "0.2", "0.4"]);
    }

    #[test]
    fn no_axis_has_fewer_than_three_or_more_than_eight() {
        for k in 0..4000 {
            let low = -1.0 + 0.37 * f64::from(k % 61);
            let width = 1.0047_f64.powi(k - 2000);
            let count = steps(low * width, (low + 1.0) * width).len();
            assert!((3..=8).contains(&count), "{low} {width}: {count}");
        }
    }
}
