//! ∂x/∂θ of any model, a step at a time: S(k+1) = S(k) + P(k) S(k) + Q(k).

use multiversion::multiversion;

use super::aligned::Aligned;
use super::columns::Columns;
use super::linearised::Linearised;
use super::method::Stage;
use super::pack::{PACK, Pack, multiply_add, packs};
use super::segment::Segment;
use super::transition::Transition;
use crate::model::{BLOCK, Model};

/// Packs of a row that go along together: as many as stay in registers whatever the model.
const MOST_PACKS: usize = 4;

/// An entry of P times a row of ∂x/∂θ.
#[derive(Clone, Copy)]
struct Product {
    slot: usize,
    /// The first pack of the row, among those of a sample.
    row: usize,
}

/// The row of one state.
struct Row {
    /// Its first pack, among those of a sample.
    at: usize,
    /// How many products.
    products: usize,
}

pub(super) struct TransitionRecursion {
    transition: Transition,
    /// Packs of a row.
    width: usize,
    /// By state.
    rows: Vec<Row>,
    /// One row's after the other's.
    products: Vec<Product>,
    /// By state, then pack: its number among the packs of Q; 0 is one that is always zero.
    forced: Vec<usize>,
    /// Slots of Q, and their numbers within the packs of a sample.
    forcing: Vec<(usize, usize)>,
    /// By sample of the block: the zero pack, and those of Q with an entry.
    forcing_packs: Aligned<Pack>,
    packs: usize,
}

impl TransitionRecursion {
    pub(super) fn new(model: &Model, columns: &Columns, stages: usize) -> Self {
        let transition = Transition::new(model, columns, stages);
        let states = model.states.len();
        let width = packs(columns.dynamic.len());
        let mut forced = vec![0; width * states];
        let mut forcing = Vec::new();
        let mut count = 1;
        for (slot, &(row, column)) in transition.places().iter().enumerate() {
            let Some(column) = column.checked_sub(states) else {
                continue;
            };
            let pack = &mut forced[row * width + column / PACK];
            if *pack == 0 {
                *pack = count;
                count += 1;
            }
            forcing.push((slot, *pack * PACK + column % PACK));
        }
        let mut products = Vec::new();
        let row = |row: usize| {
            let so_far = products.len();
            let slots = transition.places().iter().enumerate();
            let slots = slots.filter(|&(_, &(of, column))| of == row && column < states);
            products.extend(slots.map(|(slot, &(_, column))| Product {
                slot,
                row: column * width,
            }));
            Row {
                at: row * width,
                products: products.len() - so_far,
            }
        };
        Self {
            rows: (0..states).map(row).collect(),
            products,
            transition,
            width,
            forced,
            forcing,
            forcing_packs: Aligned::zeros(BLOCK * count),
            packs: count,
        }
    }

    /// Products of a sample that are done side by side, and those of packs that are done in turn.
    pub(super) fn products(&self) -> (usize, usize) {
        let in_turn = self.products.len() * self.width;
        (self.transition.products(), in_turn)
    }

    /// From `rows` at the first sample of a block to all of `steps` samples behind it.
    pub(super) fn sweep(
        &mut self,
        stages: &[Stage],
        segment: &Segment,
        (first, steps): (usize, usize),
        dynamics: &Linearised<'_>,
        rows: &mut [Pack],
    ) {
        let mut lengths = [0.0; BLOCK];
        for (k, length) in lengths[..steps].iter_mut().enumerate() {
            *length = segment.steps.length(first + k);
        }
        self.transition.compose(stages, &lengths, steps, dynamics);
        let numbers = self.packs * PACK;
        for &(slot, number) in &self.forcing {
            let values = &self.transition.over_block(slot)[..steps];
            let packs = self.forcing_packs.as_flattened_mut();
            for (to, &value) in packs.chunks_exact_mut(numbers).zip(values) {
                to[number] = value;
            }
        }
        sweep(self, steps, rows);
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn sweep(recursion: &TransitionRecursion, steps: usize, rows: &mut [Pack]) {
    let slots = recursion.products.iter().map(|product| product.slot);
    let factors: Vec<&[f64; BLOCK]> = slots
        .map(|slot| recursion.transition.over_block(slot))
        .collect();
    // parameters do not know of one another
    for first in (0..recursion.width).step_by(MOST_PACKS) {
        match recursion.width - first {
            1 => sweep_packs::<1>(recursion, &factors, first, steps, rows),
            2 => sweep_packs::<2>(recursion, &factors, first, steps, rows),
            3 => sweep_packs::<3>(recursion, &factors, first, steps, rows),
            _ => sweep_packs::<MOST_PACKS>(recursion, &factors, first, steps, rows),
        }
    }
}

/// `COUNT` packs of each row, from the pack `first` on.
#[inline(always)]
fn sweep_packs<const COUNT: usize>(
    recursion: &TransitionRecursion,
    factors: &[&[f64; BLOCK]],
    first: usize,
    steps: usize,
    rows: &mut [Pack],
) {
    let sample = recursion.rows.len() * recursion.width;
    for k in 0..steps.min(BLOCK) {
        let (from, to) = rows[k * sample..(k + 2) * sample].split_at_mut(sample);
        let forcing = &recursion.forcing_packs[k * recursion.packs..(k + 1) * recursion.packs];
        let mut products = recursion.products.iter().zip(factors);
        for row in &recursion.rows {
            let at = row.at + first;
            let mut sums = *some_packs::<COUNT>(from, at);
            let forced = &recursion.forced[at..at + COUNT];
            for i in 0..COUNT {
                sums[i] = multiply_add(1.0, sums[i], forcing[forced[i]]);
            }
            for (product, factor) in products.by_ref().take(row.products) {
                let other = some_packs::<COUNT>(from, product.row + first);
                for i in 0..COUNT {
                    sums[i] = multiply_add(factor[k], other[i], sums[i]);
                }
            }
            let (to, _) = to[at..].as_chunks_mut::<COUNT>();
            to[0] = sums;
        }
    }
}

#[inline(always)]
fn some_packs<const COUNT: usize>(packs: &[Pack], at: usize) -> &[Pack; COUNT] {
    let (chunks, _) = packs[at..].as_chunks::<COUNT>();
    &chunks[0]
}
