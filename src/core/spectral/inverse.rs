//! The inverse of a small complex matrix.

use num_complex::Complex64;

/// Puts the inverse of a square matrix, row by row, in its place: Gauss-Jordan elimination with pivots of rows.
///
/// `None` where it is singular. At most 64 by 64.
pub fn invert(matrix: &mut [Complex64], size: usize) -> Option<()> {
    let mut exchanged = [0_usize; 64];
    let exchanged = &mut exchanged[..size];
    for column in 0..size {
        let length = |row: &usize| matrix[row * size + column].norm_sqr();
        let pivot = (column..size).max_by(|a, b| length(a).total_cmp(&length(b)))?;
        exchanged[column] = pivot;
        for j in 0..size {
            matrix.swap(column * size + j, pivot * size + j);
        }
        let divisor = matrix[column * size + column];
        if divisor == Complex64::ZERO || !divisor.is_finite() {
            return None;
        }
        matrix[column * size + column] = Complex64::ONE;
        for j in 0..size {
            matrix[column * size + j] /= divisor;
        }
        for row in (0..size).filter(|&row| row != column) {
            let factor = matrix[row * size + column];
            matrix[row * size + column] = Complex64::ZERO;
            for j in 0..size {
                let taken = factor * matrix[column * size + j];
                matrix[row * size + j] -= taken;
            }
        }
    }
    for column in (0..size).rev() {
        for row in 0..size {
            matrix.swap(row * size + column, row * size + exchanged[column]);
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_times_its_inverse_is_one() {
        for size in [1, 2, 5, 9] {
            let entry = |k: usize| {
                let square = (k * k) as f64;
                Complex64::new((square * 0.37).sin(), (square * 1.13).cos())
            };
            let mut matrix: Vec<Complex64> = (0..size * size).map(entry).collect();
            matrix[0] = Complex64::ZERO;
            if size == 1 {
                assert!(invert(&mut matrix, size).is_none());
                continue;
            }
            let original = matrix.clone();
            invert(&mut matrix, size).expect("it is regular");
            for i in 0..size {
                for j in 0..size {
                    let product: Complex64 = (0..size)
                        .map(|k| original[i * size + k] * matrix[k * size + j])
                        .sum();
                    let one = f64::from(u8::from(i == j));
                    assert!((product - one).norm() < 1e-12, "{size}: {i}, {j}");
                }
            }
        }
    }
}
