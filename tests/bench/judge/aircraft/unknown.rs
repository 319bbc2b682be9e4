//! What is in no catalogue: the honest answer is that something is missing, and where.

use std::f64::consts::TAU;

use crate::fault::{Answer, Fault, Sizing};
use crate::force::{Force, Oscillator};
use crate::force_faults::term;
use crate::motion::{Added, Motion, Slot};
use crate::sensor_faults::{later, with_motion};

/// A fault in no catalogue, with the names that are tolerated for it.
fn unknown(
    kind: &'static str,
    place: &str,
    shows_in: &[&str],
    tolerated: &[Answer],
    fault: Fault,
) -> Fault {
    Fault {
        kind,
        name: format!("{kind} {place}"),
        answers: tolerated.to_vec(),
        shows_in: shows_in.iter().map(ToString::to_string).collect(),
        ..fault
    }
}

fn answer(kind: &'static str, target: &str, term: Option<&str>) -> Answer {
    Answer::new(kind, target, term)
}

/// The surface goes no further than this; its size is the inverse of the travel.
pub(super) fn saturation(input: &str, surface: usize, shows_in: &[&str]) -> Fault {
    let of_target = |target: &&str| {
        let terms = [
            format!("{input}*abs({input})"),
            format!("{input}^3"),
            format!("{input}^2"),
        ];
        terms.map(|term| answer("missing_term", target, Some(&term)))
    };
    let tolerated: Vec<Answer> = shows_in.iter().flat_map(of_target).collect();
    let sizing = Sizing::Worth {
        guess: 15.0,
        most: 200.0,
    };
    let fault = Fault::new(
        answer("saturation", input, None),
        sizing,
        move |inverse, _, plant, _| {
            let clipped = move |u: &[f64], _: f64| {
                u.iter()
                    .map(|v| u[0] + (v - u[0]).clamp(-1.0 / inverse, 1.0 / inverse))
                    .collect()
            };
            plant.surfaces.push((surface, Box::new(clipped)));
        },
    );
    unknown("saturation", input, shows_in, &tolerated, fault.positive())
}

fn of_force<F: Force + 'static>(
    kind: &'static str,
    slot: &str,
    guess: f64,
    force: impl Fn(f64) -> F + 'static,
) -> Fault {
    let sizing = Sizing::Worth {
        guess,
        most: 1e3 * guess.abs(),
    };
    Fault::new(
        answer(kind, slot, None),
        sizing,
        move |size, _, plant, _| {
            plant.forces.push(Box::new(force(size)));
        },
    )
}

/// The surface floats with the flow on a soft linkage, and swings.
pub(super) fn hinge_moment(
    slot: Slot,
    target: &str,
    guess: f64,
    seen: impl Fn(&Motion) -> f64 + Clone + 'static,
) -> Fault {
    let tolerated = [answer("unsteady_aero", target, None)];
    let fault = of_force("hinge_moment", target, guess, move |size| Oscillator {
        frequency: 5.0,
        damping: 0.35,
        driven: seen.clone(),
        force: move |place: f64, _: f64, added: &mut Added| added[slot as usize] += size * place,
    });
    unknown("hinge_moment", target, &[target], &tolerated, fault)
}

/// Fuel or a load that swings lightly damped, and pushes with its acceleration.
pub(super) fn slosh(
    slot: Slot,
    target: &str,
    guess: f64,
    seen: impl Fn(&Motion) -> f64 + Clone + 'static,
) -> Fault {
    let fault = of_force("fuel_slosh", target, guess, move |size| Oscillator {
        frequency: 3.2,
        damping: 0.04,
        driven: seen.clone(),
        force: move |_: f64, push: f64, added: &mut Added| {
            added[slot as usize] += size * push / 10.0
        },
    });
    unknown("fuel_slosh", target, &[target], &[], fault)
}

/// Bouc and Wen: z' = s' − (|s'| |z| z + s' z²)/(2 w³)·w, a loop that does not depend on how fast it is run through.
struct Loop<S, R> {
    size: f64,
    slot: Slot,
    seen: S,
    rate: R,
}

/// Half the width of the loop.
const WIDTH: f64 = 0.02;

