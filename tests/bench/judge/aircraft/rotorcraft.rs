//! A helicopter near the hover, along and up: stick and collective, accelerometers, no flow angle at all.

use super::maneuvers::{Control, sample, scene, sorties};
use super::{Aircraft, both, unknown};
use crate::fault::Fault;
use crate::force_faults::{term, unsteady};
use crate::motion::{
    AILERON, Added, Airframe, Around, ELEVATOR, Motion, Quantity, Slot, THRUST, Trim,
};
use crate::random::Random;
use crate::record::Channel;
use crate::replay::Replay;
use crate::{sensor_faults as sensor, surface_faults as surface};

pub(super) const USUAL: &[(&str, &str)] = &[
    ("surge", "u"),
    ("plunge", "w"),
    ("nod", "q"),
    ("tilt", "theta"),
    ("stick", "dlon"),
    ("lever", "dcol"),
    ("pedal", "dped"),
    ("acc_along", "ax"),
    ("acc_down", "az"),
];

const G: f64 = 9.80665;

struct Rotorcraft {
    along: [f64; 2],
    down: [f64; 2],
    pitch: [f64; 4],
}

impl Airframe for Rotorcraft {
    fn start(&self) -> Vec<f64> {
        vec![0.0; 4]
    }

    fn rates(
        &self,
        x: &[f64],
        around: &Around<'_>,
        added: &Added,
        motion: &mut Motion,
        dx: &mut [f64],
    ) {
        let (u, w, q, theta) = (x[0], x[1], x[2], x[3]);
        let (stick, lever) = (motion.elevator(), motion.surface[THRUST]);
        let along = self.along[0] * u + self.along[1] * stick + added[Slot::Drag as usize];
        let down = self.down[0] * w + self.down[1] * lever + added[Slot::Lift as usize];
        let [mu, mw, mq, ms] = self.pitch;
        dx[0] = along - G * theta;
        dx[1] = down + around.air.wind_rate[2];
        dx[2] = mu * u + mw * w + mq * q + ms * stick + added[Slot::Pitch as usize];
        dx[3] = q;
        (motion.speed, motion.own) = (u, w);
        (motion.q, motion.qdot, motion.theta) = (q, dx[2], theta);
        (motion.ax, motion.az) = (along, down);
    }

    fn trim(&self) -> Vec<(Trim, usize)> {
        vec![(Trim::Surface(THRUST), 1), (Trim::Surface(ELEVATOR), 2)]
    }
}

const DOCUMENT: &str = r#"
name = "helicopter-near-hover"
title = "A helicopter near the hover: surge, plunge and pitch"

[constants]
g = { value = 9.80665, unit = "m/s^2" }

[inputs]
stick = { unit = "%", description = "longitudinal cyclic stick" }
lever = { unit = "%", description = "collective lever" }

[parameters]
surge_damping = { unit = "1/s", start = -0.05, description = "force forward due to speed" }
surge_stick = { unit = "m/s^2", start = -2.0, description = "force forward due to stick" }
plunge_damping = { unit = "1/s", start = -0.5, description = "force down due to plunge" }
plunge_lever = { unit = "m/s^2", start = -25.0, description = "force down due to collective" }
nod_surge = { unit = "1/(m*s)", start = 0.01, description = "pitching moment due to speed" }
nod_plunge = { unit = "1/(m*s)", start = 0.0, description = "pitching moment due to plunge" }
nod_damping = { unit = "1/s", start = -2.0, description = "pitch damping" }
nod_stick = { unit = "1/s^2", start = 5.0, description = "pitching moment due to stick" }
stick_trim = { unit = "%", start = "mean(stick, 1)", description = "stick in the hover" }
lever_trim = { unit = "%", start = "mean(lever, 1)", description = "collective in the hover" }

[states]
surge = { unit = "m/s", initial = "0", derivative = "surge_damping*surge + surge_stick*(stick - stick_trim) - g*tilt", description = "velocity forward" }
plunge = { unit = "m/s", initial = "0", derivative = "plunge_damping*plunge + plunge_lever*(lever - lever_trim)", description = "velocity down" }
nod = { unit = "rad/s", initial = "0", derivative = "nod_surge*surge + nod_plunge*plunge + nod_damping*nod + nod_stick*(stick - stick_trim)", description = "pitch rate" }
tilt = { unit = "rad", initial = "0", derivative = "nod", description = "pitch attitude" }

