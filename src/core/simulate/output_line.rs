//! Outputs on their paths to the recorder with their rows of sensitivities, block by block: lagged, and then from a
//! window of samples delayed, y(t_k - D) and S(t_k - D) - dy/dt ∂D/∂θ.
//!
//! The window slides along with the blocks; it holds no more samples than the longest delay and a few blocks.

use super::block::Block;
use super::columns::Columns;
use super::interpolation::{At, Axis};
use super::lag::Lag;
use super::pack::{Pack, multiply_add, packs};
use super::segment::Segment;
use crate::model::{BLOCK, Element, Model, PathElement};

/// Samples behind the window are dropped when there are as many as this: now and then, not block by block.
const DROPPED_AT_ONCE: usize = 8 * BLOCK;

pub(super) struct OutputLine<'m> {
    model: &'m Model,
    columns: &'m Columns,
    /// By output: packs of a row.
    strides: Vec<usize>,
    axis: Option<Axis>,
    /// By output: its lag and its delay, s, where it has them.
    lags: Vec<Option<RowLag>>,
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

impl<'m> OutputLine<'m> {
    /// `None` for a model whose outputs have no paths.
    pub(super) fn new(model: &'m Model, columns: &'m Columns) -> Option<Self> {
        if model.paths.of_outputs().is_empty() {
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
            lags: vec![None; outputs],
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

    /// Begins a run. `sizes` are those of [`crate::model::Paths::at`].
    pub(super) fn start(&mut self, segment: &Segment, parameters: &[f64], sizes: &[f64]) {
        let paths = &self.model.paths;
        let axis = Axis::new(segment);
        (self.first, self.end, self.next) = (0, 0, 0);
        self.values.iter_mut().for_each(Vec::clear);
        self.rows.iter_mut().for_each(Vec::clear);
        let row = |stride: &usize| vec![Pack::default(); *stride];
        self.derivatives = self.strides.iter().map(row).collect();
        let sizes = &sizes[paths.of_inputs().len()..];
        for (passed, &size) in paths.of_outputs().iter().zip(sizes) {
            let output = passed.signal;
            match passed.element {
                Element::Lag => {
                    let lag = Lag::new(size, &axis);
                    self.lags[output] = Some(RowLag::new(lag, self.strides[output]));
                }
                Element::Delay => self.delays[output] = Some(size),
                // of inputs alone
                Element::Play | Element::RateLimit => {}
            }
        }
        for (place, parameter, value) in paths.output_derivatives(parameters) {
            let PathElement { signal, element } = paths.of_outputs()[place];
            let mut columns = self.columns.of_output(signal).iter();
            let Some(column) = columns.position(|&p| p == parameter) else {
                continue;
            };
            let row = match (element, &mut self.lags[signal]) {
                (Element::Lag, Some(lag)) => &mut lag.derivative,
                _ => &mut self.derivatives[signal],
            };
            row.as_flattened_mut()[column] = value;
        }
        self.axis = Some(axis);
    }

    /// Takes the next block, and hands on those that are now known.
    pub(super) fn pass(&mut self, block: &Block<'_>, sink: &mut impl FnMut(&Block<'_>)) {
        let Some(axis) = self.axis.take() else { return };
        for output in 0..self.values.len() {
            self.values[output].extend_from_slice(block.output(output));
            self.rows[output].extend_from_slice(block.packed_rows(output));
            if let Some(lag) = &mut self.lags[output] {
                let new = self.end - self.first;
                let rows = &mut self.rows[output][new * self.strides[output]..];
                lag.pass(&axis, self.end, &mut self.values[output][new..], rows);
            }
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

/// A lag that goes along an output and its rows: w and ∂w/∂θ, see [`Lag`].
#[derive(Clone)]
struct RowLag {
    lag: Lag,
    /// ∂T/∂θ as a row.
    derivative: Vec<Pack>,
    off: f64,
    off_row: Vec<Pack>,
    /// The sample before, as it was before the lag.
    before: f64,
    before_row: Vec<Pack>,
}

impl RowLag {
    fn new(lag: Lag, stride: usize) -> Self {
        let row = vec![Pack::default(); stride];
        Self {
            lag,
            derivative: row.clone(),
            off: 0.0,
            off_row: row.clone(),
            before: 0.0,
            before_row: row,
        }
    }

    /// Passes samples, the first of which is that at `first`.
    fn pass(&mut self, axis: &Axis, first: usize, values: &mut [f64], rows: &mut [Pack]) {
        let (sign, stride) = (self.lag.sign, self.derivative.len());
        for (i, value) in values.iter_mut().enumerate() {
            let row = &mut rows[i * stride..(i + 1) * stride];
            if first + i > 0 {
                let step = self.lag.step(axis, first + i - 1);
                let change = *value - self.before;
                let by_time = step.decay_slope * self.off - step.gain_slope * change;
                let off = self.off_row.as_flattened_mut().iter_mut();
                off.for_each(|off| *off *= step.decay);
                add_scaled(&mut self.off_row, -step.gain, row);
                add_scaled(&mut self.off_row, step.gain, &self.before_row);
                add_scaled(&mut self.off_row, sign * by_time, &self.derivative);
                self.off = step.decay * self.off - step.gain * change;
            }
            self.before = *value;
            self.before_row.copy_from_slice(row);
            *value += sign * self.off;
            add_scaled(row, sign, &self.off_row);
        }
    }
}

/// to += factor * from
fn add_scaled(to: &mut [Pack], factor: f64, from: &[Pack]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = multiply_add(factor, *from, *to);
    }
}
