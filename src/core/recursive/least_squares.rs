//! Recursive least squares of the state equations, with exponential forgetting.
//!
//! States, inputs and outputs pass a local cubic (Savitzky and Golay), which gives the derivatives of the states, too; an estimate is late by half
//! its window. The sums of regressors are kept, not the inverse of their matrix, so that nothing needs to be invented to begin with, and
//! nothing drifts away (Ljung, System Identification, ch. 11; Klein and Morelli, Aircraft System Identification, ch. 8).

use super::equations::Equations;
use super::estimates::Estimates;
use super::options::TrackingOptions;
use super::sample::Sample;
use super::setup::Setup;
use super::solver::Solver;
use super::sums::Sums;
use super::window::Window;
use crate::flight::Faults;
use crate::simulate::InputInterpolation;

/// What is left of a difference of like numbers, as a share of the largest signal, that is nothing to rounding.
const ROUNDING: f64 = 1e-14;

pub(super) struct LeastSquares {
    equations: Equations,
    window: Window,
    rows: Vec<Sums>,
    solver: Solver,
    held: bool,
    /// The inputs of the sample before, where inputs are held.
    before: Option<Vec<f64>>,
    first_time: f64,
    used: usize,
    signals: Vec<f64>,
    slopes: Vec<f64>,
    known: Vec<f64>,
    regressors: Vec<f64>,
    row: Vec<f64>,
}

impl LeastSquares {
    pub(super) fn new(setup: &Setup, options: &TrackingOptions) -> Result<Self, Faults> {
        let equations = Equations::new(setup)?;
        let constants = equations.rows.iter().filter(|row| row.constant).count();
        let mut next = 0;
        // the noise of one sample is in the smoothed states of all windows that have it
        let lags = 2 * (2 * options.half_width + 1);
        let rows = equations.rows.iter().map(|row| {
            let entries = row.entries.iter();
            let mut own: Vec<usize> = entries.map(|entry| constants + entry.column).collect();
            if row.constant {
                own.push(next);
                next += 1;
            }
            Sums::new(own, lags, options.forgetting)
        });
        let rows: Vec<Sums> = rows.collect();
        let signals = equations.signals();
        let widest = rows.iter().map(Sums::width).max().unwrap_or(1);
        Ok(Self {
            solver: Solver::new(constants, equations.tracked.len(), &rows),
            window: Window::new(options.half_width, signals),
            held: setup.input_interpolation == InputInterpolation::Hold,
            before: None,
            first_time: f64::NAN,
            used: 0,
            signals: vec![0.0; signals],
            slopes: vec![0.0; signals],
            known: vec![0.0; rows.len()],
            regressors: vec![0.0; equations.entries()],
            row: vec![0.0; widest],
            rows,
            equations,
        })
    }

    pub(super) fn tracked(&self) -> &[usize] {
        &self.equations.tracked
    }

    pub(super) fn push(&mut self, sample: &Sample<'_>, to: &mut Estimates) {
        if self.first_time.is_nan() {
            self.first_time = sample.time;
        }
        let elapsed = sample.time - self.first_time;
        let was_full = self.window.is_full();
        self.equations.read(sample, elapsed, &mut self.signals);
        self.hold();
        self.window.push(sample.time, self.signals.iter().copied());
        if !self.window.is_full() {
            return;
        }
        let middle = self.window.middle();
        // the samples before the first middle lean on the same window
        let places = if was_full {
            middle..middle + 1
        } else {
            0..middle + 1
        };
        self.take(places, to);
    }

    /// The samples behind the last middle, which lean on the last window.
    pub(super) fn finish(&mut self, to: &mut Estimates) {
        if self.window.is_full() {
            self.take(self.window.middle() + 1..self.window.len(), to);
        }
    }

    /// A held input as it acts around a sample: the mean of what is held before and after.
    fn hold(&mut self) {
        if !self.held {
            return;
        }
        let count = self.equations.inputs();
        let before = self
            .before
            .get_or_insert_with(|| self.signals[..count].to_vec());
        for (before, now) in before.iter_mut().zip(&mut self.signals) {
            let own = *now;
            *now = 0.5 * (*before + own);
            *before = own;
        }
    }

    fn take(&mut self, places: std::ops::Range<usize>, to: &mut Estimates) {
        for place in places {
            if self
                .window
                .smoothed(place, &mut self.signals, &mut self.slopes)
            {
                self.add(self.window.time(place) - self.first_time);
                self.used += 1;
            }
            to.time = self.window.time(place);
        }
        if self.used == 0 {
            return;
        }
        self.solver.solve(&self.rows);
        to.samples = self.used;
        self.solver.found(&mut to.values, &mut to.standard_errors);
    }

    fn add(&mut self, elapsed: f64) {
        let (inputs, states) = (self.equations.inputs(), self.equations.states());
        self.equations.evaluate(
            &self.signals,
            elapsed,
            &mut self.known,
            &mut self.regressors,
        );
        let largest = (self.signals.iter()).fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let mut next = self.regressors.iter();
        for (i, (row, sums)) in self.equations.rows.iter().zip(&mut self.rows).enumerate() {
            let width = sums.width();
            let entries = row.entries.len();
            for to in &mut self.row[..entries] {
                let value = next.next().copied().unwrap_or(0.0);
                // a surface that is held less its trim value
                *to = if value.abs() > ROUNDING * largest {
                    value
                } else {
                    0.0
                };
            }
            if row.constant {
                self.row[entries] = 1.0;
            }
            let measured = if i < states {
                self.slopes[inputs + i]
            } else {
                self.signals[inputs + i]
            };
            self.row[width - 1] = measured - self.known[i];
            sums.add(&self.row[..width]);
        }
    }
}
