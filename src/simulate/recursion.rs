//! The recursion of ∂x/∂θ along the samples, and the rows of ∂y/∂θ that it gives.

use multiversion::multiversion;

use super::columns::Columns;
use super::linearised::Linearised;
use super::method::Stage;
use super::pack::{Pack, add_scaled, packs};
use super::segment::Steps;
use crate::model::Model;

/// ∂x/∂θ at one sample, and what is needed to get to the next.
pub(super) struct Recursion {
    /// Packs of a row.
    width: usize,
    /// By state, then column.
    current: Vec<Pack>,
    stage: Vec<Pack>,
    slope: Vec<Pack>,
    sum: Vec<Pack>,
    /// (row, state) of the entries of ∂f/∂x.
    by_state: Vec<(usize, usize)>,
    /// Entry of ∂f/∂θ, row and column, for those that belong to a column.
    by_parameter: Vec<(usize, usize, usize)>,
    /// (output, state) of the entries of ∂g/∂x.
    observed_states: Vec<(usize, usize)>,
    /// Entry of ∂g/∂θ, output and place in its row, for those that belong to a column.
    observed_parameters: Vec<(usize, usize, usize)>,
    /// By output: packs of a row.
    row_widths: Vec<usize>,
}

impl Recursion {
    pub fn new(model: &Model, columns: &Columns) -> Self {
        let width = packs(columns.dynamic.len());
        let dynamics = &model.dynamics_jacobian;
        let column_of = |parameter: usize| columns.dynamic.iter().position(|&p| p == parameter);
        let by_parameter = (dynamics.by_parameter.iter().enumerate())
            .filter_map(|(i, &(row, parameter))| {
                Some((dynamics.by_state.len() + i, row, column_of(parameter)?))
            })
            .collect();
        let observation = &model.observation_jacobian;
        let place_of = |output: usize, parameter: usize| {
            columns
                .of_output(output)
                .iter()
                .position(|&p| p == parameter)
        };
        let observed_parameters = (observation.by_parameter.iter().enumerate())
            .filter_map(|(i, &(output, parameter))| {
                Some((
                    observation.by_state.len() + i,
                    output,
                    place_of(output, parameter)?,
                ))
            })
            .collect();
        let zeros = || vec![Pack::default(); width * model.states.len()];
        Self {
            width,
            current: zeros(),
            stage: zeros(),
            slope: zeros(),
            sum: zeros(),
            by_state: dynamics.by_state.clone(),
            by_parameter,
            observed_states: observation.by_state.clone(),
            observed_parameters,
            row_widths: (0..columns.outputs())
                .map(|output| packs(columns.of_output(output).len()))
                .collect(),
        }
    }

    /// Begins with ∂x0/∂θ.
    pub fn start(&mut self, model: &Model, columns: &Columns, parameters: &[f64]) {
        let jacobian = &model.initial_jacobian;
        let mut workspace = jacobian.program.workspace::<f64>();
        jacobian.program.set_parameters(&mut workspace, parameters);
        jacobian.program.run(&mut workspace);
        self.current.fill(Pack::default());
        for (entry, &(state, parameter)) in jacobian.by_parameter.iter().enumerate() {
            if let Some(column) = columns.dynamic.iter().position(|&p| p == parameter) {
                let result = jacobian.by_state.len() + entry;
                let row = &mut self.current[state * self.width..(state + 1) * self.width];
                row.as_flattened_mut()[column] = jacobian.program.result(&workspace, result);
            }
        }
    }

    /// ∂y/∂θ = ∂g/∂x ∂x/∂θ + ∂g/∂θ at sample `k` of the block.
    #[inline(always)]
    fn form_rows(&self, k: usize, observation: &Linearised<'_>, rows: &mut [Vec<Pack>]) {
        for (rows, &width) in rows.iter_mut().zip(&self.row_widths) {
            rows[k * width..(k + 1) * width].fill(Pack::default());
        }
        for (entry, &(output, state)) in self.observed_states.iter().enumerate() {
            let from = &self.current[state * self.width..(state + 1) * self.width];
            let at = k * self.row_widths[output];
            add_scaled(
                &mut rows[output][at..at + self.width],
                observation.value(0, entry, k),
                from,
            );
        }
        for &(entry, output, place) in &self.observed_parameters {
            let at = k * self.row_widths[output];
            rows[output][at..].as_flattened_mut()[place] += observation.value(0, entry, k);
        }
    }

    /// One integration step from sample `k` of the block.
    #[inline(always)]
    fn step(&mut self, stages: &[Stage], h: f64, k: usize, dynamics: &Linearised<'_>) {
        let width = self.width;
        self.sum.copy_from_slice(&self.current);
        for (s, stage) in stages.iter().enumerate() {
            if s > 0 {
                self.stage.copy_from_slice(&self.current);
                add_scaled(&mut self.stage, h * stage.advance, &self.slope);
            }
            let states = if s > 0 { &self.stage } else { &self.current };
            self.slope.fill(Pack::default());
            for (entry, &(row, state)) in self.by_state.iter().enumerate() {
                let from = &states[state * width..(state + 1) * width];
                add_scaled(
                    &mut self.slope[row * width..(row + 1) * width],
                    dynamics.value(s, entry, k),
                    from,
                );
            }
            let slope = self.slope.as_flattened_mut();
            for &(entry, row, column) in &self.by_parameter {
                slope[row * width * super::pack::PACK + column] += dynamics.value(s, entry, k);
            }
            add_scaled(&mut self.sum, h * stage.weight, &self.slope);
        }
        std::mem::swap(&mut self.current, &mut self.sum);
    }
}

/// A block of samples, linearised.
pub(super) struct Sweep<'a> {
    pub stages: &'a [Stage],
    pub steps: &'a Steps,
    /// The first sample of the block, how many there are, and the last of the segment.
    pub first: usize,
    pub len: usize,
    pub last: usize,
    pub dynamics: &'a Linearised<'a>,
    pub observation: &'a Linearised<'a>,
}

/// Rows of ∂y/∂θ at each sample of a block, and ∂x/∂θ behind the last.
///
/// Compiled for several vector widths. None of them contracts products and sums, so that all give the same
/// numbers.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
pub(super) fn sweep(block: &Sweep<'_>, recursion: &mut Recursion, rows: &mut [Vec<Pack>]) {
    for k in 0..block.len {
        recursion.form_rows(k, block.observation, rows);
        if block.first + k < block.last {
            recursion.step(
                block.stages,
                block.steps.length(block.first + k),
                k,
                block.dynamics,
            );
        }
    }
}
