//! The aircraft: equations of motion, a declared model in words of its own, flights, and what may be wrong with them.

mod body_axes;
mod canard;
mod lateral;
mod longitudinal;
mod maneuvers;
mod reconstruction;
mod rotorcraft;
mod short_period;
mod six;
mod unknown;

use crate::fault::Fault;
use crate::fly::Sortie;
use crate::motion::Airframe;
use crate::random::Random;
use crate::record::Channel;
use crate::replay::Replay;

/// One aircraft as one seed has it: numbers differ from seed to seed, names and faults do not.
pub(crate) struct Aircraft {
    pub frame: Box<dyn Airframe>,
    /// The declared model, in TOML.
    pub document: String,
    pub channels: Vec<Channel>,
    pub sorties: Vec<Sortie>,
    /// s between samples
    pub sample: f64,
    pub faults: Vec<Fault>,
}

/// How an aircraft is made for a case.
pub(crate) type Make = fn(&mut Random, Option<&Replay>) -> Aircraft;

pub(crate) struct Kind {
    pub name: &'static str,
    pub make: Make,
    /// The judge's names, and those that the catalog's models have.
    pub usual: &'static [(&'static str, &'static str)],
}

pub(crate) const ALL: [Kind; 8] = [
    Kind {
        name: "short-period",
        make: short_period::make,
        usual: short_period::USUAL,
    },
    Kind {
        name: "sideslip-driven",
        make: lateral::driven,
        usual: lateral::USUAL,
    },
    Kind {
        name: "lateral",
        make: lateral::four_states,
        usual: lateral::USUAL,
    },
    Kind {
        name: "longitudinal",
        make: longitudinal::make,
        usual: longitudinal::USUAL,
    },
    Kind {
        name: "reconstruction",
        make: reconstruction::make,
        usual: reconstruction::USUAL,
    },
    Kind {
        name: "body-axes",
        make: body_axes::make,
        usual: body_axes::USUAL,
    },
    Kind {
        name: "canard",
        make: canard::make,
        usual: canard::USUAL,
    },
    Kind {
        name: "rotorcraft",
        make: rotorcraft::make,
        usual: rotorcraft::USUAL,
    },
];

/// Those of the catalogue of effects, then those of none.
fn both(known: Vec<Fault>, unknown: Vec<Fault>) -> Vec<Fault> {
    let unknown = unknown.into_iter().map(|fault| Fault {
        known: false,
        ..fault
    });
    known.into_iter().chain(unknown).collect()
}
