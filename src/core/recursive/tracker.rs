//! A tracker: one sample in, estimates out.

use super::estimates::{Estimates, TrackedParameter};
use super::fourier::Fourier;
use super::kalman::Kalman;
use super::least_squares::LeastSquares;
use super::options::{TrackingMethod, TrackingOptions};
use super::sample::{Sample, SampleFault};
use super::setup::Setup;
use crate::flight::{Faults, Unit};

/// Follows the parameters of a model while samples come in.
pub struct Tracker {
    method: Method,
    parameters: Vec<TrackedParameter>,
    units: Vec<Unit>,
    inputs: Vec<String>,
    outputs: usize,
    last_time: f64,
    /// SI.
    found: Estimates,
    /// In the parameters' own units.
    shown: Estimates,
}

enum Method {
    LeastSquares(Box<LeastSquares>),
    Fourier(Box<Fourier>),
    Kalman(Box<Kalman>),
}

impl Tracker {
    /// Begins.
    ///
    /// # Errors
    /// What the method cannot do with the model, or an option that is out of range: all of them, with places in the
    /// options, or in the model behind `/model`.
    pub fn new(setup: &Setup, options: &TrackingOptions) -> Result<Self, Faults> {
        let faults = options.faults();
        if !faults.is_empty() {
            return Err(faults.into());
        }
        setup.check()?;
        let method = match options.method {
            TrackingMethod::Rls => {
                Method::LeastSquares(Box::new(LeastSquares::new(setup, options)?))
            }
            TrackingMethod::Rft => Method::Fourier(Box::new(Fourier::new(setup, options)?)),
            TrackingMethod::Ekf => Method::Kalman(Box::new(Kalman::new(setup, options)?)),
        };
        let tracked = method.tracked();
        let infos = || tracked.iter().map(|&i| &setup.model.parameters[i]);
        let parameters = infos().map(|info| TrackedParameter {
            name: info.name.clone(),
            unit: info.document.unit.clone(),
        });
        Ok(Self {
            parameters: parameters.collect(),
            units: infos().map(|info| info.unit).collect(),
            inputs: (setup.model.inputs.iter())
                .map(|input| input.name.clone())
                .collect(),
            outputs: setup.model.outputs.len(),
            last_time: f64::NEG_INFINITY,
            found: Estimates::none(tracked.len()),
            shown: Estimates::none(tracked.len()),
            method,
        })
    }

    /// The parameters that are followed, in the order of all estimates.
    pub fn parameters(&self) -> &[TrackedParameter] {
        &self.parameters
    }

    /// Takes in a sample, SI, and says what is known after it.
    ///
    /// # Errors
    /// It cannot be taken: nothing has changed.
    pub fn push(&mut self, sample: &Sample<'_>) -> Result<&Estimates, SampleFault> {
        self.check(sample)?;
        self.last_time = sample.time;
        match &mut self.method {
            Method::LeastSquares(method) => method.push(sample, &mut self.found),
            Method::Fourier(method) => method.push(sample, &mut self.found),
            Method::Kalman(method) => method.push(sample, &mut self.found),
        }
        Ok(self.show())
    }

    /// Takes in what waits for samples that will not come: those behind the middle of the last window.
    pub fn finish(&mut self) -> &Estimates {
        if let Method::LeastSquares(method) = &mut self.method {
            method.finish(&mut self.found);
        }
        self.show()
    }

    /// What is known now.
    pub fn estimates(&self) -> &Estimates {
        &self.shown
    }

    fn check(&self, sample: &Sample<'_>) -> Result<(), SampleFault> {
        let widths = [
            ("inputs", sample.inputs.len(), self.inputs.len()),
            ("outputs", sample.outputs.len(), self.outputs),
        ];
        for (what, found, wanted) in widths {
            if found != wanted {
                return Err(SampleFault::Width {
                    what,
                    found,
                    wanted,
                });
            }
        }
        if !sample.time.is_finite() {
            return Err(SampleFault::NoTime);
        }
        if sample.time <= self.last_time {
            return Err(SampleFault::NotLater {
                time: sample.time,
                before: self.last_time,
            });
        }
        if let Some(input) = sample.inputs.iter().position(|input| !input.is_finite()) {
            let name = self.inputs[input].clone();
            return Err(SampleFault::NoInput { name });
        }
        match &self.method {
            Method::LeastSquares(_) => Ok(()),
            Method::Fourier(method) => method.check(sample),
            Method::Kalman(method) => method.check(),
        }
    }

    fn show(&mut self) -> &Estimates {
        self.shown.time = self.found.time;
        self.shown.samples = self.found.samples;
        for (i, unit) in self.units.iter().enumerate() {
            self.shown.values[i] = unit.from_si(self.found.values[i]);
            self.shown.standard_errors[i] = self.found.standard_errors[i] / unit.scale;
        }
        &self.shown
    }
}

impl Method {
    fn tracked(&self) -> &[usize] {
        match self {
            Self::LeastSquares(method) => method.tracked(),
            Self::Fourier(method) => method.tracked(),
            Self::Kalman(method) => method.tracked(),
        }
    }
}
