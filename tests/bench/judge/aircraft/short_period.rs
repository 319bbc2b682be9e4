//! Short period at constant speed: angle of attack and pitch rate.

use super::maneuvers::{Control, sample, scene, sorties};
use super::{Aircraft, both, unknown};
use crate::air_faults::{Angle, gust, turbulence};
use crate::fault::Fault;
use crate::force_faults::{pressure, stall, term, unrecorded, unsteady};
use crate::motion::{Added, Airframe, Around, ELEVATOR, FLAP, Motion, Quantity, Slot, Trim};
use crate::random::Random;
use crate::record::Channel;
use crate::replay::Replay;
use crate::{sensor_faults as sensor, surface_faults as surface};

pub(crate) const USUAL: &[(&str, &str)] = &[
    ("AoA", "alpha"),
    ("pitchrate", "q"),
    ("elev", "de"),
    ("flaps", "df"),
    ("TAS", "V"),
    ("sideslip", "beta"),
    ("rollrate", "p"),
    ("yawrate", "r"),
    ("altitude", "h"),
];

/// Reference of angle of attack and elevator, rad.
const ALPHA: f64 = 0.07;
const ELEV: f64 = -0.035;

struct ShortPeriod {
    za: f64,
    zq: f64,
    zde: f64,
    ma: f64,
    mq: f64,
    mde: f64,
}

impl Airframe for ShortPeriod {
    fn start(&self) -> Vec<f64> {
        vec![ALPHA, 0.0]
    }

    fn rates(
        &self,
        x: &[f64],
        around: &Around<'_>,
        added: &Added,
        motion: &mut Motion,
        dx: &mut [f64],
    ) {
        let (a, q, de) = (x[0] - ALPHA, x[1], motion.elevator() - ELEV);
        let speed = (around.scene.speed_ratio)(motion.time);
        let pressure = speed * speed;
        let lift = speed * (self.za * a + self.zde * de)
            + (self.zq - 1.0) * q
            + added[Slot::Lift as usize];
        dx[0] = lift + q + around.air.alpha_rate;
        dx[1] = pressure * (self.ma * a + self.mde * de)
            + speed * self.mq * q
            + added[Slot::Pitch as usize];
        (motion.alpha, motion.q) = (x[0], q);
        (motion.alphadot, motion.qdot) = (dx[0], dx[1]);
        motion.az = motion.speed * lift - 9.81;
    }

    fn trim(&self) -> Vec<(Trim, usize)> {
        vec![(Trim::State(0), 0), (Trim::Surface(ELEVATOR), 1)]
    }
}

const DOCUMENT: &str = r#"
name = "pitch-dynamics"
title = "Pitch dynamics at constant speed"

[inputs]
elev = { unit = "deg", description = "elevator deflection, trailing edge down" }

[parameters]
Z1 = { unit = "1/s", start = -0.9, description = "normal force due to angle of attack" }
Z2 = { unit = "-", start = 1.0, description = "normal force due to pitch rate, plus one" }
Z3 = { unit = "1/s", start = -0.1, description = "normal force due to elevator" }
M1 = { unit = "1/s^2", start = -2.5, description = "pitching moment due to angle of attack" }
M2 = { unit = "1/s", start = -1.2, description = "pitching moment due to pitch rate" }
M3 = { unit = "1/s^2", start = -3.5, description = "pitching moment due to elevator" }
AoA_ref = { unit = "deg", start = "mean(AoA, 1)", description = "angle of attack of the steady flight" }
elev_ref = { unit = "deg", start = "mean(elev, 1)", description = "elevator of the steady flight" }
gyro_offset = { unit = "deg/s", start = 0.0, description = "bias of the pitch rate gyro" }
AoA_start = { unit = "deg", start = "first(AoA)", per = "maneuver", description = "initial angle of attack" }

[states.AoA]
unit = "deg"
initial = "AoA_start"
derivative = "Z1*(AoA - AoA_ref) + Z2*pitchrate + Z3*(elev - elev_ref)"
description = "angle of attack"

[states.pitchrate]
unit = "deg/s"
initial = "0"
derivative = "M1*(AoA - AoA_ref) + M2*pitchrate + M3*(elev - elev_ref)"
description = "pitch rate"

[outputs]
AoA = { unit = "deg", equation = "AoA", description = "angle of attack" }
pitchrate = { unit = "deg/s", equation = "pitchrate + gyro_offset", description = "pitch rate" }
"#;

