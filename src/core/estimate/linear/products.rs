//! Sums of products over the samples of a block, the innermost loops of an estimation.
//!
//! A tile of the result stays in registers while all samples go by, so that each product costs one
//! multiply-add. Numbers do not depend on the machine: every sum runs over the samples in their order.

use multiversion::multiversion;
use pulp::{Arch, Simd, WithSimd};

use crate::simulate::{PACK, Pack, multiply_add, packs};

/// to += Σ_k row_k row_kᵀ for rows of `width` numbers, packs up to the diagonal.
pub(crate) fn add_products(to: &mut [Pack], rows: &[Pack], width: usize) {
    let stride = packs(width);
    for lead in 0..stride {
        add_panel(to, (rows, stride), (rows, stride), (lead, width), lead + 1);
    }
}

/// to += Σ_k left_k right_kᵀ for rows of `width` and of `across` numbers.
pub(crate) fn add_cross_products(
    to: &mut [Pack],
    left: &[Pack],
    width: usize,
    right: &[Pack],
    across: usize,
) {
    let (stride, columns) = (packs(width), packs(across));
    for lead in 0..stride {
        add_panel(to, (left, stride), (right, columns), (lead, width), columns);
    }
}

/// to += Σ_k factor_k row_k, for rows of as many packs as `to` has.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
pub(crate) fn add_combination(to: &mut [Pack], rows: &[Pack], factors: &[f64]) {
    let stride = to.len();
    for (pack, to) in to.iter_mut().enumerate() {
        let mut sum = *to;
        for (row, &factor) in rows.chunks_exact(stride).zip(factors) {
            sum = multiply_add(factor, row[pack], sum);
        }
        *to = sum;
    }
}

/// Σ_k a_k b_k
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = Pack::default();
    let (a, a_rest) = a.as_chunks::<PACK>();
    let (b, b_rest) = b.as_chunks::<PACK>();
    for (a, b) in a.iter().zip(b) {
        for i in 0..PACK {
            sums[i] = a[i].mul_add(b[i], sums[i]);
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

/// Rows of packs, and how many packs one has.
type Rows<'a> = (&'a [Pack], usize);

/// The columns of pack `lead` of the left rows, of `width` in all, against the first `across` packs of the
/// right ones.
fn add_panel(
    to: &mut [Pack],
    left: Rows<'_>,
    right: Rows<'_>,
    (lead, width): (usize, usize),
    across: usize,
) {
    let last = (width - lead * PACK).min(PACK);
    let to = &mut to[lead * PACK * right.1..][..last * right.1];
    Arch::new().dispatch(Panel {
        to: to.as_flattened_mut(),
        left,
        right,
        lead,
        across,
    });
}

struct Panel<'a> {
    to: &'a mut [f64],
    left: Rows<'a>,
    right: Rows<'a>,
    lead: usize,
    across: usize,
}

impl WithSimd for Panel<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let vectors = PACK / S::F64_LANES;
        let (right, _) = S::as_simd_f64s(self.right.0.as_flattened());
        let stride = self.right.1 * vectors;
        let (to, _) = S::as_mut_simd_f64s(self.to);
        let tile = Tile {
            left: self.left,
            lead: self.lead,
            right,
            stride,
        };
        // sums, a vector of each factor and one of a broadcast fit into the registers
        let many = S::REGISTER_COUNT >= 32;
        let (most_columns, most_vectors) = if many { (PACK, 3) } else { (4, 2) };
        for (number, to) in to.chunks_mut(most_columns * stride).enumerate() {
            let first = number * most_columns;
            let columns = to.len() / stride;
            let mut from = 0;
            while from < self.across * vectors {
                let wide = (self.across * vectors - from).min(most_vectors);
                match (columns, wide) {
                    (1, 1) => tile.add::<S, 1, 1>(simd, to, first, from),
                    (1, 2) => tile.add::<S, 1, 2>(simd, to, first, from),
                    (1, _) => tile.add::<S, 1, 3>(simd, to, first, from),
                    (2, 1) => tile.add::<S, 2, 1>(simd, to, first, from),
                    (2, 2) => tile.add::<S, 2, 2>(simd, to, first, from),
                    (2, _) => tile.add::<S, 2, 3>(simd, to, first, from),
                    (3 | 4, 1) => tile.add::<S, 4, 1>(simd, to, first, from),
                    (3 | 4, 2) => tile.add::<S, 4, 2>(simd, to, first, from),
                    (3 | 4, _) => tile.add::<S, 4, 3>(simd, to, first, from),
                    (_, 1) => tile.add::<S, PACK, 1>(simd, to, first, from),
                    (_, 2) => tile.add::<S, PACK, 2>(simd, to, first, from),
                    (_, _) => tile.add::<S, PACK, 3>(simd, to, first, from),
                }
                from += wide;
            }
        }
    }
}

/// The operands that the tiles of a panel share.
struct Tile<'a, V> {
    left: Rows<'a>,
    lead: usize,
    right: &'a [V],
    /// Vectors of a row of `right`, and of the result.
    stride: usize,
}

impl<V: Copy> Tile<'_, V> {
    /// `COLUMNS` columns of pack `lead` from `first` on, by `VECTORS` vectors of the right rows from `from` on.
    #[inline(always)]
    fn add<S: Simd<f64s = V>, const COLUMNS: usize, const VECTORS: usize>(
        &self,
        simd: S,
        to: &mut [V],
        first: usize,
        from: usize,
    ) {
        let mut sums = [[simd.splat_f64s(0.0); VECTORS]; COLUMNS];
        let left = self.left.0.chunks_exact(self.left.1);
        for (left, right) in left.zip(self.right.chunks_exact(self.stride)) {
            let factors = &left[self.lead][first..first + COLUMNS];
            let right = &right[from..from + VECTORS];
            for column in 0..COLUMNS {
                let factor = simd.splat_f64s(factors[column]);
                for vector in 0..VECTORS {
                    let sum = &mut sums[column][vector];
                    *sum = simd.mul_add_f64s(factor, right[vector], *sum);
                }
            }
        }
        // the last tile may be larger than there are columns
        for (to, sums) in to.chunks_exact_mut(self.stride).zip(sums) {
            for (to, sum) in to[from..from + VECTORS].iter_mut().zip(sums) {
                *to = simd.add_f64s(*to, sum);
            }
        }
    }
}
