//! The fast Fourier transform of lengths that are powers of two (Cooley and Tukey 1965).

use std::f64::consts::TAU;

use num_complex::Complex64;

/// Σ_n x_n exp(-2πi k n / N) for k = 0..N, N a power of two.
#[derive(Clone, Debug)]
pub struct FastTransform {
    /// exp(-2πi k / N) for k < N/2.
    roots: Vec<Complex64>,
    length: usize,
}

impl FastTransform {
    /// Of at least `length` values: of the next power of two.
    pub fn at_least(length: usize) -> Self {
        let length = length.next_power_of_two();
        let root = |k: usize| Complex64::from_polar(1.0, -TAU * k as f64 / length as f64);
        Self {
            roots: (0..length / 2).map(root).collect(),
            length,
        }
    }

    /// N.
    pub fn len(&self) -> usize {
        self.length
    }

    /// Never: a transform has one value at least.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// In place; `values` are N.
    pub fn forward(&self, values: &mut [Complex64]) {
        self.reorder(values);
        let mut half = 1;
        while half < self.length {
            let stride = self.length / (2 * half);
            for block in values.chunks_exact_mut(2 * half) {
                let (low, high) = block.split_at_mut(half);
                let roots = self.roots.iter().step_by(stride);
                for ((low, high), root) in low.iter_mut().zip(high).zip(roots) {
                    let turned = *high * root;
                    *high = *low - turned;
                    *low += turned;
                }
            }
            half *= 2;
        }
    }

    /// The inverse of [`Self::forward`], in place.
    pub fn inverse(&self, values: &mut [Complex64]) {
        values.iter_mut().for_each(|value| *value = value.conj());
        self.forward(values);
        let share = 1.0 / self.length as f64;
        (values.iter_mut()).for_each(|value| *value = value.conj() * share);
    }

    /// Each value goes to the place whose bits are those of its own in reverse.
    fn reorder(&self, values: &mut [Complex64]) {
        if self.length < 2 {
            return;
        }
        let shift = usize::BITS - self.length.trailing_zeros();
        for place in 0..self.length {
            let other = place.reverse_bits() >> shift;
            if place < other {
                values.swap(place, other);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_of_the_definition_and_come_back() {
        for length in [1, 2, 8, 64] {
            let transform = FastTransform::at_least(length);
            let number = |n: usize| Complex64::new((n as f64 * 1.7).sin(), (n as f64 * 0.3).cos());
            let signal: Vec<Complex64> = (0..length).map(number).collect();
            let mut values = signal.clone();
            transform.forward(&mut values);
            for (k, value) in values.iter().enumerate() {
                let turn = |n: usize| {
                    Complex64::from_polar(1.0, -TAU * (k * n % length) as f64 / length as f64)
                };
                let sum: Complex64 = (0..length).map(|n| signal[n] * turn(n)).sum();
                assert!((value - sum).norm() < 1e-12, "{length}, {k}");
            }
            transform.inverse(&mut values);
            for (back, value) in values.iter().zip(&signal) {
                assert!((back - value).norm() < 1e-14);
            }
        }
    }
}
