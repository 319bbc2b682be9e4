//! Lateral-directional motion: sideslip, roll rate, yaw rate and bank, declared whole or driven by recorded sideslip.

use super::maneuvers::{Control, sample, scene, sorties};
use super::{Aircraft, both, unknown};
use crate::air_faults::{Angle, gust, initial_state, turbulence};
use crate::fault::Fault;
use crate::force_faults::{pressure, term, unrecorded, unsteady};
use crate::motion::{AILERON, Added, Airframe, Around, FLAP, Motion, Quantity, RUDDER, Slot, Trim};
use crate::random::Random;
use crate::record::Channel;
use crate::replay::Replay;
use crate::{sensor_faults as sensor, surface_faults as surface};

pub(crate) const USUAL: &[(&str, &str)] = &[
    ("sideslip", "beta"),
    ("rollrate", "p"),
    ("yawrate", "r"),
    ("bank", "phi"),
    ("lat_acc", "ay"),
    ("ail", "da"),
    ("rud", "dr"),
    ("spoiler", "dsp"),
    ("TAS", "V"),
    ("AoA", "alpha"),
    ("pitchrate", "q"),
];

const G: f64 = 9.80665;

struct Lateral {
    speed: f64,
    alpha: f64,
    y: [f64; 3],
    l: [f64; 5],
    n: [f64; 5],
}

impl Airframe for Lateral {
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
        let (b, p, r, phi) = (x[0], x[1], x[2], x[3]);
        let (da, dr) = (motion.aileron(), motion.rudder());
        let speed = (around.scene.speed_ratio)(motion.time);
        let moment = |c: &[f64; 5]| {
            speed * speed * (c[0] * b + c[3] * da + c[4] * dr) + speed * (c[1] * p + c[2] * r)
        };
        let side =
            speed * (self.y[0] * b + self.y[1] * da + self.y[2] * dr) + added[Slot::Side as usize];
        let (sine, cosine) = self.alpha.sin_cos();
        dx[0] = side + sine * p - cosine * r + G / self.speed * cosine * phi + around.air.beta_rate;
        dx[1] = moment(&self.l) + added[Slot::Roll as usize];
        dx[2] = moment(&self.n) + added[Slot::Yaw as usize];
        dx[3] = p + self.alpha.tan() * r;
        (motion.beta, motion.p, motion.r, motion.phi) = (b, p, r, phi);
        (motion.pdot, motion.rdot) = (dx[1], dx[2]);
        motion.ay = self.speed * speed * side;
    }

    fn trim(&self) -> Vec<(Trim, usize)> {
        vec![(Trim::Surface(AILERON), 1), (Trim::Surface(RUDDER), 2)]
    }
}

fn frame(random: &mut Random) -> Lateral {
    let speed = random.between(75.0, 125.0);
    let alpha = random.between(0.03, 0.09);
    let mut about = |value: f64| value * random.between(0.8, 1.2);
    Lateral {
        speed,
        alpha,
        y: [about(-0.18), 0.0, about(0.035)],
        l: [
            about(-4.0),
            about(-2.4),
            about(0.9),
            about(-6.0),
            about(0.8),
        ],
        n: [about(2.3), about(-0.12), about(-0.4), 0.0, about(-1.3)],
    }
}

const LATERAL: &str = r#"
name = "dutch-roll"
title = "Lateral-directional motion, four states"

[constants]
g = { value = 9.80665, unit = "m/s^2" }
speed = { value = {SPEED}, unit = "m/s", description = "true airspeed of the steady flight" }
incidence = { value = {ALPHA}, unit = "rad", description = "angle of attack of the steady flight" }

[inputs]
ail = { unit = "deg", description = "aileron deflection" }
rud = { unit = "deg", description = "rudder deflection" }

[parameters]
Yv = { unit = "1/s", start = -0.15, description = "side force due to sideslip" }
Yrud = { unit = "1/s", start = 0.03, description = "side force due to rudder" }
Lv = { unit = "1/s^2", start = -3.0, description = "rolling moment due to sideslip" }
Lroll = { unit = "1/s", start = -2.0, description = "roll damping" }
Lyaw = { unit = "1/s", start = 0.7, description = "rolling moment due to yaw rate" }
Lail = { unit = "1/s^2", start = -5.0, description = "rolling moment due to aileron" }
Lrud = { unit = "1/s^2", start = 0.6, description = "rolling moment due to rudder" }
Nv = { unit = "1/s^2", start = 2.0, description = "yawing moment due to sideslip" }
Nroll = { unit = "1/s", start = -0.1, description = "yawing moment due to roll rate" }
Nyaw = { unit = "1/s", start = -0.3, description = "yaw damping" }
Nrud = { unit = "1/s^2", start = -1.1, description = "yawing moment due to rudder" }

