//! The catalog's 28-parameter flight path reconstruction on simulated data of known truth.
//!
//! Profiles of airspeed, flow angles and attitude are prescribed (straight flight, steep turn and reversal, pitch
//! 3-2-1-1, rudder doublets, bank to bank, in 60 s); the kinematic equations give the rates and specific forces that
//! belong to them; those, sampled and with the sensors' errors, are the inputs. The truth is the model's own answer to
//! these inputs at a tenth of the sampling step, so that all that the estimation does not know is white output noise.

use std::sync::Arc;

use indexmap::IndexMap;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use trimtab_core::flight::{Channel, Maneuver, Unit};
use trimtab_core::model::{Model, ModelDocument, catalog};
use trimtab_core::simulate::{InputInterpolation, Integrator, Segment, Steps, Substeps, simulate};

const STEP: f64 = 0.05;
const SAMPLES: usize = 1200;
const SUBSTEPS: usize = 10;
const G: f64 = 9.80665;

/// Standard deviation of the noise of each output, SI.
pub(crate) const NOISE: [f64; 6] = [3.0e-3, 3.0e-3, 0.30, 1.0, 1.0, 1.5];

pub(crate) fn document() -> ModelDocument {
    catalog::find("flight-path-reconstruction").expect("a catalog model")
}

/// A maneuver without noise, to which each seed adds its own.
pub(crate) struct Truth {
    pub parameters: IndexMap<String, f64>,
    model: Model,
    inputs: Vec<Vec<f64>>,
    outputs: Vec<Vec<f64>>,
}

/// V, alpha, beta, phi, theta
fn profile(t: f64) -> [f64; 5] {
    let between = |from: f64, to: f64, rise: f64| {
        0.5 * (((t - from) / rise).tanh() - ((t - to) / rise).tanh())
    };
    let wave = |period: f64, phase: f64| (std::f64::consts::TAU * t / period + phase).sin();
    let on = between(1.5, 58.5, 0.5);
    let speed = 77.0 + on * (6.0 * wave(30.0, 0.4) + 2.5 * wave(11.0, 2.0));
    let climb = 0.05 * on * wave(25.0, 1.2);
    let turns = 0.75 * between(7.0, 22.0, 0.8) - 0.65 * between(26.0, 36.0, 0.8);
    let banks = 0.45 * (between(51.0, 53.5, 0.5) - between(53.5, 56.0, 0.5));
    let phi = 0.03 + turns + banks;
    let pull = 2.6 * between(7.0, 22.0, 0.9) + 2.0 * between(26.0, 36.0, 0.9);
    let pitch = between(39.0, 41.1, 0.25) - between(41.1, 42.5, 0.25) + between(42.5, 43.2, 0.2)
        - between(43.2, 43.9, 0.2);
    let alpha = (5.0 + pull + 2.2 * pitch).to_radians();
    let doublets = 3.0 * (between(45.5, 47.7, 0.6) - between(47.7, 49.9, 0.6))
        + 2.0 * (between(13.0, 15.2, 0.6) - between(15.2, 17.4, 0.6));
    let beta = doublets.to_radians();
    [speed, alpha, beta, phi, alpha * phi.cos() + climb]
}

fn velocity(t: f64) -> [f64; 3] {
    let [speed, alpha, beta, ..] = profile(t);
    [
        speed * alpha.cos() * beta.cos(),
        speed * beta.sin(),
        speed * alpha.sin() * beta.cos(),
    ]
}

/// Specific forces and rates that fly the profile in coordinated turns.
fn flown(t: f64) -> [f64; 6] {
    let h = 1e-4;
    let slope = |value: &dyn Fn(f64) -> f64| (value(t + h) - value(t - h)) / (2.0 * h);
    let [speed, _, _, phi, theta] = profile(t);
    let [u, v, w] = velocity(t);
    let [du, dv, dw] = [0, 1, 2].map(|i| slope(&|t| velocity(t)[i]));
    let (dphi, dtheta) = (slope(&|t| profile(t)[3]), slope(&|t| profile(t)[4]));
    let turn = G * phi.tan() / speed;
    let p = dphi - turn * theta.sin();
    let q = dtheta * phi.cos() + turn * theta.cos() * phi.sin();
    let r = -dtheta * phi.sin() + turn * theta.cos() * phi.cos();
    [
        du + G * theta.sin() - r * v + q * w,
        dv - G * phi.sin() * theta.cos() - p * w + r * u,
        dw - G * phi.cos() * theta.cos() - q * u + p * v,
        p,
        q,
        r,
    ]
}

