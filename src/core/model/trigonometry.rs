//! Sine and cosine without branches, so that samples side by side take no longer than one, and the same to the
//! last bit whatever machine and system library there is.
//!
//! The polynomials are those of fdlibm (Sun Microsystems, 1993) for |r| ≤ π/4; the reduction r = x - n π/2 takes
//! π/2 in three parts and uses that a multiply-add rounds once: the first difference is exact. The error is below
//! one unit in the last place.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

/// What π/2 is more than its nearest number, and what it is more than both.
const FRAC_PI_2_REST: f64 = 6.123_233_995_736_766e-17;
const FRAC_PI_2_LAST: f64 = -1.497_384_904_859_183_3e-33;

/// Larger angles are left to the system library: n must be small beside 2^53.
pub(super) const LARGEST_ANGLE: f64 = 1e6;

const SINE: [f64; 6] = [
    1.589_690_995_211_55e-10,
    -2.505_076_025_340_686_3e-8,
    2.755_731_370_707_006_8e-6,
    -1.984_126_982_985_795e-4,
    8.333_333_333_322_49e-3,
    -1.666_666_666_666_663_2e-1,
];
const COSINE: [f64; 6] = [
    -1.135_964_755_778_819_5e-11,
    2.087_572_321_298_175e-9,
    -2.755_731_435_139_066_3e-7,
    2.480_158_728_947_673e-5,
    -1.388_888_888_887_411e-3,
    4.166_666_666_666_66e-2,
];

/// sin x for |x| up to [`LARGEST_ANGLE`].
#[inline(always)]
pub(super) fn sin(x: f64) -> f64 {
    let (n, r) = reduced(x);
    of_quarter(n, r)
}

/// cos x for |x| up to [`LARGEST_ANGLE`].
#[inline(always)]
pub(super) fn cos(x: f64) -> f64 {
    let (n, r) = reduced(x);
    of_quarter(n + 1.0, r)
}

/// sin x and cos x, likewise.
#[inline(always)]
pub(super) fn sin_cos(x: f64) -> (f64, f64) {
    let (n, r) = reduced(x);
    (of_quarter(n, r), of_quarter(n + 1.0, r))
}

/// n and r of x = n π/2 + r.
#[inline(always)]
fn reduced(x: f64) -> (f64, f64) {
    let n = (x * FRAC_2_PI).round_ties_even();
    let r = (-n).mul_add(FRAC_PI_2, x);
    let r = (-n).mul_add(FRAC_PI_2_REST, r);
    (n, (-n).mul_add(FRAC_PI_2_LAST, r))
}

/// sin(n π/2 + r)
#[inline(always)]
fn of_quarter(n: f64, r: f64) -> f64 {
    let square = r * r;
    let series = |coefficients: [f64; 6]| {
        let [first, rest @ ..] = coefficients;
        let mut sum = first;
        for coefficient in rest {
            sum = sum.mul_add(square, coefficient);
        }
        sum
    };
    let sine = (r * square).mul_add(series(SINE), r);
    let half = 0.5 * square;
    let near = 1.0 - half;
    let cosine = near + (square * square).mul_add(series(COSINE), (1.0 - near) - half);
    // which quarter of the circle: 0, 1, 2 or 3
    let quarter = (-4.0_f64).mul_add((0.25 * n).floor(), n);
    let odd = quarter == 1.0 || quarter == 3.0;
    let value = if odd { cosine } else { sine };
    if quarter >= 2.0 { -value } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The system library's own error is below one unit in the last place, and so is ours.
    #[test]
    fn agree_with_the_system_library_to_two_units_in_the_last_place() {
        let mut angles: Vec<f64> = (-40_000..40_000)
            .map(|i| f64::from(i) * 1.234_567e-3)
            .collect();
        angles.extend((-300..300).map(|i| f64::from(i) * FRAC_PI_2));
        angles.extend((0..600).map(|i| 1e-12 * 1.1_f64.powi(i).min(1e17)));
        angles.extend([1e6, -1e6, 999_999.5, 0.0, -0.0, 1e-300]);
        for x in angles {
            for (own, system) in [(sin(x), x.sin()), (cos(x), x.cos())] {
                // EPSILON |value| is one to two units in the last place
                let units = f64::EPSILON * system.abs().max(f64::MIN_POSITIVE);
                assert!((own - system).abs() <= units, "{x:e}: {own:e} {system:e}");
            }
        }
        assert!(sin(0.0) == 0.0 && cos(0.0) == 1.0);
    }
}
