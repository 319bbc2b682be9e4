//! Air that moves, and a start that is not the one the model has.

use std::f64::consts::TAU;

use crate::fault::{Answer, Fault, Sizing};
use crate::motion::Air;
use crate::random::Random;

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Angle {
    Alpha,
    Beta,
}

impl Angle {
    fn turning(self, rate: f64) -> Air {
        match self {
            Self::Alpha => Air {
                alpha_rate: rate,
                ..Air::default()
            },
            Self::Beta => Air {
                beta_rate: rate,
                ..Air::default()
            },
        }
    }
}

/// Turbulence: the angle is turned by a first-order process of 1.5 s; the size is its standard deviation, rad.
pub(crate) fn turbulence(state: &str, angle: Angle) -> Fault {
    const STEP: f64 = 0.005;
    const TIME: f64 = 1.5;
    let answer = Answer::new("process_noise", state, None);
    let sizing = Sizing::Disturbance {
        guess: 0.004,
        most: 0.05,
    };
    let fault = Fault::new(answer, sizing, move |size, _, plant, random| {
        let mut random = Random::new(random.index(1 << 30) as u64, "turbulence");
        let a = (-STEP / TIME).exp();
        let mut flow = vec![0.0];
        for k in 0..20_000 {
            flow.push(a * flow[k] + size * (1.0 - a * a).sqrt() * random.normal());
        }
        plant.air.push(Box::new(move |t| {
            let k = ((t / STEP) as usize).min(flow.len() - 2);
            angle.turning((flow[k + 1] - flow[k]) / STEP)
        }));
    });
    fault.positive()
}

/// One 1 − cos gust in the first flight; the size is its height, rad.
pub(crate) fn gust(state: &str, angle: Angle) -> Fault {
    let answer = Answer::new("gust", state, None);
    let sizing = Sizing::Worth {
        guess: 0.01,
        most: 0.2,
    };
    Fault::new(answer, sizing, move |size, flight, plant, random| {
        let (from, length) = (random.between(6.0, 9.0), random.between(1.0, 2.0));
        if flight == 0 {
            plant.air.push(Box::new(move |t| {
                let s = (t - from) / length;
                let inside = (0.0..1.0).contains(&s);
                let rate = if inside {
                    0.5 * size * TAU / length * (TAU * s).sin()
                } else {
                    0.0
                };
                angle.turning(rate)
            }));
        }
    })
}

/// The flight does not begin where the model holds it.
pub(crate) fn initial_state(state: &str, place: usize, guess: f64) -> Fault {
    let answer = Answer::new("initial_state", state, None);
    let sizing = Sizing::Worth {
        guess,
        most: 50.0 * guess,
    };
    Fault::new(answer, sizing, move |size, _, plant, _| {
        plant.displaced.push((place, size))
    })
}