impl Truth {
    pub(crate) fn new() -> Self {
        let [_, _, _, phi, theta] = profile(0.0);
        let [u, v, w] = velocity(0.0);
        let parameters = [
            ("ax_bias", 0.08),
            ("ay_bias", -0.05),
            ("az_bias", 0.12),
            ("p_bias", 1.2e-3),
            ("q_bias", -0.9e-3),
            ("r_bias", 0.7e-3),
            ("alpha_bias", 0.012),
            ("beta_bias", -0.010),
            ("K_alpha", 0.08),
            ("K_beta_alpha", 0.03),
            ("K_beta", -0.05),
            ("V_bias", -0.8),
            ("K_V", 1.02),
            ("W_x", 4.0),
            ("W_y", -3.0),
            ("W_z", 0.2),
            ("x_bias", 0.0),
            ("y_bias", 0.0),
            ("z_bias", 0.0),
            ("u_0", u),
            ("v_0", v),
            ("w_0", w),
            ("phi_0", phi),
            ("theta_0", theta),
            ("psi_0", 0.7),
            ("x_0", 120.0),
            ("y_0", -80.0),
            ("z_0", -2000.0),
        ];
        let parameters: IndexMap<String, f64> = parameters
            .map(|(name, value)| (name.to_string(), value))
            .into();
        let value = |name: &str| parameters[name];
        let recorded = |k: usize| {
            let [ax, ay, az, p, q, r] = flown(k as f64 * STEP);
            [
                ax + value("ax_bias"),
                ay + value("ay_bias"),
                az + value("az_bias"),
                p + value("p_bias"),
                q + value("q_bias"),
                r + value("r_bias"),
            ]
        };
        let samples: Vec<[f64; 6]> = (0..SAMPLES).map(recorded).collect();
        let inputs: Vec<Vec<f64>> = (0..6)
            .map(|i| samples.iter().map(|sample| sample[i]).collect())
            .collect();
        let model = Model::compile(&document()).unwrap_or_else(|faults| panic!("{faults:#?}"));
        let all: Vec<f64> = model.parameters.iter().map(|p| value(&p.name)).collect();
        let outputs = answer(&model, &inputs, &all);
        Self {
            parameters,
            model,
            inputs,
            outputs,
        }
    }

    /// The recording with the noise of a seed, times `share`.
    pub(crate) fn recording(&self, seed: u64, share: f64) -> Arc<Maneuver> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut channels = IndexMap::new();
        let mut add = |name: &str, unit: &str, values: Vec<f64>| {
            let unit_of = Unit::parse(unit).expect("a unit");
            let channel = Channel::from_recorded(unit, unit_of, values);
            channels.insert(name.to_string(), channel);
        };
        for (input, values) in self.model.inputs.iter().zip(&self.inputs) {
            add(&input.name, &input.si, values.clone());
        }
        let outputs = self.model.outputs.iter().zip(&self.outputs);
        for ((output, values), deviation) in outputs.zip(NOISE) {
            let noisy = values.iter().map(|y| {
                let unit: f64 = StandardNormal.sample(&mut random);
                y + share * deviation * unit
            });
            add(&output.name, &output.si, noisy.collect());
        }
        let time = (0..SAMPLES).map(|k| k as f64 * STEP).collect();
        Arc::new(Maneuver::new(time, channels).expect("a maneuver"))
    }
}

/// Outputs at the samples, integrated with a tenth of their step.
fn answer(model: &Model, inputs: &[Vec<f64>], parameters: &[f64]) -> Vec<Vec<f64>> {
    let fine = (SAMPLES - 1) * SUBSTEPS + 1;
    let between = |samples: &Vec<f64>| -> Vec<f64> {
        let at = |i: usize| {
            let (k, share) = (i / SUBSTEPS, (i % SUBSTEPS) as f64 / SUBSTEPS as f64);
            samples[k] + share * (samples[(k + 1).min(SAMPLES - 1)] - samples[k])
        };
        (0..fine).map(at).collect()
    };
    let step = STEP / SUBSTEPS as f64;
    let segment = Segment {
        label: String::new(),
        time: (0..fine).map(|i| i as f64 * step).collect(),
        steps: Steps::Even(step),
        substeps: Substeps::default(),
        inputs: inputs.iter().map(between).collect(),
        measured: Vec::new(),
    };
    let mut outputs = vec![Vec::with_capacity(SAMPLES); model.outputs.len()];
    let (rk4, linear) = (Integrator::Rk4, InputInterpolation::Linear);
    simulate(model, rk4, linear, &segment, parameters, |i, y: &[f64]| {
        if i.is_multiple_of(SUBSTEPS) {
            let series = outputs.iter_mut().zip(y);
            series.for_each(|(series, &y)| series.push(y));
        }
    });
    outputs
}
