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

/// ∫_0^b s^p exp(-iωs) ds for p = 0..P, whatever the sign and the length of b.
pub fn power_integrals<const P: usize>(omega: f64, until: f64) -> [Complex64; P] {
    let angle = omega * until;
    let mut integrals = moments(angle);
    if angle.abs() > 1.0 {
        // by parts: no difference of large numbers at large angles
        let (end, over) = (
            Complex64::from_polar(1.0, -angle),
            Complex64::new(0.0, angle),
        );
        let mut before = Complex64::ONE;
        for (p, integral) in integrals.iter_mut().enumerate() {
            *integral = match p {
                0 => (1.0 - end) / over,
                _ => (before * p as f64 - end) / over,
            };
            before = *integral;
        }
    }
    for (p, integral) in integrals.iter_mut().enumerate() {
        *integral *= until.powi(p as i32 + 1);
    }
    integrals
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By Simpson's rule over many intervals.
    #[test]
    fn integrals_of_powers_are_those_of_a_quadrature() {
        for (omega, until) in [
            (0.3, 0.2),
            (7.0, 0.25),
            (7.0, -0.25),
            (12.0, 3.0),
            (1e-3, 0.0),
        ] {
            let found: [Complex64; 3] = power_integrals(omega, until);
            let intervals = 20_000;
            let h = until / f64::from(intervals);
            for (p, found) in found.iter().enumerate() {
                let at = |k: i32| {
                    let s = f64::from(k) * h;
                    Complex64::from_polar(1.0, -omega * s) * s.powi(p as i32)
                };
                let weight = |k: i32| match k {
                    0 => 1.0,
                    k if k == intervals => 1.0,
                    k if k % 2 == 1 => 4.0,
                    _ => 2.0,
                };
                let sum: Complex64 = (0..=intervals).map(|k| at(k) * weight(k)).sum();
                let exact = sum * (h / 3.0);
                assert!((found - exact).norm() < 1e-10, "{omega}, {until}, {p}");
            }
        }
    }

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