impl<S: Fn(&Motion) -> f64, R: Fn(&Motion) -> f64> Force for Loop<S, R> {
    fn states(&self) -> usize {
        1
    }
    fn start(&self, _: &Motion) -> Vec<f64> {
        vec![0.0]
    }
    fn act(&self, motion: &Motion, own: &[f64], rates: &mut [f64], added: &mut Added) {
        let (rate, z) = ((self.rate)(motion), own[0] / WIDTH);
        rates[0] = rate - 0.5 * (rate.abs() * z.abs() * z + rate * z * z);
        // the straight part belongs to the declared slope
        added[self.slot as usize] += self.size * (own[0] - 0.3 * (self.seen)(motion));
    }
}

pub(super) fn hysteresis(
    slot: Slot,
    target: &str,
    guess: f64,
    seen: impl Fn(&Motion) -> f64 + Clone + 'static,
    rate: impl Fn(&Motion) -> f64 + Clone + 'static,
) -> Fault {
    let fault = of_force("hysteresis", target, guess, move |size| Loop {
        size,
        slot,
        seen: seen.clone(),
        rate: rate.clone(),
    });
    unknown("hysteresis", target, &[target], &[], fault)
}

/// A moment that wanders with time: fuel that is pumped, people who walk.
pub(super) fn wandering(slot: Slot, target: &str, guess: f64) -> Fault {
    let fault = term(slot, target, "t", guess, |m| {
        (TAU * m.time / 17.0).sin() + m.time / 20.0
    });
    unknown(
        "wandering_cg",
        target,
        &[target],
        &[answer("process_noise", "*", None)],
        fault,
    )
}

/// A force that grows near the ground: with the height over `above`, on a scale of `scale` m.
pub(super) fn ground_effect(
    slot: Slot,
    target: &str,
    channel: &str,
    guess: f64,
    above: f64,
    scale: f64,
) -> Fault {
    let fault = term(slot, target, channel, guess, move |m| {
        (-((m.height - above) / scale)).clamp(-3.0, 3.0).exp()
    });
    let terms = [channel.to_string(), format!("{channel}^2")];
    let tolerated = terms.map(|term| answer("missing_term", target, Some(&term)));
    unknown("ground_effect", target, &[target], &tolerated, fault)
}

/// One channel's clock runs slow: its values come later and later. The size is the share.
pub(super) fn clock_drift(channel: &str) -> Fault {
    let tolerated = [
        answer("sensor_delay", channel, None),
        answer("sensor_lag", channel, None),
    ];
    let sizing = Sizing::Worth {
        guess: 0.01,
        most: 0.1,
    };
    let fault = with_motion("clock_drift", channel, sizing, |share, y, m, step| {
        later(y, |k| share * m[k].time, step)
    });
    unknown(
        "clock_drift",
        channel,
        &[channel],
        &tolerated,
        fault.positive(),
    )
}

/// A vibration of the mount that no control drives; to a model it is noise.
pub(super) fn vibration(channel: &str, guess: f64) -> Fault {
    let sizing = Sizing::Worth {
        guess,
        most: 100.0 * guess,
    };
    let fault = with_motion("vibration", channel, sizing, |size, y, m, _| {
        let swing = |t: f64| size * (1.0 + 0.5 * (0.9 * t).sin()) * (TAU * 4.3 * t).sin();
        y.iter().zip(m).map(|(y, m)| y + swing(m.time)).collect()
    });
    unknown("vibration", channel, &[channel], &[], fault.positive())
}

/// A known effect that one flight alone has.
pub(super) fn in_one_flight(fault: Fault) -> Fault {
    let Fault {
        name,
        answers,
        sizing,
        signed,
        install,
        ..
    } = fault;
    let shows_in = answers.iter().map(|answer| answer.target.clone()).collect();
    Fault {
        known: false,
        kind: "in_one_flight",
        name: format!("in_one_flight {name}"),
        answers,
        shows_in,
        sizing,
        signed,
        install: Box::new(move |size, flight, plant, random| {
            if flight == 0 {
                install(size, flight, plant, random);
            }
        }),
    }
}
