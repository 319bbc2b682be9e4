//! Rows of ∂y/∂θ = ∂g/∂x ∂x/∂θ + ∂g/∂θ over a block.

use multiversion::multiversion;

use super::columns::Columns;
use super::linearised::{BLOCK, Linearised};
use super::pack::{PACK, Pack, multiply_add, packs};
use crate::model::Model;

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
    /// By sample of the block: ∂g/∂θ as packs. Empty where it is zero.
    direct: Vec<Pack>,
    /// By sample of the block.
    rows: Vec<Pack>,
}

impl OutputRows {
    pub fn new(model: &Model, columns: &Columns) -> Self {
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
            let over_block = vec![Pack::default(); BLOCK * width];
            OutputRow {
                width,
                by_state: by_state.map(|(i, &(_, state))| (i, state)).collect(),
                direct: if by_parameter.is_empty() {
                    Vec::new()
                } else {
                    over_block.clone()
                },
                by_parameter,
                rows: over_block,
            }
        };
        Self {
            outputs: (0..columns.outputs()).map(row).collect(),
        }
    }

    /// Puts ∂g/∂θ into packs: entries that only θ changes when `constant`, all others otherwise.
    pub fn place(&mut self, constant: bool, observation: &Linearised<'_>, len: usize) {
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
    pub fn form(
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
    pub fn of(&self, output: usize) -> &[Pack] {
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
    let rows = output.rows[..len * output.width].chunks_exact_mut(output.width.max(1));
    let is_direct = !output.direct.is_empty();
    for (k, row) in rows.enumerate() {
        if is_direct {
            row.copy_from_slice(&output.direct[k * output.width..(k + 1) * output.width]);
        } else {
            row.fill(Pack::default());
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
