//! ∂x/∂θ of a model whose integration step is a constant matrix: S(k+1) = Φ S(k) + Σ_j z_j(k) ∂M_j/∂θ.

use multiversion::multiversion;

use super::aligned::Aligned;
use super::columns::Columns;
use super::one_step::OneStep;
use super::pack::{PACK, Pack, multiply_add};
use super::segment::Segment;
use super::trajectory::Trajectory;
use crate::model::BLOCK;

#[derive(Default)]
pub(super) struct OneStepRecursion {
    width: usize,
    states: usize,
    factors: usize,
    /// By pack, then state, then factor: ∂M/∂θ.
    change: Aligned<Pack>,
    /// By sample of the block: z.
    factors_over_block: Vec<f64>,
}

impl OneStepRecursion {
    /// Works out ∂M/∂θ for the θ and the step that are set.
    pub(super) fn set(
        &mut self,
        one_step: &OneStep<'_>,
        h: f64,
        trajectory: &Trajectory<'_>,
        columns: &Columns,
        width: usize,
    ) {
        self.width = width;
        self.factors = one_step.factors();
        self.states = one_step.matrix().len() / self.factors;
        let size = one_step.matrix().len();
        self.change = Aligned::zeros(width * size);
        for (column, &parameter) in columns.dynamic.iter().enumerate() {
            let derivative =
                one_step.derivative(parameter, h, trajectory.stages, trajectory.interpolation());
            let to = &mut self.change[column / PACK * size..];
            for (to, value) in to.iter_mut().zip(derivative) {
                to[column % PACK] = value;
            }
        }
        self.factors_over_block.resize(BLOCK * self.factors, 0.0);
    }

    /// From `rows` at the first sample of a block to all of `steps` samples behind it.
    pub(super) fn sweep(
        &mut self,
        one_step: &OneStep<'_>,
        segment: &Segment,
        first: usize,
        steps: usize,
        trajectory: &Trajectory<'_>,
        rows: &mut [Pack],
    ) {
        let inputs = segment.inputs.len();
        let mut put = |factor: usize, values: &[f64]| {
            let to = self.factors_over_block.iter_mut().skip(factor);
            to.step_by(self.factors)
                .zip(values)
                .for_each(|(to, &value)| *to = value);
        };
        for (i, values) in trajectory.stage_states[..self.states].iter().enumerate() {
            put(i, values);
        }
        for (j, samples) in segment.inputs.iter().enumerate() {
            put(self.states + j, &samples[first..first + steps]);
            put(
                self.states + inputs + j,
                &samples[first + 1..first + 1 + steps],
            );
        }
        put(self.factors - 1, &[1.0; BLOCK]);
        sweep(
            (self.states, self.width),
            one_step.matrix(),
            &self.change,
            &self.factors_over_block[..steps * self.factors],
            rows,
        );
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn sweep(
    (states, width): (usize, usize),
    matrix: &[f64],
    change: &[Pack],
    factors: &[f64],
    rows: &mut [Pack],
) {
    match states {
        1 => sweep_states::<1>(width, matrix, change, factors, rows),
        2 => sweep_states::<2>(width, matrix, change, factors, rows),
        3 => sweep_states::<3>(width, matrix, change, factors, rows),
        4 => sweep_states::<4>(width, matrix, change, factors, rows),
        5 => sweep_states::<5>(width, matrix, change, factors, rows),
        _ => sweep_states::<{ super::one_step::MOST_STATES }>(width, matrix, change, factors, rows),
    }
}

/// For a number of states that is known beforehand, so that ∂x/∂θ of a pack of parameters stays in registers.
#[inline(always)]
fn sweep_states<const STATES: usize>(
    width: usize,
    matrix: &[f64],
    change: &[Pack],
    factors: &[f64],
    rows: &mut [Pack],
) {
    let count = matrix.len() / STATES;
    let transition: [[f64; STATES]; STATES] =
        std::array::from_fn(|i| std::array::from_fn(|j| matrix[i * count + j]));
    let sample = STATES * width;
    for (pack, change) in change.chunks_exact(STATES * count).enumerate() {
        let change: [&[Pack]; STATES] =
            std::array::from_fn(|i| &change[i * count..(i + 1) * count]);
        let mut now: [Pack; STATES] = std::array::from_fn(|i| rows[i * width + pack]);
        for (factors, to) in factors
            .chunks_exact(count)
            .zip(rows[sample..].chunks_exact_mut(sample))
        {
            let mut next = [Pack::default(); STATES];
            for (j, &factor) in factors.iter().enumerate() {
                for i in 0..STATES {
                    next[i] = multiply_add(factor, change[i][j], next[i]);
                }
            }
            for j in 0..STATES {
                for i in 0..STATES {
                    next[i] = multiply_add(transition[i][j], now[j], next[i]);
                }
            }
            for i in 0..STATES {
                to[i * width + pack] = next[i];
            }
            now = next;
        }
    }
}
