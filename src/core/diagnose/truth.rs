//! Flights of known truth for tests: equations of motion in closures, integrated here at a tenth of the sampling step
//! from inputs that are continuous. Nothing of it is shared with what is tested.

use indexmap::IndexMap;

use crate::diagnose::{Case, Flight, Knowledge};
use crate::estimate::{Options, Role};
use crate::flight::Unit;
use crate::model::ModelDocument;
use crate::simulate::Steps;

/// ẋ = f(x, u, t, flight)
pub(in crate::diagnose) type Motion<'a> = &'a dyn Fn(&[f64], &[f64], f64, usize) -> Vec<f64>;
/// y = g(x, u, t)
pub(in crate::diagnose) type Sensors<'a> = &'a dyn Fn(&[f64], &[f64], f64) -> Vec<f64>;

/// Noise of lag-1 autocorrelation `colour`, by output of these standard deviations.
#[derive(Clone, Debug)]
pub(in crate::diagnose) struct Noise {
    pub colour: f64,
    pub deviations: Vec<f64>,
}

pub(in crate::diagnose) struct Truth<'a> {
    pub document: ModelDocument,
    pub start: Vec<f64>,
    pub motion: Motion<'a>,
    pub sensors: Sensors<'a>,
    /// u(t, flight)
    pub inputs: &'a dyn Fn(f64, usize) -> Vec<f64>,
    pub noise: Noise,
    pub seconds: f64,
    pub step: f64,
}

/// Uniform numbers from a small generator.
pub(in crate::diagnose) struct Chance(pub u64);

impl Chance {
    pub(in crate::diagnose) fn uniform(&mut self) -> f64 {
        self.0 = (self.0)
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Standard normal, as good as twelve uniform ones make it.
    pub(in crate::diagnose) fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

impl Truth<'_> {
    /// A case of flights in these roles.
    pub(in crate::diagnose) fn fly(&self, roles: &[Role], seed: u64) -> Case {
        let mut chance = Chance(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) + 1);
        (0..20).for_each(|_| {
            chance.uniform();
        });
        let flights = roles.iter().enumerate();
        Case {
            document: self.document.clone(),
            flights: flights
                .map(|(index, &role)| self.flight(index, role, &mut chance))
                .collect(),
            options: Options::default(),
            candidates: Vec::new(),
            knowledge: Knowledge::default(),
            consumed: Vec::new(),
        }
    }

    fn flight(&self, index: usize, role: Role, chance: &mut Chance) -> Flight {
        const FINER: usize = 10;
        let samples = (self.seconds / self.step).round() as usize + 1;
        let h = self.step / FINER as f64;
        let rate = |x: &[f64], t: f64| (self.motion)(x, &(self.inputs)(t, index), t, index);
        let mut x = self.start.clone();
        let (mut inputs, mut outputs, mut time) = (Vec::new(), Vec::new(), Vec::new());
        let mut noise: Vec<f64> = Vec::new();
        let Noise { colour, deviations } = &self.noise;
        for k in 0..samples {
            let t = k as f64 * self.step;
            let u = (self.inputs)(t, index);
            let fresh = deviations.iter().map(|sigma| sigma * chance.normal());
            noise = if k == 0 {
                fresh.collect()
            } else {
                let share = (1.0 - colour * colour).sqrt();
                (fresh.zip(&noise))
                    .map(|(w, e)| colour * e + share * w)
                    .collect()
            };
            let clean = (self.sensors)(&x, &u, t);
            outputs.push(
                clean
                    .iter()
                    .zip(&noise)
                    .map(|(y, e)| y + e)
                    .collect::<Vec<f64>>(),
            );
            inputs.push(u);
            time.push(t);
            for fine in 0..FINER {
                let t = t + fine as f64 * h;
                let ahead = |k: &[f64], by: f64| -> Vec<f64> {
                    x.iter().zip(k).map(|(x, k)| x + by * k).collect()
                };
                let k1 = rate(&x, t);
                let k2 = rate(&ahead(&k1, 0.5 * h), t + 0.5 * h);
                let k3 = rate(&ahead(&k2, 0.5 * h), t + 0.5 * h);
                let k4 = rate(&ahead(&k3, h), t + h);
                for i in 0..x.len() {
                    x[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
                }
            }
        }
        let channel = |rows: &[Vec<f64>], at: usize, unit: &str| {
            let dimension = Unit::parse(unit).unwrap().dimension;
            (rows.iter().map(|row| row[at]).collect(), dimension)
        };
        let document = &self.document;
        let mut channels: IndexMap<String, _> = IndexMap::new();
        for (at, (name, input)) in document.inputs.iter().enumerate() {
            channels.insert(name.clone(), channel(&inputs, at, &input.unit));
        }
        for (at, (name, output)) in document.outputs.iter().enumerate() {
            channels.insert(name.clone(), channel(&outputs, at, &output.unit));
        }
        Flight {
            label: ["A", "B", "C", "D"][index].to_string(),
            role,
            time,
            steps: Steps::Even(self.step),
            channels,
            own: IndexMap::new(),
        }
    }
}

/// Steps one after another, each reached smoothly within 0.3 s: (begin, end, size).
pub(in crate::diagnose) fn steps(t: f64, all: &[(f64, f64, f64)]) -> f64 {
    let reached = |since: f64| {
        let share = (since / 0.3).clamp(0.0, 1.0);
        share * share * (3.0 - 2.0 * share)
    };
    all.iter()
        .map(|&(begin, end, size)| size * (reached(t - begin) - reached(t - end)))
        .sum()
}

/// An elevator about -0.03 rad that moves in all of three maneuvers, in each otherwise.
pub(in crate::diagnose) fn elevator(t: f64, flight: usize) -> Vec<f64> {
    let size = [0.05, -0.045, 0.06][flight];
    let t = t - [0.0, 0.7, 0.3][flight];
    let moves = [
        (2.5, 4.0, size),
        (4.0, 5.0, -size),
        (5.0, 5.5, size),
        (5.5, 6.0, -size),
        (11.0, 12.0, 0.7 * size),
        (12.0, 13.0, -0.7 * size),
        (17.0, 19.5, 0.5 * size),
    ];
    vec![-0.03 + steps(t, &moves)]
}
