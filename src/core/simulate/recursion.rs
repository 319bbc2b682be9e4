//! ∂x/∂θ of any model, stage by stage of the integration scheme: ∂K/∂θ = ∂f/∂x ∂X/∂θ + ∂f/∂θ.

use multiversion::multiversion;

use super::aligned::Aligned;
use super::columns::Columns;
use super::linearised::Linearised;
use super::method::Stage;
use super::pack::{PACK, Pack, multiply_add, packs};
use super::segment::Segment;
use super::transition::{meets, moved};
use crate::model::{BLOCK, Model};
use crate::stop;

/// One product of the recursion: an entry of ∂f/∂x times a row of ∂x/∂θ.
#[derive(Clone, Copy)]
struct Product {
    entry: usize,
    state: usize,
}

/// An entry of ∂f/∂θ that belongs to a column, and where it stands.
#[derive(Clone, Copy)]
struct Place {
    entry: usize,
    /// Number within the packs of one sample.
    number: usize,
}

/// What the recursion needs to know of a model, and its buffers.
pub(super) struct Recursion {
    states: usize,
    width: usize,
    /// By pack, then row: the entries of ∂f/∂x that meet a state with sensitivities in that pack.
    by_state: Vec<Vec<Product>>,
    by_parameter: Vec<Place>,
    /// By pack, then state: which pack of ∂f/∂θ it is; 0 is one that is always zero.
    forced: Vec<usize>,
    /// Packs of ∂f/∂θ at one sample: the zero pack, and those with an entry.
    packs: usize,
    /// By stage, then sample of the block: the packs of ∂f/∂θ.
    forcing: Aligned<Pack>,
    scratch: Scratch,
}

/// One pack of each state's row.
struct Scratch {
    now: Aligned<Pack>,
    stage: Aligned<Pack>,
    slope: Aligned<Pack>,
    sum: Aligned<Pack>,
}

/// Rows of packs beyond which one step takes long.
const LONG: usize = 256;

impl Recursion {
    pub(super) fn new(model: &Model, columns: &Columns, stages: usize) -> Self {
        let states = model.states.len();
        let width = packs(columns.dynamic.len());
        let dynamics = &model.dynamics_jacobian;
        let mut forced = vec![0; width * states];
        let mut packs = 1;
        let mut by_parameter = Vec::new();
        for (i, &(row, parameter)) in dynamics.by_parameter.iter().enumerate() {
            let Some(column) = columns.dynamic.iter().position(|&p| p == parameter) else {
                continue;
            };
            let pack = &mut forced[column / PACK * states + row];
            if *pack == 0 {
                *pack = packs;
                packs += 1;
            }
            by_parameter.push(Place {
                entry: dynamics.by_state.len() + i,
                number: *pack * PACK + column % PACK,
            });
        }
        let zeros = || Aligned::zeros(states);
        Self {
            states,
            width,
            by_state: products(model, columns, width),
            by_parameter,
            forced,
            packs,
            forcing: Aligned::zeros(stages * BLOCK * packs),
            scratch: Scratch {
                now: zeros(),
                stage: zeros(),
                slope: zeros(),
                sum: zeros(),
            },
        }
    }

    /// Products of a pack at each stage.
    pub(super) fn products(&self) -> usize {
        self.by_state.iter().map(Vec::len).sum()
    }

    /// Puts ∂f/∂θ into packs: entries that only θ changes when `constant`, all others otherwise. Places are
    /// the same in every block, so that what stands stays.
    pub(super) fn place(&mut self, constant: bool, dynamics: &Linearised<'_>, len: usize) {
        let sample = self.packs * PACK;
        for (stage, forcing) in self
            .forcing
            .as_flattened_mut()
            .chunks_exact_mut(BLOCK * sample)
            .enumerate()
        {
            for place in &self.by_parameter {
                if dynamics.varies(place.entry) == constant {
                    continue;
                }
                let values = &dynamics.over_block(stage, place.entry)[..len];
                for (to, &value) in forcing.chunks_exact_mut(sample).zip(values) {
                    to[place.number] = value;
                }
            }
        }
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
        let is_long = self.by_state.len() > LONG;
        for k in 0..steps {
            if is_long {
                stop::check();
            }
            let h = segment.steps.length(first + k);
            step(self, stages, h, k, dynamics, rows);
        }
    }
}

/// One integration step from sample `k` of the block, a pack of parameters after the other.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn step(
    recursion: &mut Recursion,
    stages: &[Stage],
    h: f64,
    k: usize,
    dynamics: &Linearised<'_>,
    rows: &mut [Pack],
) {
    let (states, width) = (recursion.states, recursion.width);
    let sample = states * width;
    let (from, to) = rows[k * sample..].split_at_mut(sample);
    let Scratch {
        now,
        stage: at,
        slope,
        sum,
    } = &mut recursion.scratch;
    for pack in 0..width {
        for i in 0..states {
            now[i] = from[i * width + pack];
            at[i] = now[i];
            sum[i] = now[i];
        }
        let forced = &recursion.forced[pack * states..(pack + 1) * states];
        for (s, stage) in stages.iter().enumerate() {
            if s > 0 {
                for i in 0..states {
                    at[i] = multiply_add(h * stage.advance, slope[i], now[i]);
                }
            }
            let forcing = &recursion.forcing[(s * BLOCK + k) * recursion.packs..];
            for (i, products) in recursion.by_state[pack * states..(pack + 1) * states]
                .iter()
                .enumerate()
            {
                let mut value = forcing[forced[i]];
                for product in products {
                    let factor = dynamics.value(s, product.entry, k);
                    value = multiply_add(factor, at[product.state], value);
                }
                slope[i] = value;
                sum[i] = multiply_add(h * stage.weight, value, sum[i]);
            }
        }
        for i in 0..states {
            to[i * width + pack] = sum[i];
        }
    }
}

/// By pack, then row: entries of ∂f/∂x, without those that meet only zeros for any θ.
fn products(model: &Model, columns: &Columns, width: usize) -> Vec<Vec<Product>> {
    let states = model.states.len();
    let dynamics = &model.dynamics_jacobian;
    let mut products = vec![Vec::new(); width * states];
    let moved = moved(model, columns);
    for (pack, products) in products.chunks_exact_mut(states.max(1)).enumerate() {
        let moves = |state: usize| meets(&moved[state], pack);
        for (entry, &(row, state)) in dynamics.by_state.iter().enumerate() {
            if moves(state) {
                products[row].push(Product { entry, state });
            }
        }
    }
    products
}
