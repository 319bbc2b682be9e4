//! Recursive Fourier-transform regression: least squares of the state equations in a band, from running transforms.
//!
//! ```text
//! Y_i(f) - H_i(f) = Σ_j Φ_ij(f) θ_j + ends and trends + E_i(f),  dx/dt -> (iω - a) X + ends,  a = -ln λ/Δt
//! ```
//!
//! (Morelli, J. Guidance, Control, and Dynamics 23, 2000). What is constant is not in the band, nor is noise above it: nothing is smoothed or
//! differentiated in time. At frequencies that do not fit into the record both ends show, and a constant: they are estimated along, as
//! [`crate::estimate::equation_error_frequency`] does. Error bounds come from the complex residuals.

use num_complex::Complex64;

use super::equations::Equations;
use super::estimates::Estimates;
use super::options::TrackingOptions;
use super::sample::{Sample, SampleFault};
use super::setup::Setup;
use super::solver::Solver;
use super::sums::Sums;
use crate::estimate::{Ends, FrequencyOptions, Trend};
use crate::flight::{Fault, Faults};
use crate::simulate::InputInterpolation;
use crate::spectral::{Between, Frequencies, RunningTransform};

/// Steps that differ by less than this share are even: times are written with few digits.
const UNEVEN: f64 = 0.05;

/// What is left of the weight of the first sample where its end no longer shows.
const FADED: f64 = 1e-4;

pub(super) struct Fourier {
    equations: Equations,
    options: FrequencyOptions,
    frequencies: Frequencies,
    forgetting: f64,
    between: Vec<Between>,
    /// None until two samples have said how far apart they are.
    transform: Option<RunningTransform>,
    step: f64,
    rows: Vec<Sums>,
    solver: Solver,
    /// By transformed signal: its first value, off which it is looked at.
    levels: Vec<f64>,
    last_time: f64,
    first_time: f64,
    samples: usize,
    /// Σ w and Σ w² of the samples.
    weights: [f64; 2],
    incoming: Vec<f64>,
    signals: Vec<f64>,
    values: Vec<f64>,
    known: Vec<f64>,
    regressors: Vec<f64>,
    row: Vec<Complex64>,
}

impl Fourier {
    pub(super) fn new(setup: &Setup, options: &TrackingOptions) -> Result<Self, Faults> {
        let frequency = options.frequency.ok_or_else(|| {
            Faults::from(Fault::new(
                "/frequency",
                "invalid_value",
                "rft needs a band of frequencies",
            ))
        })?;
        let equations = Equations::new(setup)?;
        let step = frequency.step_hz.unwrap_or(TrackingOptions::STEP_HZ);
        let states = equations.states();
        let more = |row: usize| nuisances(&frequency, row < states);
        let all: usize = (0..equations.rows.len()).map(more).sum();
        let mut next = 0;
        let rows = equations.rows.iter().enumerate().map(|(i, row)| {
            let entries = row.entries.iter();
            let mut own: Vec<usize> = entries.map(|entry| all + entry.column).collect();
            own.extend(next..next + more(i));
            next += more(i);
            Sums::new(own, 0, 1.0)
        });
        let rows: Vec<Sums> = rows.collect();
        let between = between(&equations, setup.input_interpolation);
        let widest = rows.iter().map(Sums::width).max().unwrap_or(1);
        Ok(Self {
            solver: Solver::new(all, equations.tracked.len(), &rows),
            options: frequency,
            frequencies: Frequencies::spaced(step, frequency.band_hz),
            forgetting: options.forgetting,
            transform: None,
            step: f64::NAN,
            levels: vec![0.0; between.len()],
            last_time: f64::NAN,
            first_time: f64::NAN,
            samples: 0,
            weights: [0.0; 2],
            incoming: vec![0.0; equations.signals()],
            signals: vec![0.0; equations.signals()],
            values: vec![0.0; between.len()],
            known: vec![0.0; rows.len()],
            regressors: vec![0.0; equations.entries()],
            row: vec![Complex64::ZERO; widest],
            between,
            rows,
            equations,
        })
    }

    pub(super) fn tracked(&self) -> &[usize] {
        &self.equations.tracked
    }

    /// Whether the sample comes when it has to.
    pub(super) fn check(&self, sample: &Sample<'_>) -> Result<(), SampleFault> {
        let step = sample.time - self.last_time;
        match self.transform.is_none() || (step - self.step).abs() <= UNEVEN * self.step {
            true => Ok(()),
            false => Err(SampleFault::Uneven {
                step,
                wanted: self.step,
            }),
        }
    }

    pub(super) fn push(&mut self, sample: &Sample<'_>, to: &mut Estimates) {
        if self.samples == 0 {
            self.first_time = sample.time;
        }
        if !self.values_of(sample) {
            return;
        }
        match &mut self.transform {
            Some(transform) => {
                subtract(&mut self.values, &self.levels);
                transform.push(&self.values);
            }
            None if self.samples == 0 => {
                let own = self.values.len() - TRENDS;
                self.levels[..own].copy_from_slice(&self.values[..own]);
            }
            None => self.begin(sample.time - self.last_time),
        }
        self.last_time = sample.time;
        self.samples += 1;
        let [sum, squares] = &mut self.weights;
        *sum = self.forgetting * *sum + 1.0;
        *squares = self.forgetting * self.forgetting * *squares + 1.0;
        to.time = sample.time;
        to.samples = self.samples;
        self.solve(to);
    }

