//! Fourier integrals of polynomials over one interval.

use num_complex::Complex64;

/// Terms of the series, enough for angles up to 2π.
const TERMS: usize = 48;

/// M_p = ∫_0^1 s^p exp(-iθs) ds for p = 0..P, by the series Σ_k (-iθ)^k / (k! (k + p + 1)): no difference of large numbers
/// at small angles.
pub(super) fn moments<const P: usize>(angle: f64) -> [Complex64; P] {
    let mut sums = [Complex64::ZERO; P];
    let mut term = Complex64::ONE;
    for k in 0..TERMS {
        for (p, sum) in sums.iter_mut().enumerate() {
            *sum += term / (k + p + 1) as f64;
        }
        term = Complex64::new(term.im * angle, -term.re * angle) / (k + 1) as f64;
        if term.norm_sqr() < 1e-40 {
            break;
        }
    }
    sums
}

/// ∫_a^b x(t) exp(-iωt) dt of a straight line from x(a) to x(b), with |ω (b - a)| at most 2π.
pub fn line_integral([a, b]: [f64; 2], [at_a, at_b]: [f64; 2], omega: f64) -> Complex64 {
    let [level, slope] = moments(omega * (b - a));
    let start = Complex64::from_polar(b - a, -omega * a);
    start * (level * at_a + slope * (at_b - at_a))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integration by parts: M_0 = (1 - e)/(iθ), M_p = (p M_(p-1) - e)/(iθ) with e = exp(-iθ).
    #[test]
    fn moments_follow_from_one_another() {
        for angle in [0.3, 1.0, 3.1, 6.2] {
            let all: [Complex64; 4] = moments(angle);
            let end = Complex64::from_polar(1.0, -angle);
            let over = Complex64::new(0.0, angle);
            assert!((all[0] - (1.0 - end) / over).norm() < 1e-14, "{angle}");
            for p in 1..4 {
                let by_parts = (all[p - 1] * p as f64 - end) / over;
                assert!((all[p] - by_parts).norm() < 1e-13, "{angle}, {p}");
            }
        }
    }
}
