//! Heave and pitch of a canard aircraft: two surfaces, a vertical speed for a state, and no name from the catalog.

use super::maneuvers::{Control, sample, scene, sorties};
use super::{Aircraft, both, unknown};
use crate::air_faults::{Angle, turbulence};
use crate::fault::Fault;
use crate::force_faults::{pressure, term, unrecorded, unsteady};
use crate::motion::{
    AILERON, Added, Airframe, Around, ELEVATOR, FLAP, Motion, Quantity, Slot, Trim,
};
use crate::random::Random;
use crate::record::Channel;
use crate::replay::Replay;
use crate::{sensor_faults as sensor, surface_faults as surface};

/// There is no usual way to call a canard, or a heave.
pub(super) const USUAL: &[(&str, &str)] = &[
    ("inflow", "alpha"),
    ("pitch_speed", "q"),
    ("stab", "de"),
    ("foreplane", "dc"),
    ("airspeed", "V"),
    ("load", "az"),
    ("heave", "w"),
    ("airbrake", "dsb"),
];

const ALPHA: f64 = 0.05;

struct Canard {
    speed: f64,
    down: [f64; 4],
    pitch: [f64; 4],
}

impl Airframe for Canard {
    /// Angle of attack about the steady one, and pitch rate.
    fn start(&self) -> Vec<f64> {
        vec![0.0, 0.0]
    }

    fn rates(
        &self,
        x: &[f64],
        around: &Around<'_>,
        added: &Added,
        motion: &mut Motion,
        dx: &mut [f64],
    ) {
        let (heave, q) = (x[0], x[1]);
        let (stab, canard) = (motion.elevator(), motion.flap());
        let ratio = (around.scene.speed_ratio)(motion.time);
        let of = |c: &[f64; 4], force: bool| {
            let square = ratio * ratio;
            (if force { ratio } else { square }) * c[0] * heave
                + ratio * c[1] * q
                + square * (c[2] * stab + c[3] * canard)
        };
        let down = of(&self.down, true) + added[Slot::Lift as usize];
        dx[0] = self.speed * q + down + self.speed * around.air.alpha_rate;
        dx[1] = of(&self.pitch, false) + added[Slot::Pitch as usize];
        motion.own = heave;
        motion.alpha = heave / self.speed;
        motion.alphadot = dx[0] / self.speed;
        (motion.q, motion.qdot) = (q, dx[1]);
        motion.az = down;
    }

    fn trim(&self) -> Vec<(Trim, usize)> {
        vec![(Trim::State(0), 0), (Trim::Surface(ELEVATOR), 1)]
    }
}

const DOCUMENT: &str = r#"
name = "canard-heave-and-pitch"
title = "Heave and pitch about steady flight, tailplane and foreplane"

[constants]
steady = { value = {SPEED}, unit = "m/s", description = "true airspeed of the steady flight" }

[inputs]
stab = { unit = "deg", description = "deflection of the tailplane" }
foreplane = { unit = "deg", description = "deflection of the foreplane" }

[parameters]
d_heave = { unit = "1/s", start = -1.2, description = "force down due to heave" }
d_rate = { unit = "m/s", start = 0.0, description = "force down due to pitch rate" }
d_stab = { unit = "m/s^2", start = -10.0, description = "force down due to tailplane" }
d_fore = { unit = "m/s^2", start = -8.0, description = "force down due to foreplane" }
m_heave = { unit = "1/(m*s)", start = -0.02, description = "pitching moment due to heave" }
m_rate = { unit = "1/s", start = -1.5, description = "pitch damping" }
m_stab = { unit = "1/s^2", start = -7.0, description = "pitching moment due to tailplane" }
m_fore = { unit = "1/s^2", start = 4.0, description = "pitching moment due to foreplane" }
stab_steady = { unit = "deg", start = "mean(stab, 1)", description = "tailplane of the steady flight" }
zero_inflow = { unit = "deg", start = "first(inflow)", per = "maneuver", description = "reading of the vane in steady flight" }
heave_0 = { unit = "m/s", start = 0.0, per = "maneuver", description = "initial heave" }
load_zero = { unit = "m/s^2", start = 0.0, description = "bias of the accelerometer" }

[definitions]
attack = { unit = "rad", equation = "heave/steady", description = "angle of attack about the steady one" }
down_force = { unit = "m/s^2", equation = "d_heave*heave + d_rate*pitch_speed + d_stab*(stab - stab_steady) + d_fore*foreplane", description = "acceleration down by the air" }
pitch_moment = { unit = "rad/s^2", equation = "m_heave*heave + m_rate*pitch_speed + m_stab*(stab - stab_steady) + m_fore*foreplane", description = "pitch acceleration by the air" }

[states.heave]
unit = "m/s"
initial = "heave_0"
derivative = "steady*pitch_speed + down_force"
description = "velocity down"

[states.pitch_speed]
unit = "rad/s"
initial = "0"
derivative = "pitch_moment"
description = "pitch rate"

[outputs]
inflow = { unit = "deg", equation = "attack + zero_inflow", description = "angle of attack at the vane" }
pitch_speed = { unit = "deg/s", equation = "pitch_speed", description = "pitch rate" }
load = { unit = "m/s^2", equation = "down_force + load_zero", description = "specific force down, less that of steady flight" }
"#;

