//! One integration step of ∂x/∂θ as a map, S(k+1) = S(k) + P(k) S(k) + Q(k), for all samples of a block side by side.
//!
//! With [P_s | Q_s] = h ([J_s | G_s] + J_s a_s [P_(s-1) | Q_(s-1)]), where J_s and G_s are ∂f/∂x and ∂f/∂θ at stage s,
//! [P | Q] = Σ w_s [P_s | Q_s]. No sample waits for the one before it: only the product with S is sequential, once a
//! step instead of once a stage. Which entries there are is worked out beforehand, so that no structural zero is
//! multiplied.

use multiversion::multiversion;

use super::columns::Columns;
use super::linearised::{BLOCK, Linearised};
use super::method::Stage;
use super::pack::{PACK, Pack};
use crate::model::Model;

/// Samples taken at a time, in vectors: enough sums at once to hide how long a multiply-add takes.
const VECTORS: usize = 4;
const GROUP: usize = VECTORS * PACK;
type Group = [Pack; VECTORS];

/// An entry of ∂f/∂x times an entry of the stage before.
#[derive(Clone, Copy)]
struct Product {
    entry: usize,
    slot: usize,
}

/// How one entry of [P_s | Q_s] comes about.
struct Entry {
    slot: usize,
    /// The entry of J or G that stands there itself.
    own: Option<usize>,
    products: Vec<Product>,
}

/// The maps of a block of samples.
pub(super) struct Transition {
    /// Row and column of each slot; columns are states, then dynamic parameters.
    places: Vec<(usize, usize)>,
    /// By stage.
    plan: Vec<Vec<Entry>>,
    /// By slot: a_s [P_(s-1) | Q_(s-1)], that of the stage to come, and [P | Q].
    before: Vec<[f64; BLOCK]>,
    after: Vec<[f64; BLOCK]>,
    sum: Vec<[f64; BLOCK]>,
}

impl Transition {
    pub fn new(model: &Model, columns: &Columns, stages: usize) -> Self {
        let states = model.states.len();
        let width = states + columns.dynamic.len();
        let dynamics = &model.dynamics_jacobian;
        let moved = moved(model, columns);
        let mut own = vec![None; states * width];
        for (entry, &(row, state)) in dynamics.by_state.iter().enumerate() {
            if moved[state].contains(&true) {
                own[row * width + state] = Some(entry);
            }
        }
        for (i, &(row, parameter)) in dynamics.by_parameter.iter().enumerate() {
            if let Some(column) = columns.dynamic.iter().position(|&p| p == parameter) {
                own[row * width + states + column] = Some(dynamics.by_state.len() + i);
            }
        }
        let mut places = Vec::new();
        let mut slots: Vec<Option<usize>> = vec![None; states * width];
        let mut plan = Vec::new();
        for _ in 0..stages {
            let before = slots.clone();
            let mut entries = Vec::new();
            for (at, &own) in own.iter().enumerate() {
                let (row, column) = (at / width, at % width);
                let factors = (0..states).filter_map(|state| {
                    let entry = own_state(&dynamics.by_state, row, state)?;
                    let slot = before[state * width + column]?;
                    Some(Product { entry, slot })
                });
                let products: Vec<Product> = factors.collect();
                if own.is_none() && products.is_empty() {
                    continue;
                }
                let slot = *slots[at].get_or_insert_with(|| {
                    places.push((row, column));
                    places.len() - 1
                });
                entries.push(Entry {
                    slot,
                    own,
                    products,
                });
            }
            plan.push(entries);
        }
        let zeros = vec![[0.0; BLOCK]; places.len()];
        Self {
            places,
            plan,
            before: zeros.clone(),
            after: zeros.clone(),
            sum: zeros,
        }
    }

    /// Row and column of each entry of [P | Q]; columns are states, then dynamic parameters.
    pub fn places(&self) -> &[(usize, usize)] {
        &self.places
    }

    /// Products of a sample.
    pub fn products(&self) -> usize {
        let entries = self.plan.iter().flatten();
        entries.map(|entry| entry.products.len()).sum()
    }

