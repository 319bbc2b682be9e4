//! ∂x/∂θ of any model, a step at a time: S(k+1) = S(k) + P(k) S(k) + Q(k).

use multiversion::multiversion;

use super::columns::Columns;
use super::linearised::{BLOCK, Linearised};
use super::method::Stage;
use super::pack::{PACK, Pack, multiply_add, packs};
use super::segment::Segment;
use super::transition::{Transition, meets, moved};
use crate::model::Model;

/// An entry of P times a row of ∂x/∂θ.
#[derive(Clone, Copy)]
struct Product {
    slot: usize,
    state: usize,
}

/// One pack of one state's row.
struct Row {
    /// Its number among the packs of a sample.
    at: usize,
    products: Vec<Product>,
    /// Its number among the packs of Q; 0 is one that is always zero.
    forced: usize,
}

pub(super) struct TransitionRecursion {
    transition: Transition,
    /// Packs of a sample.
    sample: usize,
    rows: Vec<Row>,
    /// Slots of Q, and their numbers within the packs of a sample.
    forcing: Vec<(usize, usize)>,
    /// By sample of the block: the zero pack, and those of Q with an entry.
    forcing_packs: Vec<Pack>,
    packs: usize,
}

impl TransitionRecursion {
    pub fn new(model: &Model, columns: &Columns, stages: usize) -> Self {
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
        let moved = moved(model, columns);
        let row = |at: usize| {
            let (row, pack) = (at / width, at % width);
            let slots = transition.places().iter().enumerate();
            let products = slots.filter(|&(_, &(of, column))| {
                of == row && column < states && meets(&moved[column], pack)
            });
            Row {
                at,
                products: products
                    .map(|(slot, &(_, column))| Product {
                        slot,
                        state: column * width + pack,
                    })
                    .collect(),
                forced: forced[at],
            }
        };
        Self {
            rows: (0..states * width).map(row).collect(),
            transition,
            sample: states * width,
            forcing,
            forcing_packs: vec![Pack::default(); BLOCK * count],
            packs: count,
        }
    }

    /// Products of a sample that are done side by side, and those of packs that are done in turn.
    pub fn products(&self) -> (usize, usize) {
        let in_turn = self.rows.iter().map(|row| row.products.len()).sum();
        (self.transition.products(), in_turn)
    }

    /// From `rows` at the first sample of a block to all of `steps` samples behind it.
    pub fn sweep(
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
    let sample = recursion.sample;
    for k in 0..steps {
        let (from, to) = rows[k * sample..(k + 2) * sample].split_at_mut(sample);
        let forcing = &recursion.forcing_packs[k * recursion.packs..(k + 1) * recursion.packs];
        for row in &recursion.rows {
            let mut value = multiply_add(1.0, from[row.at], forcing[row.forced]);
            for product in &row.products {
                let factor = recursion.transition.over_block(product.slot)[k];
                value = multiply_add(factor, from[product.state], value);
            }
            to[row.at] = value;
        }
    }
}