    /// Two samples say how far apart all are. The first is its own level, at time 0.
    fn begin(&mut self, step: f64) {
        self.step = step;
        let mut transform =
            RunningTransform::new(step, self.forgetting, self.frequencies, &self.between);
        subtract(&mut self.values, &self.levels);
        let mut first = vec![0.0; self.values.len()];
        first[self.values.len() - TRENDS] = 1.0;
        transform.push(&first);
        transform.push(&self.values);
        self.transform = Some(transform);
    }

    /// Left sides, known parts, regressors, 1 and the time; whether there are any. A signal that was not measured stays what it was.
    fn values_of(&mut self, sample: &Sample<'_>) -> bool {
        let elapsed = sample.time - self.first_time;
        self.equations.read(sample, elapsed, &mut self.incoming);
        if self.samples == 0 && self.incoming.iter().any(|value| !value.is_finite()) {
            return false;
        }
        for (signal, &value) in self.signals.iter_mut().zip(&self.incoming) {
            if value.is_finite() {
                *signal = value;
            }
        }
        self.equations.evaluate(
            &self.signals,
            elapsed,
            &mut self.known,
            &mut self.regressors,
        );
        let left = &self.signals[self.equations.inputs()..];
        let all = left.iter().chain(&self.known).chain(&self.regressors);
        for (to, value) in self.values.iter_mut().zip(all.chain(&[1.0, elapsed])) {
            *to = *value;
        }
        true
    }

    fn solve(&mut self, to: &mut Estimates) {
        let Some(transform) = (self.transform.as_ref()).filter(|transform| transform.is_ready())
        else {
            return;
        };
        let [sum, squares] = self.weights;
        let duration = (sum * sum / squares - 1.0) * self.step;
        let share = (self.frequencies.step * duration).min(1.0);
        let states = self.equations.states();
        let fade = -self.forgetting.ln() / self.step;
        let (left, mut entry) = (self.rows.len(), 2 * self.rows.len());
        let trend = self.values.len() - TRENDS;
        let first_end = if transform.faded() > FADED {
            transform.faded()
        } else {
            0.0
        };
        for (i, (row, sums)) in self.equations.rows.iter().zip(&mut self.rows).enumerate() {
            sums.clear();
            let (width, entries) = (sums.width(), row.entries.len());
            for (k, &omega) in transform.omega().iter().enumerate() {
                for (place, to) in self.row[..entries].iter_mut().enumerate() {
                    *to = transform.at(entry + place, k);
                }
                let ends = [Complex64::from(first_end), transform.at_end()[k]];
                let trends = [transform.at(trend, k), transform.at(trend + 1, k)];
                let nuisances = shown(&self.options, i < states, ends, trends);
                for (to, value) in self.row[entries..width - 1].iter_mut().zip(nuisances) {
                    *to = value;
                }
                let factor = if i < states {
                    Complex64::new(-fade, omega)
                } else {
                    Complex64::ONE
                };
                self.row[width - 1] = factor * transform.at(i, k) - transform.at(left + i, k);
                sums.add_complex(&self.row[..width], share);
            }
            entry += entries;
        }
        self.solver.solve(&self.rows);
        self.solver.found(&mut to.values, &mut to.standard_errors);
    }
}

/// 1 and the time are transformed, too.
const TRENDS: usize = 2;

fn subtract(values: &mut [f64], levels: &[f64]) {
    for (value, level) in values.iter_mut().zip(levels) {
        *value -= level;
    }
}

/// What signals do between samples, in the order in which they are transformed: what no input goes into is smooth.
fn between(equations: &Equations, inputs: InputInterpolation) -> Vec<Between> {
    let of = |of_input: bool| match (of_input, inputs) {
        (false, _) => Between::Cubic,
        (true, InputInterpolation::Linear) => Between::Line,
        (true, InputInterpolation::Hold) => Between::Held,
    };
    let rows = &equations.rows;
    let left = rows.iter().map(|_| Between::Cubic);
    let known = rows.iter().map(|row| of(row.of_input));
    let entries = rows.iter().flat_map(|row| &row.entries);
    let entries = entries.map(|entry| of(entry.of_input));
    left.chain(known)
        .chain(entries)
        .chain([Between::Line; TRENDS])
        .collect()
}

/// What is estimated of an equation beside the parameters: the ends of the record, a constant, a straight line.
fn shown(
    options: &FrequencyOptions,
    is_derivative: bool,
    [first, last]: [Complex64; 2],
    [constant, line]: [Complex64; 2],
) -> impl Iterator<Item = Complex64> {
    let ends = is_derivative && options.ends == Ends::Estimated;
    let all = [
        ends.then_some(first),
        ends.then_some(last),
        Some(constant),
        (options.trend == Trend::Linear).then_some(line),
    ];
    all.into_iter().flatten()
}

fn nuisances(options: &FrequencyOptions, is_derivative: bool) -> usize {
    let one = Complex64::ONE;
    shown(options, is_derivative, [one; 2], [one; 2]).count()
}
