//! An extended Kalman filter of states and parameters together: dx = f dt + F dw, dθ = G dw, y = g + v.
//!
//! ```text
//! P⁻ = Φ P Φᵀ/λ + Q,  K = P⁻ Hᵀ (H P⁻ Hᵀ + R)⁻¹,  (x, θ)⁺ = (x, θ)⁻ + K (z - g),  P⁺ = (I - K H) P⁻
//! ```
//!
//! (Jazwinski, Stochastic Processes and Filtering Theory, 1970; Jategaonkar 2015, ch. 7). Φ is the derivative of the integrator's own step, and
//! the gain varies with time. The initial states are functions of θ and begin correlated with it. Outputs are taken in one after the
//! other, about one prediction. The filter linearises once, where it stands, and knows nothing of the error of that: while
//! parameters are far off its bounds are too small.

use super::begin::Begin;
use super::estimates::Estimates;
use super::flow::{Flow, Interval, along};
use super::options::TrackingOptions;
use super::sample::{Sample, SampleFault};
use super::setup::Setup;
use crate::estimate::REACH;
use crate::flight::{Fault, Faults};
use crate::model::{Model, Workspace};
use crate::simulate::{Segment, StateMatrixAt, Steps, Substeps, initial_state};

/// Most integration steps from one sample to the next.
const MOST_STEPS: usize = 64;

pub(super) struct Kalman {
    model: Model,
    tracked: Vec<usize>,
    /// By parameter: its place behind the states.
    column: Vec<Option<usize>>,
    /// By tracked parameter: the least and the most it may be, SI.
    bounds: Vec<[f64; 2]>,
    /// All parameters of the model, SI.
    parameters: Vec<f64>,
    state: Vec<f64>,
    /// P over states, then parameters, row by row.
    covariance: Vec<f64>,
    /// By output: σ², SI.
    noise: Vec<f64>,
    /// By state, then parameter: intensities squared, SI.
    intensities: Vec<f64>,
    forgetting: f64,
    flow: Flow,
    observation: Workspace<f64>,
    slopes: Workspace<f64>,
    /// Integration steps from one sample to the next; none before the second has come.
    steps: Option<usize>,
    first_time: f64,
    last_time: f64,
    inputs: Vec<f64>,
    samples: usize,
    diverged: bool,
    scratch: Scratch,
}

/// What a sample is worked out in.
struct Scratch {
    identity: Vec<f64>,
    tangent: Vec<f64>,
    /// ∂x P.
    product: Vec<f64>,
    outputs: Vec<f64>,
    /// ∂y by states and parameters, row by row.
    rows: Vec<f64>,
    /// P hᵀ.
    gain: Vec<f64>,
    change: Vec<f64>,
}

