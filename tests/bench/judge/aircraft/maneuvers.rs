//! Flights of an aircraft: which controls move, when and how.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::fly::Sortie;
use crate::inputs::{Command, Given, Shape, command, still};
use crate::motion::{SURFACES, Scene};
use crate::random::Random;
use crate::replay::Replay;

/// A control that a maneuver moves.
#[derive(Clone, Copy)]
pub(crate) struct Control {
    pub surface: usize,
    /// rad, or what else it is measured in
    pub amplitude: f64,
    /// Half of a usual doublet, s.
    pub unit: f64,
    /// Whether a maneuver is flown with it; others only move a little along.
    pub leads: bool,
}

/// Steps between samples that recorders have.
pub(crate) fn sample(random: &mut Random) -> f64 {
    [0.04, 0.02, 0.04, 0.025, 0.05, 0.02, 0.01][random.index(7)]
}

/// Two to four maneuvers of `least` to `most` seconds, at least one of them for validation.
pub(crate) fn sorties(
    controls: &[Control],
    [least, most]: [f64; 2],
    scene: impl Fn(&mut Random) -> Scene,
    random: &mut Random,
    replay: Option<&Replay>,
) -> Vec<Sortie> {
    let leads: Vec<usize> = (0..controls.len()).filter(|i| controls[*i].leads).collect();
    // every control that leads does so in a flight that is fitted
    let fitted = leads.len().max(1 + random.index(2)).min(2);
    let count = (fitted + 1 + random.index(2)).min(4);
    (0..count)
        .map(|number| {
            let lead = leads[number % leads.len()];
            let duration = random.between(least, most);
            let mut commands: [Command; SURFACES] = std::array::from_fn(|_| still());
            let both = leads.len() > 1 && (fitted == 1 || random.chance(0.5));
            for (i, control) in controls.iter().enumerate() {
                let leads_here = i == lead || (both && control.leads);
                let shape = if leads_here {
                    Shape::ALL[random.index(Shape::ALL.len())]
                } else {
                    Shape::Pilot
                };
                let start = if i == lead {
                    random.between(1.0, 2.0)
                } else {
                    random.between(2.5, 5.0)
                };
                let share = if leads_here {
                    random.between(0.7, 1.1)
                } else {
                    0.15
                };
                let given = Given {
                    shape,
                    start,
                    duration,
                    unit: control.unit,
                    amplitude: share * control.amplitude * random.sign(),
                    replay,
                    control: control.surface,
                };
                commands[control.surface] = command(&given, random);
            }
            let fitted = number < fitted;
            let role = if fitted { "fit" } else { "check" };
            Sortie {
                label: format!("{role} {}", number + 1),
                fitted,
                duration,
                commands,
                scene: scene(random),
            }
        })
        .collect()
}

/// Some slow motion about a mean, by a few sines.
pub(crate) fn wander(mean: f64, by: f64, random: &mut Random) -> Command {
    let waves: Vec<(f64, f64)> = (0..4)
        .map(|_| (random.between(0.04, 0.3), random.between(0.0, TAU)))
        .collect();
    Arc::new(move |t| {
        let sum: f64 = waves
            .iter()
            .map(|(f, phase)| (TAU * f * t + phase).sin())
            .sum();
        mean + 0.6 * by * sum
    })
}

/// A scene in which the aircraft keeps its speed, and moves a little in all that the model does not have.
pub(crate) fn scene(speed: f64, alpha: f64, random: &mut Random) -> Scene {
    Scene {
        speed: wander(speed, 0.006 * speed, random),
        alpha: wander(alpha, 0.02, random),
        beta: wander(0.0, 0.02, random),
        p: wander(0.0, 0.06, random),
        q: wander(0.0, 0.03, random),
        r: wander(0.0, 0.03, random),
        height: wander(2000.0, 5.0, random),
        speed_ratio: Arc::new(|_| 1.0),
    }
}
