//! Aerodynamics that the declared model leaves out.

use crate::fault::{Answer, Fault, Sizing};
use crate::force::{Lagged, Term};
use crate::motion::{Added, Motion, Slot};

/// ψ · term in an equation. `guess` is a size in the equation's own unit.
pub(crate) fn term(
    slot: Slot,
    target: &str,
    written: &str,
    guess: f64,
    of: impl Fn(&Motion) -> f64 + Clone + 'static,
) -> Fault {
    let answer = Answer::new("missing_term", target, Some(written));
    let sizing = Sizing::Worth {
        guess,
        most: 1e3 * guess,
    };
    Fault::new(answer, sizing, move |size, _, plant, _| {
        let of = of.clone();
        let act = move |m: &Motion, added: &mut Added| added[slot as usize] += size * of(m);
        plant.forces.push(Box::new(Term(act)));
    })
}

/// A recorded channel that the model does not use.
pub(crate) fn unrecorded(
    slot: Slot,
    target: &str,
    channel: &str,
    surface: usize,
    guess: f64,
) -> Fault {
    let fault = term(slot, target, channel, guess, move |m| m.surface[surface]);
    Fault {
        kind: "unrecorded_input",
        name: format!("unrecorded_input {channel} in {target}"),
        answers: vec![
            Answer::new("unrecorded_input", target, Some(channel)),
            Answer::new("unrecorded_input", target, Some(&format!("{channel}[rad]"))),
            Answer::new("unrecorded_input", target, Some(&format!("{channel}[deg]"))),
            Answer::new("missing_term", target, Some(channel)),
        ],
        ..fault
    }
}

/// ψ (angle − w), T ẇ = angle − w.
pub(crate) fn unsteady(
    slot: Slot,
    target: &str,
    angle: &str,
    guess: f64,
    of: impl Fn(&Motion) -> f64 + Clone + 'static,
) -> Fault {
    let answer = Answer::new("unsteady_aero", target, Some(angle));
    let sizing = Sizing::Worth {
        guess,
        most: 1e2 * guess,
    };
    let fault = Fault::new(answer, sizing, move |size, _, plant, _| {
        let force = move |now: f64, behind: f64, added: &mut Added| {
            added[slot as usize] += size * (now - behind);
        };
        plant.forces.push(Box::new(Lagged {
            time: 0.35,
            seen: of.clone(),
            force,
        }));
    });
    fault.or("missing_term", target, Some(&format!("{angle}dot")))
}

/// A linear airframe whose derivatives follow the dynamic pressure while the speed changes: the size is the share.
pub(crate) fn pressure(term: &str) -> Fault {
    let answer = Answer::new("missing_term", "all", Some(term));
    let sizing = Sizing::Worth {
        guess: 0.06,
        most: 0.3,
    };
    Fault::new(answer, sizing, move |size, _, plant, _| {
        plant.slows_by = Some(size)
    })
    .positive()
}

/// Stall: a point of separation that follows the angle of attack late, and what is lost with it.
pub(crate) fn stall(
    targets: &str,
    angle: &str,
    break_angle: f64,
    lost: impl Fn(f64, &Motion, &mut Added) + Clone + 'static,
) -> Fault {
    let answer = Answer::new("stall_hysteresis", targets, Some(angle));
    let sizing = Sizing::Worth {
        guess: 0.3,
        most: 30.0,
    };
    let attached =
        move |m: &Motion| 0.5 * (1.0 - (25.0 * (m.alpha - 0.15 * m.alphadot - break_angle)).tanh());
    let mut fault = Fault::new(answer, sizing, move |size, _, plant, _| {
        let lost = lost.clone();
        let seen = attached;
        plant.forces.push(Box::new(Stalled {
            time: 0.25,
            seen,
            size,
            lost,
        }));
    })
    .positive();
    for other in [
        "CL",
        "CL+Cm",
        "CL+CD",
        "CL+CD+Cm",
        "AoA+pitchrate",
        "AoA",
        "pitchrate",
    ] {
        fault = fault.or("stall_hysteresis", other, Some(angle));
    }
    fault
}

struct Stalled<S, L> {
    time: f64,
    seen: S,
    size: f64,
    lost: L,
}

impl<S: Fn(&Motion) -> f64, L: Fn(f64, &Motion, &mut Added)> crate::force::Force for Stalled<S, L> {
    fn states(&self) -> usize {
        1
    }
    fn start(&self, motion: &Motion) -> Vec<f64> {
        vec![(self.seen)(motion)]
    }
    fn act(&self, motion: &Motion, own: &[f64], rates: &mut [f64], added: &mut Added) {
        rates[0] = ((self.seen)(motion) - own[0]) / self.time;
        (self.lost)(self.size * (1.0 - own[0]), motion, added);
    }
}
