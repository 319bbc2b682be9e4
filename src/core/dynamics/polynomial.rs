//! Real polynomials from their roots.

use num_complex::Complex64;

/// The coefficients of Π (s − root), highest power first; roots that are not real stand with their conjugates.
pub(super) fn from_roots(roots: &[Complex64]) -> Vec<f64> {
    let mut coefficients = vec![Complex64::ONE];
    for root in roots {
        let mut next = coefficients.clone();
        next.push(Complex64::ZERO);
        for (to, from) in next[1..].iter_mut().zip(&coefficients) {
            *to -= root * from;
        }
        coefficients = next;
    }
    coefficients.iter().map(|z| z.re).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_and_a_real_root_multiply_out() {
        let pair = Complex64::new(-1.0, 2.0);
        let found = from_roots(&[pair, pair.conj(), Complex64::new(3.0, 0.0)]);
        // (s² + 2 s + 5)(s − 3)
        assert_eq!(found, [1.0, -1.0, -1.0, -15.0]);
        assert_eq!(from_roots(&[]), [1.0]);
    }
}
