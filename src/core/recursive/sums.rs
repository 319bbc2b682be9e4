//! Sums of products of one equation, from which its least squares follow, with weights that fade.

use num_complex::Complex64;

/// Of a = (φ, y): Σ w a aᵀ, and Σ w² a_k a_(k-l)ᵀ by lag l. Weights are of the newest sample 1, and λ times that from each to the
/// one before it.
pub(super) struct Sums {
    /// Of φ, its place among all columns.
    pub columns: Vec<usize>,
    /// Σ w a aᵀ, row by row.
    pub products: Vec<f64>,
    /// Σ w.
    pub weight: f64,
    /// Σ w².
    pub squares: f64,
    /// By lag: Σ w_k w_(k-l) a_k a_(k-l)ᵀ. Empty where residuals are taken for white.
    pub lagged: Vec<Vec<f64>>,
    /// The last a, the newest first.
    recent: Vec<Vec<f64>>,
    filled: usize,
    forgetting: f64,
}

impl Sums {
    /// `lags` is how many samples apart residuals may be correlated; 0: not at all.
    pub(super) fn new(columns: Vec<usize>, lags: usize, forgetting: f64) -> Self {
        let width = columns.len() + 1;
        let matrices = if lags > 0 { lags + 1 } else { 0 };
        Self {
            columns,
            products: vec![0.0; width * width],
            weight: 0.0,
            squares: 0.0,
            lagged: vec![vec![0.0; width * width]; matrices],
            recent: vec![vec![0.0; width]; matrices],
            filled: 0,
            forgetting,
        }
    }

    /// Length of a.
    pub(super) fn width(&self) -> usize {
        self.columns.len() + 1
    }

    /// Takes in a = (φ, y) of one more sample.
    pub(super) fn add(&mut self, a: &[f64]) {
        let own = self.forgetting;
        fade_and_add(&mut self.products, own, 1.0, a, a);
        self.weight = own * self.weight + 1.0;
        self.squares = own * own * self.squares + 1.0;
        if self.recent.is_empty() {
            return;
        }
        self.recent.rotate_right(1);
        self.recent[0].copy_from_slice(a);
        self.filled = (self.filled + 1).min(self.recent.len());
        let mut weight = 1.0;
        for (lag, sums) in self.lagged.iter_mut().enumerate() {
            let weight_of_this = if lag < self.filled { weight } else { 0.0 };
            fade_and_add(sums, own * own, weight_of_this, a, &self.recent[lag]);
            weight *= own;
        }
    }

    /// Begins anew, for sums over frequencies.
    pub(super) fn clear(&mut self) {
        self.products.fill(0.0);
        self.weight = 0.0;
        self.squares = 0.0;
    }

    /// Takes in a of one frequency, whose real and imaginary parts are two samples of a weight.
    pub(super) fn add_complex(&mut self, a: &[Complex64], weight: f64) {
        let width = self.width();
        for (row, left) in self.products.chunks_exact_mut(width).zip(a) {
            for (to, right) in row.iter_mut().zip(a) {
                *to += weight * (left.re * right.re + left.im * right.im);
            }
        }
        self.weight += 2.0 * weight;
        self.squares += 2.0 * weight;
    }

    /// How many samples of equal weight tell as much.
    pub(super) fn numbers(&self) -> f64 {
        match self.squares > 0.0 {
            true if self.lagged.is_empty() => self.weight,
            true => self.weight * self.weight / self.squares,
            false => 0.0,
        }
    }
}

/// to = λ to + weight a bᵀ
fn fade_and_add(to: &mut [f64], fade: f64, weight: f64, a: &[f64], b: &[f64]) {
    for (row, left) in to.chunks_exact_mut(b.len()).zip(a) {
        let left = weight * left;
        for (to, right) in row.iter_mut().zip(b) {
            *to = fade * *to + left * right;
        }
    }
}

/// aᵀ S a with a = (-θ, 1): the sum of squared residuals, of which rounding can leave no less than nothing.
pub(super) fn of_residuals(products: &[f64], columns: &[usize], theta: &[f64]) -> f64 {
    let width = columns.len() + 1;
    let at = |i: usize| columns.get(i).map_or(1.0, |&column| -theta[column]);
    let mut sum = 0.0;
    for (i, row) in products.chunks_exact(width).enumerate() {
        let along: f64 = row.iter().enumerate().map(|(j, value)| value * at(j)).sum();
        sum += at(i) * along;
    }
    sum
}