    /// Works out the maps of the first `steps` samples. `lengths` are those of the steps, s.
    pub fn compose(
        &mut self,
        stages: &[Stage],
        lengths: &[f64; BLOCK],
        steps: usize,
        dynamics: &Linearised<'_>,
    ) {
        self.sum.as_flattened_mut().fill(0.0);
        for s in 0..stages.len() {
            let advance = stages.get(s + 1).map_or(0.0, |next| next.advance);
            let factors = (stages[s].weight, advance);
            let entries = dynamics.all_over_block(s);
            compose(self, s, factors, lengths, steps, entries);
            std::mem::swap(&mut self.before, &mut self.after);
        }
    }

    /// An entry of [P | Q] over the block.
    #[inline(always)]
    pub fn over_block(&self, slot: usize) -> &[f64; BLOCK] {
        &self.sum[slot]
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn compose(
    transition: &mut Transition,
    stage: usize,
    (weight, advance): (f64, f64),
    lengths: &[f64; BLOCK],
    steps: usize,
    entries: &[[f64; BLOCK]],
) {
    let Transition {
        plan,
        before,
        after,
        sum,
        ..
    } = transition;
    for group in 0..steps.div_ceil(GROUP) {
        let lengths = of(lengths, group);
        for entry in &plan[stage] {
            let mut value = match entry.own {
                Some(own) => *of(&entries[own], group),
                None => Group::default(),
            };
            for product in &entry.products {
                let factor = of(&entries[product.entry], group);
                let other = of(&before[product.slot], group);
                for v in 0..VECTORS {
                    for i in 0..PACK {
                        value[v][i] = factor[v][i].mul_add(other[v][i], value[v][i]);
                    }
                }
            }
            // by value, one after the other: two places written in one loop might be one and the same
            for v in 0..VECTORS {
                for i in 0..PACK {
                    value[v][i] *= lengths[v][i];
                }
            }
            let sum = of_mut(&mut sum[entry.slot], group);
            let mut total = *sum;
            for v in 0..VECTORS {
                for i in 0..PACK {
                    total[v][i] = weight.mul_add(value[v][i], total[v][i]);
                }
            }
            *sum = total;
            for vector in &mut value {
                for slope in vector {
                    *slope *= advance;
                }
            }
            *of_mut(&mut after[entry.slot], group) = value;
        }
    }
}

/// The samples of one group.
#[inline(always)]
fn of(values: &[f64; BLOCK], group: usize) -> &Group {
    let (vectors, _) = values.as_chunks::<PACK>();
    let (groups, _) = vectors.as_chunks::<VECTORS>();
    &groups[group]
}

#[inline(always)]
fn of_mut(values: &mut [f64; BLOCK], group: usize) -> &mut Group {
    let (vectors, _) = values.as_chunks_mut::<PACK>();
    let (groups, _) = vectors.as_chunks_mut::<VECTORS>();
    &mut groups[group]
}

fn own_state(by_state: &[(usize, usize)], row: usize, state: usize) -> Option<usize> {
    by_state.iter().position(|&place| place == (row, state))
}

/// By state, then dynamic parameter: whether the one can depend on the other.
pub(super) fn moved(model: &Model, columns: &Columns) -> Vec<Vec<bool>> {
    let dynamics = &model.dynamics_jacobian;
    let mut moved = vec![vec![false; columns.dynamic.len()]; model.states.len()];
    let direct = (dynamics.by_parameter.iter()).chain(&model.initial_jacobian.by_parameter);
    for &(row, parameter) in direct {
        if let Some(column) = columns.dynamic.iter().position(|&p| p == parameter) {
            moved[row][column] = true;
        }
    }
    // what depends on a state that moves, moves: at most as many rounds as there are states
    for _ in 0..model.states.len() {
        for &(row, state) in &dynamics.by_state {
            let by_state = moved[state].clone();
            for (moves, too) in moved[row].iter_mut().zip(by_state) {
                *moves |= too;
            }
        }
    }
    moved
}

/// Whether a state with these parameters has any in a pack.
pub(super) fn meets(moved: &[bool], pack: usize) -> bool {
    moved[pack * PACK..].iter().take(PACK).any(|&moves| moves)
}