impl Kalman {
    pub(super) fn new(setup: &Setup, options: &TrackingOptions) -> Result<Self, Faults> {
        let model = setup.model.clone();
        let tracked: Vec<usize> = (0..setup.free.len()).filter(|&i| setup.free[i]).collect();
        let unread = (0..setup.start.len()).filter(|&i| setup.unread[i]);
        let mut faults: Vec<Fault> = unread.map(|i| setup.no_start(i)).collect();
        let begin = Begin {
            setup,
            options,
            tracked: &tracked,
        };
        begin.check_names(&mut faults);
        let noise = begin.noise(&mut faults);
        let intensities = begin.intensities();
        let sizes = begin.uncertainties(&mut faults);
        if !faults.is_empty() {
            return Err(faults.into());
        }
        let n = model.states.len();
        let width = n + tracked.len();
        let mut column = vec![None; model.parameters.len()];
        for (place, &parameter) in tracked.iter().enumerate() {
            column[parameter] = Some(n + place);
        }
        let mut identity = vec![0.0; n * width];
        (0..n).for_each(|i| identity[i * width + i] = 1.0);
        let bounds = tracked.iter().map(|&i| {
            let info = &model.parameters[i];
            let bound =
                |value: Option<f64>, open: f64| value.map_or(open, |value| info.unit.to_si(value));
            [
                bound(info.document.lower, f64::NEG_INFINITY),
                bound(info.document.upper, f64::INFINITY),
            ]
        });
        Ok(Self {
            bounds: bounds.collect(),
            state: initial_state(&model, &setup.start),
            covariance: begin.covariance(&column, width, &sizes),
            parameters: setup.start.clone(),
            noise,
            intensities,
            forgetting: options.forgetting,
            flow: Flow::new(
                &model,
                setup.integrator.stages(),
                setup.input_interpolation,
                &tracked,
            ),
            observation: model.observation.workspace(),
            slopes: model.observation_jacobian.program.workspace(),
            steps: None,
            first_time: f64::NAN,
            last_time: f64::NAN,
            inputs: vec![0.0; model.inputs.len()],
            samples: 0,
            diverged: false,
            scratch: Scratch {
                tangent: identity.clone(),
                product: identity.clone(),
                identity,
                outputs: vec![0.0; model.outputs.len()],
                rows: vec![0.0; model.outputs.len() * width],
                gain: vec![0.0; width],
                change: vec![0.0; width],
            },
            column,
            tracked,
            model,
        })
    }

    pub(super) fn tracked(&self) -> &[usize] {
        &self.tracked
    }

    pub(super) fn check(&self) -> Result<(), SampleFault> {
        match self.diverged {
            true => Err(SampleFault::Diverged),
            false => Ok(()),
        }
    }

    pub(super) fn push(&mut self, sample: &Sample<'_>, to: &mut Estimates) {
        if self.samples == 0 {
            self.first_time = sample.time;
        } else {
            self.predict(sample);
        }
        self.correct(sample);
        self.last_time = sample.time;
        self.inputs.copy_from_slice(sample.inputs);
        self.samples += 1;
        let width = self.width();
        self.diverged = !(self.state.iter().chain(&self.parameters)).all(|value| value.is_finite());
        to.time = sample.time;
        to.samples = self.samples;
        let n = self.state.len();
        for (place, &parameter) in self.tracked.iter().enumerate() {
            let variance = self.covariance[(n + place) * (width + 1)];
            to.values[place] = self.parameters[parameter];
            to.standard_errors[place] = if self.diverged {
                f64::NAN
            } else {
                variance.max(0.0).sqrt()
            };
        }
    }

    fn width(&self) -> usize {
        self.state.len() + self.tracked.len()
    }

    /// To the time of a sample.
    fn predict(&mut self, sample: &Sample<'_>) {
        let length = sample.time - self.last_time;
        let count = self.steps_within(length);
        self.flow.set_parameters(&self.model, &self.parameters);
        let scratch = &mut self.scratch;
        scratch.tangent.copy_from_slice(&scratch.identity);
        let interval = Interval {
            before: &self.inputs,
            after: sample.inputs,
            elapsed: self.last_time - self.first_time,
            length,
            count,
        };
        self.flow.run(
            &self.model,
            &interval,
            &mut self.state,
            &mut scratch.tangent,
        );
        self.spread(length);
    }

    /// P⁻ = Φ P Φᵀ/λ + Q, with Φ = (∂x; 0 I).
    fn spread(&mut self, length: f64) {
        let (n, width) = (self.state.len(), self.width());
        let (p, scratch) = (&mut self.covariance, &mut self.scratch);
        for (row, tangent) in scratch
            .product
            .chunks_exact_mut(width)
            .zip(scratch.tangent.chunks_exact(width))
        {
            row.fill(0.0);
            for (factor, from) in tangent.iter().zip(p.chunks_exact(width)) {
                row.iter_mut()
                    .zip(from)
                    .for_each(|(to, from)| *to += factor * from);
            }
        }
        for i in 0..n {
            let product = &scratch.product[i * width..(i + 1) * width];
            for (j, tangent) in scratch.tangent.chunks_exact(width).enumerate() {
                p[i * width + j] = product.iter().zip(tangent).map(|(a, b)| a * b).sum();
            }
            for j in n..width {
                p[i * width + j] = product[j];
                p[j * width + i] = product[j];
            }
        }
        p.iter_mut().for_each(|value| *value /= self.forgetting);
        for (i, intensity) in self.intensities.iter().enumerate() {
            p[i * width + i] += intensity * length;
        }
    }