[states.sideslip]
unit = "deg"
initial = "0"
derivative = "Yv*sideslip + sin(incidence)*rollrate - cos(incidence)*yawrate + g/speed*cos(incidence)*bank + Yrud*rud"
description = "angle of sideslip"

[states.rollrate]
unit = "deg/s"
initial = "0"
derivative = "Lv*sideslip + Lroll*rollrate + Lyaw*yawrate + Lail*ail + Lrud*rud"
description = "roll rate"

[states.yawrate]
unit = "deg/s"
initial = "0"
derivative = "Nv*sideslip + Nroll*rollrate + Nyaw*yawrate + Nrud*rud"
description = "yaw rate"

[states.bank]
unit = "deg"
initial = "0"
derivative = "rollrate + tan(incidence)*yawrate"
description = "bank angle"

[outputs]
sideslip = { unit = "deg", equation = "sideslip", description = "angle of sideslip" }
rollrate = { unit = "deg/s", equation = "rollrate", description = "roll rate" }
yawrate = { unit = "deg/s", equation = "yawrate", description = "yaw rate" }
bank = { unit = "deg", equation = "bank", description = "bank angle" }
lat_acc = { unit = "m/s^2", equation = "speed*(Yv*sideslip + Yrud*rud)", description = "lateral acceleration" }
"#;

const DRIVEN: &str = r#"
name = "roll-and-yaw"
title = "Roll and yaw rate, driven by recorded sideslip"

[constants]
speed = { value = {SPEED}, unit = "m/s", description = "true airspeed of the steady flight" }

[inputs]
ail = { unit = "rad", description = "aileron deflection" }
rud = { unit = "rad", description = "rudder deflection" }
sideslip = { unit = "rad", description = "angle of sideslip" }

[parameters]
Yv = { unit = "1/s", start = -0.15, description = "side force due to sideslip" }
Yrud = { unit = "1/s", start = 0.03, description = "side force due to rudder" }
Lv = { unit = "1/s^2", start = -3.0, description = "rolling moment due to sideslip" }
Lroll = { unit = "1/s", start = -2.0, description = "roll damping" }
Lyaw = { unit = "1/s", start = 0.7, description = "rolling moment due to yaw rate" }
Lail = { unit = "1/s^2", start = -5.0, description = "rolling moment due to aileron" }
Lrud = { unit = "1/s^2", start = 0.6, description = "rolling moment due to rudder" }
Nv = { unit = "1/s^2", start = 2.0, description = "yawing moment due to sideslip" }
Nroll = { unit = "1/s", start = -0.1, description = "yawing moment due to roll rate" }
Nyaw = { unit = "1/s", start = -0.3, description = "yaw damping" }
Nrud = { unit = "1/s^2", start = -1.1, description = "yawing moment due to rudder" }
rollrate_start = { unit = "rad/s", start = "first(rollrate)", per = "maneuver", description = "initial roll rate" }
yawrate_start = { unit = "rad/s", start = "first(yawrate)", per = "maneuver", description = "initial yaw rate" }
acc_offset = { unit = "m/s^2", start = 0.0, description = "bias of the lateral accelerometer" }

[states.rollrate]
unit = "rad/s"
initial = "rollrate_start"
derivative = "Lv*sideslip + Lroll*rollrate + Lyaw*yawrate + Lail*ail + Lrud*rud"
description = "roll rate"

[states.yawrate]
unit = "rad/s"
initial = "yawrate_start"
derivative = "Nv*sideslip + Nroll*rollrate + Nyaw*yawrate + Nrud*rud"
description = "yaw rate"

[outputs]
rollrate = { unit = "rad/s", equation = "rollrate", description = "roll rate" }
yawrate = { unit = "rad/s", equation = "yawrate", description = "yaw rate" }
lat_acc = { unit = "m/s^2", equation = "speed*(Yv*sideslip + Yrud*rud) + acc_offset", description = "lateral acceleration" }
"#;

