//! Rows of ∂y/∂θ = ∂g/∂x ∂x/∂θ + ∂g/∂θ over a block.

use multiversion::multiversion;

use super::aligned::Aligned;
use super::columns::Columns;
use super::linearised::Linearised;
use super::pack::{PACK, Pack, multiply_add, packs};
use crate::model::{BLOCK, Model};

/// Outputs that depend on more states go the general way.
const MOST_IN_REGISTERS: usize = 16;

pub(super) struct OutputRows {
    outputs: Vec<OutputRow>,
}

/// The rows of one output.
struct OutputRow {
    /// Packs of a row.
    width: usize,
    /// Entries of ∂g/∂x: result of the program, and state.
    by_state: Vec<(usize, usize)>,
    /// Entries of ∂g/∂θ: result of the program, and column.
    by_parameter: Vec<(usize, usize)>,
    /// ∂g/∂θ as packs: by sample of the block; one row for all where only θ changes it; empty where it is zero.
    direct: Aligned<Pack>,
    /// By sample of the block.
    rows: Aligned<Pack>,
}

impl OutputRows {
    pub(super) fn new(model: &Model, columns: &Columns) -> Self {
        let jacobian = &model.observation_jacobian;
        let row = |output: usize| {
            let own = columns.of_output(output);
            let width = packs(own.len());
            let entries = jacobian.by_state.iter().enumerate();
            let by_state = entries.filter(|(_, (row, _))| *row == output);
            let entries = jacobian.by_parameter.iter().enumerate();
            let by_parameter = entries.filter(|(_, (row, _))| *row == output);
            let by_parameter: Vec<(usize, usize)> = by_parameter
                .filter_map(|(i, &(_, parameter))| {
                    let column = own.iter().position(|&p| p == parameter)?;
                    Some((jacobian.by_state.len() + i, column))
                })
                .collect();
            let varies = |&(entry, _): &(usize, usize)| jacobian.program.varies(entry);
            let direct_rows = match by_parameter.as_slice() {
                [] => 0,
                entries if entries.iter().any(varies) => BLOCK,
                _ => 1,
            };
            OutputRow {
                width,
                by_state: by_state.map(|(i, &(_, state))| (i, state)).collect(),
                by_parameter,
                direct: Aligned::zeros(direct_rows * width),
                rows: Aligned::zeros(BLOCK * width),
            }
        };
        Self {
            outputs: (0..columns.outputs()).map(row).collect(),
        }
    }

    /// Puts ∂g/∂θ into packs: entries that only θ changes when `constant`, all others otherwise.
    pub(super) fn place(&mut self, constant: bool, observation: &Linearised<'_>, len: usize) {
        for output in &mut self.outputs {
            for &(entry, column) in &output.by_parameter {
                if observation.varies(entry) == constant {
                    continue;
                }
                let rows = output.direct.as_flattened_mut();
                let values = &observation.over_block(0, entry)[..len];
                for (row, &value) in rows.chunks_exact_mut(output.width * PACK).zip(values) {
                    row[column] = value;
                }
            }
        }
    }

    /// Forms the rows of `len` samples. `sensitivities` are ∂x/∂θ by sample and state, `width` packs each.
    pub(super) fn form(
        &mut self,
        len: usize,
        observation: &Linearised<'_>,
        sensitivities: &[Pack],
        (states, width): (usize, usize),
    ) {
        for output in &mut self.outputs {
            form(output, len, observation, sensitivities, (states, width));
        }
    }

    /// The rows of one output, each padded with zeros to whole packs.
    pub(super) fn of(&self, output: usize) -> &[Pack] {
        &self.outputs[output].rows
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn form(
    output: &mut OutputRow,
    len: usize,
    observation: &Linearised<'_>,
    sensitivities: &[Pack],
    (states, width): (usize, usize),
) {
    let sensitivities = (sensitivities, states);
    if output.by_state.len() > MOST_IN_REGISTERS {
        return form_any(output, len, observation, sensitivities, width);
    }
    match (output.width, width) {
        (1, 1) => form_packs::<1, 1>(output, len, observation, sensitivities),
        (2, 1) => form_packs::<2, 1>(output, len, observation, sensitivities),
        (2, 2) => form_packs::<2, 2>(output, len, observation, sensitivities),
        (3, 2) => form_packs::<3, 2>(output, len, observation, sensitivities),
        (3, 3) => form_packs::<3, 3>(output, len, observation, sensitivities),
        (4, 3) => form_packs::<4, 3>(output, len, observation, sensitivities),
        (4, 4) => form_packs::<4, 4>(output, len, observation, sensitivities),
        (5, 4) => form_packs::<5, 4>(output, len, observation, sensitivities),
        _ => form_any(output, len, observation, sensitivities, width),
    }
}

/// For a number of packs that is known beforehand, so that a row stays in registers: `ROW` of this output, `STATE` of
/// each state.
#[inline(always)]
fn form_packs<const ROW: usize, const STATE: usize>(
    output: &mut OutputRow,
    len: usize,
    observation: &Linearised<'_>,
    (sensitivities, states): (&[Pack], usize),
) {
    let (rows, _) = output.rows.as_chunks_mut::<ROW>();
    let (direct, _) = output.direct.as_chunks::<ROW>();
    let zero = [Pack::default(); ROW];
    // where there is one row, it is that of all samples
    let same = direct.first().unwrap_or(&zero);
    let (sensitivities, _) = sensitivities.as_chunks::<STATE>();
    let samples = sensitivities.chunks_exact(states.max(1));
    let nothing = (&[0.0; BLOCK], 0);
    let mut entries = [nothing; MOST_IN_REGISTERS];
    for (to, &(entry, state)) in entries.iter_mut().zip(&output.by_state) {
        *to = (observation.over_block(0, entry), state);
    }
    let entries = &entries[..output.by_state.len()];
    let rows = rows[..len.min(BLOCK)].iter_mut();
    for (k, (row, by_state)) in rows.zip(samples).enumerate() {
        let mut sum = *direct.get(k).unwrap_or(same);
        for &(values, state) in entries {
            let from = &by_state[state];
            for pack in 0..STATE {
                sum[pack] = multiply_add(values[k], from[pack], sum[pack]);
            }
        }
        *row = sum;
    }
}

/// For any number of packs.
#[inline(always)]
fn form_any(
    output: &mut OutputRow,
    len: usize,
    observation: &Linearised<'_>,
    (sensitivities, states): (&[Pack], usize),
    width: usize,
) {
    let rows = output.rows[..len * output.width].chunks_exact_mut(output.width.max(1));
    let same = output.direct.len() == output.width;
    for (k, row) in rows.enumerate() {
        let at = if same { 0 } else { k * output.width };
        match output.direct.get(at..at + output.width) {
            Some(direct) => row.copy_from_slice(direct),
            None => row.fill(Pack::default()),
        }
        for &(entry, state) in &output.by_state {
            let value = observation.value(0, entry, k);
            let from = &sensitivities[(k * states + state) * width..][..width];
            for (to, &from) in row.iter_mut().zip(from) {
                *to = multiply_add(value, from, *to);
            }
        }
    }
}