    /// Takes in the outputs of a sample, one after the other.
    fn correct(&mut self, sample: &Sample<'_>) {
        self.observe(sample);
        let (n, width) = (self.state.len(), self.width());
        let (p, scratch) = (&mut self.covariance, &mut self.scratch);
        scratch.change.fill(0.0);
        for (output, row) in scratch.rows.chunks_exact(width).enumerate() {
            let measured = sample.outputs[output];
            if !measured.is_finite() {
                continue;
            }
            for (to, p) in scratch.gain.iter_mut().zip(p.chunks_exact(width)) {
                *to = p.iter().zip(row).map(|(p, h)| p * h).sum();
            }
            let dot = |with: &[f64]| -> f64 { row.iter().zip(with).map(|(h, x)| h * x).sum() };
            let variance = dot(&scratch.gain) + self.noise[output];
            let innovation = measured - scratch.outputs[output] - dot(&scratch.change);
            for (i, (change, gain)) in scratch.change.iter_mut().zip(&scratch.gain).enumerate() {
                *change += gain * innovation / variance;
                let row = p[i * width..(i + 1) * width].iter_mut();
                row.zip(&scratch.gain)
                    .for_each(|(p, other)| *p -= gain * other / variance);
            }
        }
        for (state, change) in self.state.iter_mut().zip(&scratch.change) {
            *state += change;
        }
        for (place, &parameter) in self.tracked.iter().enumerate() {
            let [least, most] = self.bounds[place];
            let moved = self.parameters[parameter] + scratch.change[n + place];
            self.parameters[parameter] = moved.clamp(least, most);
        }
    }

    /// Outputs and their derivatives as they are predicted.
    fn observe(&mut self, sample: &Sample<'_>) {
        let (model, width) = (&self.model, self.width());
        let programs = [
            (&model.observation, &mut self.observation),
            (&model.observation_jacobian.program, &mut self.slopes),
        ];
        for (program, workspace) in programs {
            program.set_parameters(workspace, &self.parameters);
            program.states(workspace).copy_from_slice(&self.state);
            program.inputs(workspace).copy_from_slice(sample.inputs);
            *program.time(workspace) = sample.time - self.first_time;
            program.run(workspace);
        }
        let scratch = &mut self.scratch;
        model
            .observation
            .results(&self.observation, &mut scratch.outputs);
        scratch.rows.fill(0.0);
        along(
            &model.observation_jacobian,
            &self.slopes,
            &self.column,
            width,
            &scratch.identity,
            &mut scratch.rows,
        );
    }

    /// Steps that follow the fastest motion at the start values, as long as samples are no farther apart than the first two.
    fn steps_within(&mut self, length: f64) -> usize {
        let (model, parameters) = (&self.model, &self.parameters);
        let (time, inputs) = (self.last_time, &self.inputs);
        *self.steps.get_or_insert_with(|| {
            let segment = Segment {
                label: String::new(),
                time: vec![time],
                steps: Steps::Even(length),
                substeps: Substeps::default(),
                inputs: inputs.iter().map(|&input| vec![input]).collect(),
                measured: Vec::new(),
            };
            let rates = StateMatrixAt::new(model, parameters).rates_at_start(&segment, parameters);
            ((rates.fastest * length / REACH).ceil() as usize).clamp(1, MOST_STEPS)
        })
    }
}