fn aircraft(
    document: &str,
    channels: Vec<Channel>,
    faults: Vec<Fault>,
    random: &mut Random,
    replay: Option<&Replay>,
) -> Aircraft {
    let frame = frame(random);
    let document = (document.replace("{SPEED}", &format!("{:?}", frame.speed)))
        .replace("{ALPHA}", &format!("{:?}", frame.alpha));
    let (speed, alpha) = (frame.speed, frame.alpha);
    let controls = [
        Control {
            surface: AILERON,
            amplitude: 0.06,
            unit: 1.2,
            leads: true,
        },
        Control {
            surface: RUDDER,
            amplitude: 0.06,
            unit: 1.5,
            leads: true,
        },
        Control {
            surface: FLAP,
            amplitude: 0.2,
            unit: 2.0,
            leads: false,
        },
    ];
    let sorties = sorties(
        &controls,
        [14.0, 28.0],
        |random| scene(speed, alpha, random),
        random,
        replay,
    );
    Aircraft {
        frame: Box::new(frame),
        document,
        channels,
        sorties,
        sample: sample(random),
        faults: both(faults, unknown_faults()),
    }
}

fn others() -> [Channel; 4] {
    [
        Channel::new("TAS", "m/s", Quantity::Speed, 0.05).given(),
        Channel::new("AoA", "deg", Quantity::Alpha, 0.02).given(),
        Channel::new("pitchrate", "deg/s", Quantity::Q, 0.03).given(),
        Channel::new("spoiler", "deg", Quantity::Command(FLAP), 0.01).given(),
    ]
}

pub(crate) fn four_states(random: &mut Random, replay: Option<&Replay>) -> Aircraft {
    let mut channels = vec![
        Channel::new("ail", "deg", Quantity::Command(AILERON), 0.003).given(),
        Channel::new("rud", "deg", Quantity::Command(RUDDER), 0.003).given(),
        Channel::new("sideslip", "deg", Quantity::Beta, 0.06),
        Channel::new("rollrate", "deg/s", Quantity::P, 0.15),
        Channel::new("yawrate", "deg/s", Quantity::R, 0.06),
        Channel::new("bank", "deg", Quantity::Phi, 0.1),
        Channel::new("lat_acc", "m/s^2", Quantity::Ay, 0.03),
    ];
    channels.extend(others());
    let mut faults = terms();
    faults.extend([
        surface::bias("ail", AILERON),
        sensor::bias("sideslip", 0.002),
        sensor::bias("yawrate", 0.002),
        sensor::bias("lat_acc", 0.02),
        sensor::scale("sideslip"),
        sensor::scale("rollrate"),
        sensor::scale("lat_acc"),
        sensor::drift("bank", 5e-4),
        sensor::drift("yawrate", 2e-4),
        sensor::delay("sideslip"),
        sensor::delay("lat_acc"),
        sensor::delay("rollrate+yawrate"),
        sensor::delay("sideslip+rollrate+yawrate+bank+lat_acc"),
        sensor::lag("sideslip"),
        sensor::lag("lat_acc"),
        sensor::position("sideslip", Quantity::Beta, 'x'),
        sensor::position("lat_acc", Quantity::Ay, 'x'),
        sensor::position("lat_acc", Quantity::Ay, 'z'),
        sensor::outliers("yawrate"),
        sensor::outliers("lat_acc"),
        turbulence("sideslip", Angle::Beta),
        gust("sideslip", Angle::Beta),
        initial_state("sideslip", 0, 0.01),
        initial_state("bank", 3, 0.01),
        unsteady(Slot::Yaw, "yawrate", "sideslip", 0.8, |m| m.beta),
        sensor::structural_mode("lat_acc", "rud", RUDDER, 2.0),
    ]);
    aircraft(LATERAL, channels, faults, random, replay)
}

