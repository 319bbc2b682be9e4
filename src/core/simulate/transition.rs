//! One integration step of ∂x/∂θ as a map, S(k+1) = S(k) + P(k) S(k) + Q(k), for all samples of a block side by side.
//!
//! With [P_s | Q_s] = h ([J_s | G_s] + J_s a_s [P_(s-1) | Q_(s-1)]), where J_s and G_s are ∂f/∂x and ∂f/∂θ at stage s,
//! [P | Q] = Σ w_s [P_s | Q_s]. No sample waits for the one before it: only the product with S is sequential, once a
//! step instead of once a stage. Which entries there are is worked out beforehand, so that no structural zero is
//! multiplied.

use multiversion::multiversion;

use super::aligned::Aligned;
use super::columns::Columns;
use super::linearised::Linearised;
use super::method::Stage;
use super::pack::{PACK, Pack};
use crate::model::{BLOCK, Model};
use crate::stop;

/// Samples taken at a time, in vectors: so few that all slots of them stay in the nearest memory.
const VECTORS: usize = 2;
const GROUP: usize = VECTORS * PACK;
type Group = [Pack; VECTORS];

/// An entry of ∂f/∂x times an entry of the stage before.
#[derive(Clone, Copy)]
struct Product {
    entry: usize,
    slot: usize,
}

/// How one entry of [P_s | Q_s] comes about.
#[derive(Clone, Copy)]
struct Entry {
    slot: usize,
    /// No stage before had it.
    is_new: bool,
    /// The entry of J or G that stands there itself.
    own: Option<usize>,
    /// How many products.
    products: usize,
}

/// One stage: its entries, and their products one after the other.
#[derive(Default)]
struct StagePlan {
    entries: Vec<Entry>,
    products: Vec<Product>,
}

/// The maps of a block of samples.
pub(super) struct Transition {
    /// Row and column of each slot; columns are states, then dynamic parameters.
    places: Vec<(usize, usize)>,
    plan: Vec<StagePlan>,
    /// By slot: [P | Q].
    maps: Aligned<[f64; BLOCK]>,
    scratch: Scratch,
}

/// Of one group of samples, by slot: h a_s [P_(s-1) | Q_(s-1)], that of the stage to come, and the sum of stages.
struct Scratch {
    before: Aligned<Group>,
    after: Aligned<Group>,
    sum: Aligned<Group>,
}

impl Transition {
    pub(super) fn new(model: &Model, columns: &Columns, stages: usize) -> Self {
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
            let mut stage = StagePlan::default();
            for (at, &own) in own.iter().enumerate() {
                stop::check();
                let (row, column) = (at / width, at % width);
                let factors = (0..states).filter_map(|state| {
                    let entry = own_state(&dynamics.by_state, row, state)?;
                    let slot = before[state * width + column]?;
                    Some(Product { entry, slot })
                });
                let so_far = stage.products.len();
                stage.products.extend(factors);
                let products = stage.products.len() - so_far;
                if own.is_none() && products == 0 {
                    continue;
                }
                let slot = *slots[at].get_or_insert_with(|| {
                    places.push((row, column));
                    places.len() - 1
                });
                stage.entries.push(Entry {
                    slot,
                    is_new: before[at].is_none(),
                    own,
                    products,
                });
            }
            plan.push(stage);
        }
        let zeros = || Aligned::zeros(places.len());
        Self {
            maps: Aligned::zeros(places.len()),
            scratch: Scratch {
                before: zeros(),
                after: zeros(),
                sum: zeros(),
            },
            plan,
            places,
        }
    }

    /// Row and column of each entry of [P | Q]; columns are states, then dynamic parameters.
    pub(super) fn places(&self) -> &[(usize, usize)] {
        &self.places
    }

    /// Products of a sample.
    pub(super) fn products(&self) -> usize {
        self.plan.iter().map(|stage| stage.products.len()).sum()
    }

    /// Works out the maps of the first `steps` samples. `lengths` are those of the steps, s.
    pub(super) fn compose(
        &mut self,
        stages: &[Stage],
        lengths: &[f64; BLOCK],
        steps: usize,
        dynamics: &Linearised<'_>,
    ) {
        for group in 0..steps.div_ceil(GROUP) {
            stop::check();
            let lengths = of(lengths, group);
            for s in 0..stages.len() {
                let advance = stages.get(s + 1).map(|next| next.advance);
                let factors = (stages[s].weight, advance);
                let entries = dynamics.all_over_block(s);
                compose(
                    &self.plan[s],
                    &mut self.scratch,
                    factors,
                    lengths,
                    (group, entries),
                );
                std::mem::swap(&mut self.scratch.before, &mut self.scratch.after);
            }
            for (map, sum) in self.maps.iter_mut().zip(&*self.scratch.sum) {
                *of_mut(map, group) = *sum;
            }
        }
    }

    /// An entry of [P | Q] over the block.
    #[inline(always)]
    pub(super) fn over_block(&self, slot: usize) -> &[f64; BLOCK] {
        &self.maps[slot]
    }
}

/// One stage of one group of samples.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn compose(
    plan: &StagePlan,
    scratch: &mut Scratch,
    (weight, advance): (f64, Option<f64>),
    lengths: &Group,
    (group, entries): (usize, &[[f64; BLOCK]]),
) {
    let (weight, onwards) = (
        times(weight, lengths),
        times(advance.unwrap_or(0.0), lengths),
    );
    let mut products = plan.products.as_slice();
    for entry in &plan.entries {
        let mut value = match entry.own {
            Some(own) => *of(&entries[own], group),
            None => Group::default(),
        };
        let (own, rest) = products.split_at(entry.products);
        products = rest;
        for product in own {
            let factor = of(&entries[product.entry], group);
            value = add_product(factor, &scratch.before[product.slot], value);
        }
        let sum = &mut scratch.sum[entry.slot];
        let so_far = if entry.is_new { Group::default() } else { *sum };
        *sum = add_product(&weight, &value, so_far);
        if advance.is_some() {
            scratch.after[entry.slot] = add_product(&onwards, &value, Group::default());
        }
    }
}

/// a * b + addend, number by number. The addend by value, so that nothing can alias.
#[inline(always)]
fn add_product(a: &Group, b: &Group, mut addend: Group) -> Group {
    for v in 0..VECTORS {
        for i in 0..PACK {
            addend[v][i] = a[v][i].mul_add(b[v][i], addend[v][i]);
        }
    }
    addend
}

#[inline(always)]
fn times(factor: f64, lengths: &Group) -> Group {
    let mut product = *lengths;
    for length in product.as_flattened_mut() {
        *length *= factor;
    }
    product
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
