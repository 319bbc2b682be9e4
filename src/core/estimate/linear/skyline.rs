//! Symmetric matrices whose rows begin late, and their Cholesky factors, which begin where they do: only what stands
//! between the first number of a row and the diagonal is kept (Jennings 1966; George and Liu 1981, ch. 4).

use super::products::dot;

/// The lower triangle, row by row.
#[derive(Clone, Debug)]
pub(crate) struct Skyline {
    rows: Vec<Row>,
    values: Vec<f64>,
}

#[derive(Clone, Copy, Debug)]
struct Row {
    /// Its first column that is not zero.
    first: usize,
    /// Where that stands among the values.
    at: usize,
}

impl Skyline {
    /// From the entries on and below the diagonal.
    pub(crate) fn new(len: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let mut rows = Vec::with_capacity(len);
        let mut values = Vec::new();
        for i in 0..len {
            let first = (0..i).find(|&j| entry(i, j) != 0.0).unwrap_or(i);
            let at = values.len();
            rows.push(Row { first, at });
            values.extend((first..=i).map(|j| entry(i, j)));
        }
        Self { rows, values }
    }

    /// Adds to the first `count` numbers of the diagonal.
    pub(crate) fn add_to_diagonal(&mut self, count: usize, value: f64) {
        for (i, row) in self.rows.iter().enumerate().take(count) {
            self.values[row.at + i - row.first] += value;
        }
    }

    /// Its Cholesky factor; `None` where it is not positive definite.
    pub(crate) fn factor(mut self) -> Option<Factor> {
        let mut reciprocals = Vec::with_capacity(self.rows.len());
        for (i, row) in self.rows.iter().enumerate() {
            let (before, own) = self.values.split_at_mut(row.at);
            let own = &mut own[..=i - row.first];
            for j in row.first..i {
                let other = self.rows[j];
                let first = row.first.max(other.first);
                let left = &own[first - row.first..j - row.first];
                let right = &before[other.at + first - other.first..][..left.len()];
                own[j - row.first] = (own[j - row.first] - product(left, right)) * reciprocals[j];
            }
            let left = &own[..i - row.first];
            let square = own[i - row.first] - product(left, left);
            // no number is not either
            if !(square > 0.0 && square.is_finite()) {
                return None;
            }
            reciprocals.push(square.sqrt().recip());
        }
        Some(Factor {
            lower: self,
            reciprocals,
        })
    }
}

/// L of A = L Lᵀ.
#[derive(Clone, Debug)]
pub(crate) struct Factor {
    /// But for the diagonal, which is not kept up to date.
    lower: Skyline,
    /// Of the diagonal.
    reciprocals: Vec<f64>,
}

impl Factor {
    pub(crate) fn len(&self) -> usize {
        self.reciprocals.len()
    }

    /// b → A⁻¹ b
    pub(crate) fn solve(&self, b: &mut [f64]) {
        for i in 0..b.len() {
            let (first, row) = self.row(i);
            b[i] = (b[i] - product(row, &b[first..i])) * self.reciprocals[i];
        }
        for i in (0..b.len()).rev() {
            b[i] *= self.reciprocals[i];
            let (first, row) = self.row(i);
            let (before, rest) = b.split_at_mut(i);
            for (to, value) in before[first..].iter_mut().zip(row) {
                *to -= rest[0] * value;
            }
        }
    }

    /// The sum of the first `count` numbers of the diagonal of A⁻¹ = L⁻ᵀL⁻¹: squares of columns of L⁻¹.
    pub(crate) fn trace_of_inverse(&self, count: usize) -> f64 {
        let len = self.reciprocals.len();
        let mut column = vec![0.0; len];
        let of_column = |j: usize| {
            column[j] = self.reciprocals[j];
            let mut last = j;
            for i in j + 1..len {
                let (first, row) = self.row(i);
                let from = first.max(j);
                column[i] = 0.0;
                if from <= last {
                    let row = &row[from - first..=last - first];
                    column[i] = -product(row, &column[from..=last]) * self.reciprocals[i];
                    last = i;
                }
            }
            product(&column[j..=last], &column[j..=last])
        };
        (0..count).map(of_column).sum()
    }

    /// The first column of a row, and what stands before the diagonal.
    fn row(&self, i: usize) -> (usize, &[f64]) {
        let Row { first, at } = self.lower.rows[i];
        (first, &self.lower.values[at..at + i - first])
    }
}

/// Most rows are short: a loop of a few takes less than the choice of a better one.
#[inline(always)]
fn product(a: &[f64], b: &[f64]) -> f64 {
    const SHORT: usize = 32;
    if a.len() > SHORT {
        return dot(a, b);
    }
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