[outputs]
acc_along = { unit = "m/s^2", equation = "surge_damping*surge + surge_stick*(stick - stick_trim)", description = "specific force forward" }
acc_down = { unit = "m/s^2", equation = "plunge_damping*plunge + plunge_lever*(lever - lever_trim)", description = "specific force down, less gravity" }
nod = { unit = "rad/s", equation = "nod", description = "pitch rate" }
tilt = { unit = "rad", equation = "tilt", description = "pitch attitude" }
surge = { unit = "m/s", equation = "surge", description = "velocity forward" }
"#;

pub(super) fn make(random: &mut Random, replay: Option<&Replay>) -> Aircraft {
    let mut about = |value: f64| value * random.between(0.85, 1.15);
    let frame = Rotorcraft {
        along: [about(-0.06), about(-2.5)],
        down: [about(-0.6), about(-28.0)],
        pitch: [about(0.012), about(0.02), about(-2.4), about(6.0)],
    };
    let control = |surface, amplitude, unit, leads| Control {
        surface,
        amplitude,
        unit,
        leads,
    };
    let controls = [
        control(ELEVATOR, 0.06, 0.7, true),
        control(THRUST, 0.05, 1.5, true),
        control(AILERON, 0.1, 1.5, false),
    ];
    let sorties = sorties(
        &controls,
        [10.0, 18.0],
        |random| scene(0.0, 0.0, random),
        random,
        replay,
    );
    let channels = vec![
        Channel::new("stick", "%", Quantity::Command(ELEVATOR), 0.01).given(),
        Channel::new("lever", "%", Quantity::Command(THRUST), 0.01).given(),
        Channel::new("pedal", "%", Quantity::Command(AILERON), 0.01).given(),
        Channel::new("acc_along", "m/s^2", Quantity::Ax, 0.02),
        Channel::new("acc_down", "m/s^2", Quantity::Az, 0.05),
        Channel::new("nod", "deg/s", Quantity::Q, 0.1),
        Channel::new("tilt", "deg", Quantity::Theta, 0.08),
        Channel::new("surge", "m/s", Quantity::Speed, 0.05),
    ];
    Aircraft {
        frame: Box::new(frame),
        document: DOCUMENT.to_string(),
        channels,
        sorties,
        sample: sample(random),
        faults: both(faults(), unknown_faults()),
    }
}

fn faults() -> Vec<Fault> {
    let all = "acc_along+acc_down+nod+tilt+surge";
    vec![
        sensor::bias("acc_along", 0.02),
        sensor::bias("nod", 0.001),
        sensor::scale("nod"),
        sensor::scale("surge"),
        sensor::drift("tilt", 3e-4),
        sensor::delay("acc_down").or("input_delay", "lever", None),
        sensor::delay("surge"),
        sensor::delay("nod+tilt"),
        sensor::delay(all),
        sensor::lag("acc_along"),
        sensor::lag("surge"),
        sensor::position("acc_along", Quantity::Ax, 'z'),
        sensor::outliers("tilt"),
        sensor::outliers("acc_down"),
        surface::delay("stick", ELEVATOR),
        surface::lag("lever", THRUST),
        surface::lag("stick", ELEVATOR),
        surface::rate_limit("stick", ELEVATOR),
        surface::backlash("lever", THRUST),
        crate::force_faults::unrecorded(Slot::Pitch, "nod", "pedal", AILERON, 1.0),
        term(Slot::Pitch, "nod", "lever", 3.0, |m| m.surface[THRUST]),
        term(Slot::Pitch, "nod", "stick*abs(stick)", 30.0, |m| {
            m.elevator() * m.elevator().abs()
        }),
        term(Slot::Pitch, "nod", "surge^2", 0.01, |m| m.speed * m.speed),
        term(Slot::Pitch, "nod", "surge*plunge", 0.01, |m| {
            m.speed * m.own
        }),
        unsteady(Slot::Pitch, "nod", "lever", 5.0, |m| m.surface[THRUST]),
        sensor::structural_mode("acc_down", "lever", THRUST, 10.0),
        sensor::cross_axis("acc_along", "acc_down", Quantity::Az),
        sensor::swapped("acc_along", "acc_down"),
    ]
}

fn unknown_faults() -> Vec<Fault> {
    vec![
        unknown::saturation("stick", ELEVATOR, &["nod"]),
        unknown::hysteresis(Slot::Pitch, "nod", 10.0, |m| m.theta, |m| m.q),
        unknown::wandering(Slot::Pitch, "nod", 0.02),
        unknown::slosh(Slot::Pitch, "nod", 2.0, |m| m.theta),
        unknown::vibration("acc_down", 0.1),
        unknown::clock_drift("nod"),
        unknown::in_one_flight(sensor::scale("nod")),
    ]
}