pub(super) fn make(random: &mut Random, replay: Option<&Replay>) -> Aircraft {
    let speed = random.between(60.0, 90.0);
    let mut about = |value: f64| value * random.between(0.85, 1.15);
    let frame = Canard {
        speed,
        down: [about(-1.4), about(-1.0), about(-12.0), about(-9.0)],
        pitch: [about(-0.035), about(-1.9), about(-8.0), about(5.0)],
    };
    let control = |surface, amplitude, unit, leads| Control {
        surface,
        amplitude,
        unit,
        leads,
    };
    let controls = [
        control(ELEVATOR, 0.05, 0.9, true),
        control(FLAP, 0.06, 0.9, true),
        control(AILERON, 0.2, 2.0, false),
    ];
    let sorties = sorties(
        &controls,
        [10.0, 22.0],
        |random| scene(speed, ALPHA, random),
        random,
        replay,
    );
    let channels = vec![
        Channel::new("stab", "deg", Quantity::Command(ELEVATOR), 0.002).given(),
        Channel::new("foreplane", "deg", Quantity::Command(FLAP), 0.002).given(),
        Channel::new("inflow", "deg", Quantity::Alpha, 0.08),
        Channel::new("pitch_speed", "deg/s", Quantity::Q, 0.1),
        Channel::new("load", "m/s^2", Quantity::Az, 0.06),
        Channel::new("airspeed", "m/s", Quantity::Speed, 0.05).given(),
        Channel::new("airbrake", "deg", Quantity::Command(AILERON), 0.01).given(),
    ];
    Aircraft {
        frame: Box::new(frame),
        document: DOCUMENT.replace("{SPEED}", &format!("{speed:?}")),
        channels,
        sorties,
        sample: sample(random).min(0.04),
        faults: both(faults(), unknown_faults()),
    }
}

/// A term in a definition may as well stand in the state's equation that reads nothing else.
fn in_pitch(written: &str, guess: f64, of: impl Fn(&Motion) -> f64 + Clone + 'static) -> Fault {
    let with = |fault: Fault, term: &str| fault.or("missing_term", "pitch_moment", Some(term));
    let fault = term(Slot::Pitch, "pitch_moment", written, guess, of);
    with(fault, written).or("missing_term", "pitch_speed", Some(written))
}

fn faults() -> Vec<Fault> {
    vec![
        sensor::scale("inflow"),
        sensor::scale("load"),
        sensor::drift("inflow", 2e-4),
        sensor::drift("pitch_speed", 2e-4),
        sensor::delay("inflow"),
        sensor::delay("load"),
        sensor::lag("inflow"),
        sensor::lag("load"),
        sensor::position("inflow", Quantity::Alpha, 'x'),
        sensor::position("load", Quantity::Az, 'x'),
        sensor::outliers("inflow"),
        sensor::outliers("load"),
        surface::scale("foreplane", FLAP),
        surface::delay("stab", ELEVATOR),
        surface::delay("foreplane", FLAP),
        surface::lag("stab", ELEVATOR),
        surface::rate_limit("stab", ELEVATOR),
        surface::backlash("foreplane", FLAP),
        unrecorded(Slot::Pitch, "pitch_moment", "airbrake", AILERON, 0.3).or(
            "unrecorded_input",
            "pitch_speed",
            None,
        ),
        in_pitch("heave^2", 0.01, |m| m.own * m.own).or(
            "missing_term",
            "pitch_moment",
            Some("attack^2"),
        ),
        in_pitch("foreplane*abs(foreplane)", 8.0, |m| {
            m.flap() * m.flap().abs()
        }),
        in_pitch("heave*foreplane", 0.3, |m| m.own * m.flap()).or(
            "missing_term",
            "pitch_moment",
            Some("attack*foreplane"),
        ),
        term(Slot::Lift, "down_force", "heave*abs(heave)", 0.05, |m| {
            m.own * m.own.abs()
        })
        .or("missing_term", "down_force", Some("attack*abs(attack)")),
        pressure("qbar"),
        unsteady(Slot::Pitch, "pitch_moment", "attack", -3.0, |m| m.alpha)
            .or("unsteady_aero", "pitch_moment", None)
            .or("unsteady_aero", "pitch_speed", None)
            .or("missing_term", "pitch_moment", Some("heavedot")),
        turbulence("heave", Angle::Alpha),
        sensor::structural_mode("load", "stab", ELEVATOR, 10.0),
        sensor::swapped("inflow", "pitch_speed"),
    ]
}

fn unknown_faults() -> Vec<Fault> {
    let alpha = |m: &Motion| m.alpha;
    let at = ["pitch_moment", "pitch_speed"];
    let mut faults = vec![
        unknown::saturation("stab", ELEVATOR, &at),
        unknown::hinge_moment(Slot::Pitch, "pitch_moment", 3.0, alpha),
        unknown::hysteresis(Slot::Pitch, "pitch_moment", 5.0, alpha, |m| m.alphadot),
        unknown::wandering(Slot::Pitch, "pitch_moment", 0.02),
        unknown::slosh(Slot::Pitch, "pitch_moment", 2.0, alpha),
        unknown::clock_drift("inflow"),
        unknown::vibration("load", 0.1),
        unknown::in_one_flight(sensor::scale("inflow")),
    ];
    for fault in &mut faults {
        // the equation of the pitch rate is its moment
        if fault.shows_in == ["pitch_moment"] {
            fault.shows_in.push("pitch_speed".to_string());
        }
    }
    faults
}
