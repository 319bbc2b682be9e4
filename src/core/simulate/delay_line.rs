//! Delayed outputs: y(t_k - D) and its row of sensitivities S(t_k - D) - dy/dt ∂D/∂θ, from a window of samples.
//!
//! The window slides along with the blocks; it holds no more samples than the longest delay and a few blocks.

use super::block::Block;
use super::columns::Columns;
use super::interpolation::{At, Axis};
use super::pack::{Pack, multiply_add, packs};
use super::segment::Segment;
use crate::model::{BLOCK, Model};

/// Samples behind the window are dropped when there are as many as this: now and then, not block by block.
const DROPPED_AT_ONCE: usize = 8 * BLOCK;

pub(super) struct DelayLine<'m> {
    model: &'m Model,
    columns: &'m Columns,
    /// By output: packs of a row.
    strides: Vec<usize>,
    axis: Option<Axis>,
    /// By output: its delay, s, where it has one.
    delays: Vec<Option<f64>>,
    /// By output: ∂D/∂θ as a row.
    derivatives: Vec<Vec<Pack>>,
    /// The window: its first sample and the one behind its last.
    first: usize,
    end: usize,
    values: Vec<Vec<f64>>,
    rows: Vec<Vec<Pack>>,
    /// The next sample to be handed on, and room for a block of them.
    next: usize,
    delayed_values: Vec<[f64; BLOCK]>,
    delayed_rows: Vec<Vec<Pack>>,
}

impl<'m> DelayLine<'m> {
    /// `None` for a model without delayed outputs.
    pub(super) fn new(model: &'m Model, columns: &'m Columns) -> Option<Self> {
        if model.delays.outputs.is_empty() {
            return None;
        }
        let outputs = model.outputs.len();
        let strides: Vec<usize> = (0..outputs)
            .map(|output| packs(columns.of_output(output).len()))
            .collect();
        let rows = |stride: &usize| vec![Pack::default(); BLOCK * stride];
        Some(Self {
            model,
            columns,
            axis: None,
            delays: vec![None; outputs],
            derivatives: Vec::new(),
            first: 0,
            end: 0,
            values: vec![Vec::new(); outputs],
            rows: vec![Vec::new(); outputs],
            next: 0,
            delayed_values: vec![[0.0; BLOCK]; outputs],
            delayed_rows: strides.iter().map(rows).collect(),
            strides,
        })
    }

    /// Begins a run. `delays` are those of [`crate::model::Delays::at`].
    pub(super) fn start(&mut self, segment: &Segment, parameters: &[f64], delays: &[f64]) {
        let model = &self.model.delays;
        self.axis = Some(Axis::new(segment));
        (self.first, self.end, self.next) = (0, 0, 0);
        self.values.iter_mut().for_each(Vec::clear);
        self.rows.iter_mut().for_each(Vec::clear);
        for (&output, &delay) in model.outputs.iter().zip(&delays[model.inputs.len()..]) {
            self.delays[output] = Some(delay);
        }
        let row = |stride: &usize| vec![Pack::default(); *stride];
        self.derivatives = self.strides.iter().map(row).collect();
        for (output, parameter, value) in model.output_derivatives(parameters) {
            let mut columns = self.columns.of_output(output).iter();
            if let Some(column) = columns.position(|&p| p == parameter) {
                self.derivatives[output].as_flattened_mut()[column] = value;
            }
        }
    }

    /// Takes the next block, and hands on those that are now known.
    pub(super) fn pass(&mut self, block: &Block<'_>, sink: &mut impl FnMut(&Block<'_>)) {
        let Some(axis) = self.axis.take() else { return };
        for output in 0..self.values.len() {
            self.values[output].extend_from_slice(block.output(output));
            self.rows[output].extend_from_slice(block.packed_rows(output));
        }
        self.end += block.len;
        while self.next <= axis.last() {
            let len = BLOCK.min(axis.last() + 1 - self.next);
            let needed = (0..self.delays.len()).map(|output| {
                // all samples from the one before the instant to the second behind it
                let k = self.next + len - 1;
                self.instant(&axis, output, k).map_or(k + 1, |at| match at {
                    At::Before => 1,
                    At::Between { sample, .. } => (sample + 3).min(axis.last() + 1),
                    At::Behind => axis.last() + 1,
                })
            });
            if needed.max().unwrap_or(0) > self.end {
                break;
            }
            self.hand_on(&axis, len, sink);
        }
        self.drop_samples(&axis);
        self.axis = Some(axis);
    }

    /// The instant that an output shows at sample `k`; `None` where it is not delayed.
    fn instant(&self, axis: &Axis, output: usize, k: usize) -> Option<At> {
        self.delays[output].map(|delay| axis.before(k, delay))
    }

    fn hand_on(&mut self, axis: &Axis, len: usize, sink: &mut impl FnMut(&Block<'_>)) {
        for output in 0..self.values.len() {
            let stride = self.strides[output];
            let (values, rows) = (&self.values[output], &self.rows[output]);
            let row_of = |k: usize| &rows[(k - self.first) * stride..(k - self.first + 1) * stride];
            for k in 0..len {
                let at = self.delays[output].map(|delay| axis.before(self.next + k, delay));
                let to = &mut self.delayed_rows[output][k * stride..(k + 1) * stride];
                let Some(at) = at else {
                    self.delayed_values[output][k] = values[self.next + k - self.first];
                    to.copy_from_slice(row_of(self.next + k));
                    continue;
                };
                let stencil = axis.stencil(at);
                let (mut value, mut rate) = (0.0, 0.0);
                to.fill(Pack::default());
                for ((&sample, &weight), &by_rate) in
                    (stencil.samples.iter().zip(&stencil.weights)).zip(&stencil.rates)
                {
                    if weight == 0.0 && by_rate == 0.0 {
                        continue;
                    }
                    value += weight * values[sample - self.first];
                    rate += by_rate * values[sample - self.first];
                    add_scaled(to, weight, row_of(sample));
                }
                self.delayed_values[output][k] = value;
                add_scaled(to, -rate, &self.derivatives[output]);
            }
        }
        let rows: Vec<&[Pack]> = self.delayed_rows.iter().map(Vec::as_slice).collect();
        sink(&Block {
            first: self.next,
            len,
            outputs: &self.delayed_values,
            columns: self.columns,
            rows: &rows,
        });
        self.next += len;
    }

    /// Drops what no later sample needs.
    fn drop_samples(&mut self, axis: &Axis) {
        let next = self.next.min(axis.last());
        let needed = (0..self.delays.len()).map(|output| {
            self.instant(axis, output, next)
                .map_or(next, |at| match at {
                    At::Before => 0,
                    At::Between { sample, .. } => sample.saturating_sub(1),
                    At::Behind => axis.last(),
                })
        });
        let dropped = needed.min().unwrap_or(next).min(self.end) - self.first;
        if dropped < DROPPED_AT_ONCE {
            return;
        }
        for ((values, rows), stride) in
            (self.values.iter_mut().zip(&mut self.rows)).zip(&self.strides)
        {
            values.drain(..dropped);
            rows.drain(..dropped * stride);
        }
        self.first += dropped;
    }
}

/// to += factor * from
fn add_scaled(to: &mut [Pack], factor: f64, from: &[Pack]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = multiply_add(factor, *from, *to);
    }
}