pub(crate) fn driven(random: &mut Random, replay: Option<&Replay>) -> Aircraft {
    let mut channels = vec![
        Channel::new("ail", "rad", Quantity::Command(AILERON), 5e-5).given(),
        Channel::new("rud", "rad", Quantity::Command(RUDDER), 5e-5).given(),
        Channel::new("sideslip", "rad", Quantity::Beta, 1e-4).given(),
        Channel::new("rollrate", "deg/s", Quantity::P, 0.15),
        Channel::new("yawrate", "deg/s", Quantity::R, 0.06),
        Channel::new("lat_acc", "m/s^2", Quantity::Ay, 0.03),
    ];
    channels.extend(others());
    let mut faults = terms();
    let vane = |fault: Fault, kind: &'static str| fault.or(kind, "sideslip", None);
    faults.extend([
        vane(sensor::delay("sideslip"), "input_delay"),
        vane(sensor::lag("sideslip"), "actuator_lag"),
        vane(sensor::bias("sideslip", 0.003), "input_bias"),
        sensor::position("sideslip", Quantity::Beta, 'x'),
        sensor::drift("rollrate", 3e-4),
        sensor::drift("yawrate", 2e-4),
        sensor::delay("rollrate"),
        sensor::delay("rollrate+yawrate+lat_acc"),
        sensor::lag("lat_acc"),
        sensor::position("lat_acc", Quantity::Ay, 'x'),
        sensor::outliers("rollrate"),
        sensor::structural_mode("lat_acc", "rud", RUDDER, 2.0),
        unsteady(Slot::Roll, "rollrate", "sideslip", 1.0, |m| m.beta),
    ]);
    aircraft(DRIVEN, channels, faults, random, replay)
}

/// What both have: their equations of roll and yaw are the same.
fn terms() -> Vec<Fault> {
    vec![
        surface::delay("ail", AILERON),
        surface::lag("ail", AILERON),
        surface::lag("rud", RUDDER),
        surface::rate_limit("ail", AILERON),
        surface::rate_limit("rud", RUDDER),
        surface::backlash("ail", AILERON),
        surface::backlash("rud", RUDDER),
        unrecorded(Slot::Roll, "rollrate", "spoiler", FLAP, 0.3),
        term(Slot::Yaw, "yawrate", "ail", -0.3, |m| m.aileron()),
        term(Slot::Roll, "rollrate", "ail*abs(ail)", 10.0, |m| {
            m.aileron() * m.aileron().abs()
        }),
        term(Slot::Yaw, "yawrate", "rud*abs(rud)", 5.0, |m| {
            m.rudder() * m.rudder().abs()
        }),
        term(Slot::Yaw, "yawrate", "sideslip*abs(sideslip)", 10.0, |m| {
            m.beta * m.beta.abs()
        }),
        term(Slot::Roll, "rollrate", "sideslip^3", 200.0, |m| {
            m.beta.powi(3)
        }),
        term(Slot::Yaw, "yawrate", "AoA*rollrate", 2.0, |m| m.alpha * m.p),
        term(Slot::Yaw, "yawrate", "AoA*sideslip", 10.0, |m| {
            m.alpha * m.beta
        }),
        term(Slot::Roll, "rollrate", "AoA*sideslip", 10.0, |m| {
            m.alpha * m.beta
        }),
        term(Slot::Yaw, "yawrate", "pitchrate*rollrate", 1.0, |m| {
            m.p * m.q
        }),
        term(Slot::Roll, "rollrate", "rollrate*abs(rollrate)", 1.0, |m| {
            m.p * m.p.abs()
        }),
        term(Slot::Yaw, "yawrate", "TAS", 0.01, |m| {
            m.speed - m.steady_speed
        }),
        pressure("qbar"),
        sensor::cross_axis("yawrate", "rollrate", Quantity::P),
        sensor::swapped("rollrate", "yawrate"),
    ]
}

fn unknown_faults() -> Vec<Fault> {
    let beta = |m: &Motion| m.beta;
    vec![
        unknown::saturation("rud", RUDDER, &["yawrate"]),
        unknown::saturation("ail", AILERON, &["rollrate"]),
        unknown::hinge_moment(Slot::Yaw, "yawrate", 1.0, beta),
        unknown::wandering(Slot::Yaw, "yawrate", 0.005),
        unknown::slosh(Slot::Roll, "rollrate", 1.0, beta),
        unknown::hysteresis(Slot::Roll, "rollrate", 0.5, |m| m.r, |m| m.rdot),
        unknown::clock_drift("yawrate"),
        unknown::vibration("lat_acc", 0.05),
        unknown::in_one_flight(sensor::delay("lat_acc")),
        unknown::in_one_flight(surface::lag("ail", AILERON)),
    ]
}
