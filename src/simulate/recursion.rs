//! The recursion of ∂x/∂θ along the samples, and the rows of ∂y/∂θ that it gives.

use multiversion::multiversion;

use super::columns::Columns;
use super::linearised::{BLOCK, Linearised};
use super::method::Stage;
use super::pack::{PACK, Pack, add_scaled, packs, plus, scaled};
use super::segment::Steps;
use crate::model::Model;

/// One product of a recursion: an entry of a Jacobian times a row of ∂x/∂θ.
#[derive(Clone, Copy)]
struct Product {
    entry: usize,
    state: usize,
}

/// An entry of a Jacobian by parameters that belongs to a column, and where it stands in a block of rows.
#[derive(Clone, Copy)]
struct Place {
    entry: usize,
    /// Number within the rows of one sample.
    number: usize,
}

/// ∂x/∂θ at one sample, and what is needed to get to the next.
pub(super) struct Recursion {
    states: usize,
    /// Packs of a row of ∂x/∂θ.
    width: usize,
    /// By state, then column.
    current: Vec<Pack>,
    stage: Vec<Pack>,
    slope: Vec<Pack>,
    sum: Vec<Pack>,
    /// ∂f/∂x, by row.
    by_state: Vec<Vec<Product>>,
    by_parameter: Vec<Place>,
    /// ∂f/∂θ as rows of packs: by stage, then sample of the block.
    forcing: Vec<Pack>,
    /// ∂g/∂x, by output.
    observed_states: Vec<Vec<Product>>,
    /// ∂g/∂θ, by output.
    observed_parameters: Vec<Vec<Place>>,
    /// ∂g/∂θ as rows of packs: by output, then sample of the block.
    observed: Vec<Vec<Pack>>,
    /// By output: packs of a row of ∂y/∂θ.
    row_widths: Vec<usize>,
}

impl Recursion {
    pub fn new(model: &Model, columns: &Columns, stages: usize) -> Self {
        let (states, outputs) = (model.states.len(), columns.outputs());
        let width = packs(columns.dynamic.len());
        let column_of = |parameter: usize| columns.dynamic.iter().position(|&p| p == parameter);
        let dynamics = &model.dynamics_jacobian;
        let by_parameter = (dynamics.by_parameter.iter().enumerate())
            .filter_map(|(i, &(row, parameter))| {
                let number = row * width * PACK + column_of(parameter)?;
                Some(Place {
                    entry: dynamics.by_state.len() + i,
                    number,
                })
            })
            .collect();
        let observation = &model.observation_jacobian;
        let mut observed_parameters = vec![Vec::new(); outputs];
        for (i, &(output, parameter)) in observation.by_parameter.iter().enumerate() {
            if let Some(number) = columns
                .of_output(output)
                .iter()
                .position(|&p| p == parameter)
            {
                observed_parameters[output].push(Place {
                    entry: observation.by_state.len() + i,
                    number,
                });
            }
        }
        let zeros = || vec![Pack::default(); width * states];
        let row_widths: Vec<usize> = (0..outputs)
            .map(|output| packs(columns.of_output(output).len()))
            .collect();
        Self {
            states,
            width,
            current: zeros(),
            stage: zeros(),
            slope: zeros(),
            sum: zeros(),
            by_state: by_row(&dynamics.by_state, states),
            by_parameter,
            forcing: vec![Pack::default(); stages * BLOCK * width * states],
            observed_states: by_row(&observation.by_state, outputs),
            observed_parameters,
            observed: row_widths
                .iter()
                .map(|&width| vec![Pack::default(); BLOCK * width])
                .collect(),
            row_widths,
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

    /// Puts the Jacobians by parameters of a block into rows of packs: entries that only θ changes when
    /// `constant`, all others otherwise. Places are the same in every block, so that what stands stays.
    pub fn place(
        &mut self,
        constant: bool,
        stages: usize,
        dynamics: &Linearised<'_>,
        observation: &Linearised<'_>,
    ) {
        let sample = self.width * self.states * PACK;
        let forcing = self.forcing.as_flattened_mut();
        for place in self
            .by_parameter
            .iter()
            .filter(|place| dynamics.varies(place.entry) != constant)
        {
            for stage in 0..stages {
                let to = forcing[stage * BLOCK * sample..]
                    .iter_mut()
                    .skip(place.number)
                    .step_by(sample);
                to.zip(dynamics.over_block(stage, place.entry))
                    .for_each(|(to, &value)| *to = value);
            }
        }
        for ((places, rows), &width) in self
            .observed_parameters
            .iter()
            .zip(&mut self.observed)
            .zip(&self.row_widths)
        {
            for place in places
                .iter()
                .filter(|place| observation.varies(place.entry) != constant)
            {
                let to = rows
                    .as_flattened_mut()
                    .iter_mut()
                    .skip(place.number)
                    .step_by(width * PACK);
                to.zip(observation.over_block(0, place.entry))
                    .for_each(|(to, &value)| *to = value);
            }
        }
    }

    /// ∂y/∂θ = ∂g/∂x ∂x/∂θ + ∂g/∂θ at sample `k` of the block.
    #[inline(always)]
    fn form_rows(&self, k: usize, observation: &Linearised<'_>, rows: &mut [Vec<Pack>]) {
        for (output, rows) in rows.iter_mut().enumerate() {
            let stride = self.row_widths[output];
            let row = &mut rows[k * stride..(k + 1) * stride];
            row.copy_from_slice(&self.observed[output][k * stride..(k + 1) * stride]);
            for product in &self.observed_states[output] {
                let from =
                    &self.current[product.state * self.width..(product.state + 1) * self.width];
                add_scaled(row, observation.value(0, product.entry, k), from);
            }
        }
    }

    /// One integration step from sample `k` of the block.
    #[inline(always)]
    fn step(&mut self, stages: &[Stage], h: f64, k: usize, dynamics: &Linearised<'_>) {
        let width = self.width;
        self.sum.copy_from_slice(&self.current);
        for (s, stage) in stages.iter().enumerate() {
            if s > 0 {
                let advance = h * stage.advance;
                for ((to, &from), &slope) in
                    self.stage.iter_mut().zip(&self.current).zip(&self.slope)
                {
                    *to = plus(from, scaled(advance, slope));
                }
            }
            let states = if s > 0 { &self.stage } else { &self.current };
            let at = (s * BLOCK + k) * width * self.states;
            let forcing = &self.forcing[at..at + width * self.states];
            let weight = h * stage.weight;
            for (row, products) in self.by_state.iter().enumerate() {
                for pack in 0..width {
                    let mut slope = forcing[row * width + pack];
                    for product in products {
                        let value = dynamics.value(s, product.entry, k);
                        slope = plus(slope, scaled(value, states[product.state * width + pack]));
                    }
                    self.slope[row * width + pack] = slope;
                    let sum = &mut self.sum[row * width + pack];
                    *sum = plus(*sum, scaled(weight, slope));
                }
            }
        }
        std::mem::swap(&mut self.current, &mut self.sum);
    }
}

/// Entries (row, state) as products, by row.
fn by_row(entries: &[(usize, usize)], rows: usize) -> Vec<Vec<Product>> {
    let mut products = vec![Vec::new(); rows];
    for (entry, &(row, state)) in entries.iter().enumerate() {
        products[row].push(Product { entry, state });
    }
    products
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