pub(crate) fn make(random: &mut Random, replay: Option<&Replay>) -> Aircraft {
    let mut about = |value: f64| value * random.between(0.8, 1.2);
    let frame = ShortPeriod {
        za: about(-1.1),
        zq: about(0.97).min(1.0),
        zde: about(-0.12),
        ma: about(-3.2),
        mq: about(-1.5),
        mde: about(-4.5),
    };
    let speed = random.between(70.0, 130.0);
    let controls = [
        Control {
            surface: ELEVATOR,
            amplitude: 0.06,
            unit: 1.0,
            leads: true,
        },
        Control {
            surface: FLAP,
            amplitude: 0.15,
            unit: 2.0,
            leads: false,
        },
    ];
    let sorties = sorties(
        &controls,
        [12.0, 26.0],
        |random| scene(speed, ALPHA, random),
        random,
        replay,
    );
    let channels = vec![
        Channel::new("elev", "deg", Quantity::Command(ELEVATOR), 0.002).given(),
        Channel::new("AoA", "deg", Quantity::Alpha, 0.08),
        Channel::new("pitchrate", "deg/s", Quantity::Q, 0.12),
        Channel::new("TAS", "m/s", Quantity::Speed, 0.05).given(),
        Channel::new("flaps", "deg", Quantity::Command(FLAP), 0.01).given(),
        Channel::new("sideslip", "deg", Quantity::Beta, 0.02).given(),
        Channel::new("rollrate", "deg/s", Quantity::P, 0.03).given(),
        Channel::new("yawrate", "deg/s", Quantity::R, 0.03).given(),
        Channel::new("altitude", "m", Quantity::Height, 0.2).given(),
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
    let a = |m: &Motion| m.alpha - ALPHA;
    let de = |m: &Motion| m.elevator() - ELEV;
    vec![
        sensor::scale("AoA"),
        sensor::drift("AoA", 2e-4),
        sensor::drift("pitchrate", 2e-4),
        sensor::delay("AoA"),
        sensor::delay("pitchrate"),
        sensor::delay("AoA+pitchrate").or("input_delay", "elev", None),
        sensor::lag("AoA"),
        sensor::lag("pitchrate"),
        sensor::outliers("AoA"),
        sensor::outliers("pitchrate"),
        surface::delay("elev", ELEVATOR).or("sensor_delay", "AoA+pitchrate", None),
        surface::lag("elev", ELEVATOR),
        surface::rate_limit("elev", ELEVATOR),
        surface::backlash("elev", ELEVATOR),
        unrecorded(Slot::Pitch, "pitchrate", "flaps", FLAP, 0.3),
        term(Slot::Pitch, "pitchrate", "AoA^2", 10.0, move |m| {
            a(m).powi(2)
        }),
        term(Slot::Pitch, "pitchrate", "AoA^3", 200.0, move |m| {
            a(m).powi(3)
        }),
        term(Slot::Lift, "AoA", "AoA^2", 3.0, move |m| a(m).powi(2)),
        term(Slot::Pitch, "pitchrate", "elev*abs(elev)", 10.0, move |m| {
            de(m) * de(m).abs()
        }),
        term(Slot::Pitch, "pitchrate", "AoA*pitchrate", 5.0, move |m| {
            a(m) * m.q
        }),
        term(Slot::Pitch, "pitchrate", "AoA*elev", 10.0, move |m| {
            a(m) * de(m)
        }),
        term(Slot::Pitch, "pitchrate", "rollrate*yawrate", 1.0, |m| {
            m.p * m.r
        }),
        term(Slot::Pitch, "pitchrate", "sideslip^2", 10.0, |m| {
            m.beta * m.beta
        }),
        term(Slot::Pitch, "pitchrate", "TAS", 0.02, |m| {
            m.speed - m.steady_speed
        }),
        pressure("qbar"),
        unsteady(Slot::Pitch, "pitchrate", "AoA", -1.0, |m| m.alpha),
        stall("AoA+pitchrate", "AoA", ALPHA + 0.07, |lost, _, added| {
            added[Slot::Lift as usize] += 0.5 * lost;
            added[Slot::Pitch as usize] -= lost;
        }),
        turbulence("AoA", Angle::Alpha),
        gust("AoA", Angle::Alpha),
        sensor::structural_mode("pitchrate", "elev", ELEVATOR, 0.05),
        sensor::cross_axis("pitchrate", "rollrate", Quantity::P),
        sensor::swapped("AoA", "pitchrate"),
    ]
}

fn unknown_faults() -> Vec<Fault> {
    let alpha = |m: &Motion| m.alpha;
    vec![
        unknown::saturation("elev", ELEVATOR, &["pitchrate"]),
        unknown::hinge_moment(Slot::Pitch, "pitchrate", 2.0, alpha),
        unknown::hysteresis(Slot::Pitch, "pitchrate", 4.0, alpha, |m| m.alphadot),
        unknown::wandering(Slot::Pitch, "pitchrate", 0.01),
        unknown::slosh(Slot::Pitch, "pitchrate", 2.0, alpha),
        unknown::ground_effect(Slot::Pitch, "pitchrate", "altitude", 0.02, 2000.0, 4.0),
        unknown::clock_drift("AoA"),
        unknown::vibration("pitchrate", 0.002),
        unknown::in_one_flight(sensor::delay("AoA")),
        unknown::in_one_flight(term(Slot::Pitch, "pitchrate", "AoA^2", 10.0, |m| {
            (m.alpha - ALPHA).powi(2)
        })),
    ]
}
