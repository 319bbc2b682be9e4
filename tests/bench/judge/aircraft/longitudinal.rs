//! Longitudinal motion of a jet, nonlinear: speed, angle of attack, pitch attitude and rate, with coefficients.

use super::maneuvers::{Control, sample, scene, sorties};
use super::{Aircraft, both, unknown};
use crate::air_faults::{Angle, gust, turbulence};
use crate::fault::Fault;
use crate::force_faults::{stall, term, unsteady};
use crate::motion::{Added, Airframe, Around, ELEVATOR, Motion, Quantity, Slot, THRUST, Trim};
use crate::random::Random;
use crate::record::Channel;
use crate::replay::Replay;
use crate::{sensor_faults as sensor, surface_faults as surface};

pub(super) const USUAL: &[(&str, &str)] = &[
    ("TAS", "V"),
    ("AoA", "alpha"),
    ("pitch", "theta"),
    ("pitchrate", "q"),
    ("fwd_acc", "ax"),
    ("down_acc", "az"),
    ("elev", "de"),
    ("jet", "thrust"),
    ("C_drag", "CD"),
    ("C_lift", "CL"),
    ("C_pitch", "Cm"),
    ("sideslip", "beta"),
    ("rollrate", "p"),
    ("yawrate", "r"),
    ("altitude", "h"),
];

const G: f64 = 9.80665;
const MASS: f64 = 7400.0;
const AREA: f64 = 30.0;
const CHORD: f64 = 2.4;
const INERTIA: f64 = 90_000.0;
const RHO: f64 = 0.8;
const SPEED: f64 = 110.0;
/// rad: about where it flies, and about what terms that are missing are written.
const ALPHA: f64 = 0.08;

struct Jet {
    drag: [f64; 3],
    lift: [f64; 3],
    pitch: [f64; 4],
}

impl Airframe for Jet {
    fn start(&self) -> Vec<f64> {
        vec![SPEED, ALPHA, ALPHA + 0.01, 0.0, 2000.0]
    }

    fn rates(
        &self,
        x: &[f64],
        around: &Around<'_>,
        added: &Added,
        motion: &mut Motion,
        dx: &mut [f64],
    ) {
        let (v, alpha, theta, q) = (x[0], x[1], x[2], x[3]);
        let (de, thrust) = (motion.elevator(), motion.surface[THRUST]);
        let qs = 0.5 * RHO * v * v * AREA;
        let qhat = CHORD * q / (2.0 * SPEED);
        let [cd0, cdv, cda] = self.drag;
        let [cl0, cla, clq] = self.lift;
        let [cm0, cma, cmq, cmde] = self.pitch;
        let drag = cd0 + cdv * v / SPEED + cda * alpha + added[Slot::Drag as usize];
        let lift = cl0 + cla * alpha + clq * qhat + added[Slot::Lift as usize];
        let pitch = cm0 + cma * alpha + cmq * qhat + cmde * de + added[Slot::Pitch as usize];
        dx[0] = (thrust * alpha.cos() - qs * drag) / MASS - G * (theta - alpha).sin();
        dx[1] = q - (qs * lift + thrust * alpha.sin()) / (MASS * v)
            + G / v * (theta - alpha).cos()
            + around.air.alpha_rate;
        dx[2] = q;
        dx[3] = qs * CHORD * pitch / INERTIA;
        dx[4] = v * (theta - alpha).sin();
        (
            motion.speed,
            motion.alpha,
            motion.theta,
            motion.q,
            motion.height,
        ) = (v, alpha, theta, q, x[4]);
        (motion.alphadot, motion.qdot) = (dx[1], dx[3]);
        let (sine, cosine) = alpha.sin_cos();
        motion.ax = (qs * (lift * sine - drag * cosine) + thrust) / MASS;
        motion.az = -qs * (lift * cosine + drag * sine) / MASS;
    }

    fn trim(&self) -> Vec<(Trim, usize)> {
        vec![
            (Trim::Surface(THRUST), 0),
            (Trim::State(1), 1),
            (Trim::Surface(ELEVATOR), 3),
        ]
    }
}

const DOCUMENT: &str = r#"
name = "jet-in-the-vertical-plane"
title = "Speed, angle of attack, pitch attitude and rate of a jet"

[constants]
g = { value = 9.80665, unit = "m/s^2" }
density = { value = 0.8, unit = "kg/m^3" }
mass = { value = 7400.0, unit = "kg" }
area = { value = 30.0, unit = "m^2" }
chord = { value = 2.4, unit = "m" }
inertia = { value = 90000.0, unit = "kg*m^2" }
TAS_ref = { value = 110.0, unit = "m/s" }

[inputs]
elev = { unit = "rad", description = "elevator deflection" }
jet = { unit = "N", description = "thrust" }

[parameters]
drag_0 = { start = 0.04, description = "drag" }
drag_speed = { start = 0.0, description = "drag due to speed" }
drag_angle = { start = 0.3, description = "drag due to angle of attack" }
lift_0 = { start = 0.2, description = "lift" }
lift_angle = { start = 4.2, description = "lift due to angle of attack" }
lift_rate = { start = 2.0, description = "lift due to pitch rate" }
lift_elev = { start = 0.0, fixed = true, description = "lift due to elevator" }
pitch_0 = { start = 0.03, description = "pitching moment" }
pitch_angle = { start = -0.7, description = "pitching moment due to angle of attack" }
pitch_rate = { start = -15.0, description = "pitch damping" }
pitch_elev = { start = -1.2, description = "pitching moment due to elevator" }
TAS_0 = { start = "first(TAS)", unit = "m/s", per = "maneuver", description = "initial speed" }
AoA_0 = { start = "first(AoA)", unit = "rad", per = "maneuver", description = "initial angle of attack" }
pitch_start = { start = "first(pitch)", unit = "rad", per = "maneuver", description = "initial pitch attitude" }
rate_start = { start = "first(pitchrate)", unit = "rad/s", per = "maneuver", description = "initial pitch rate" }

[definitions]
force = { unit = "N", equation = "0.5*density*TAS^2*area", description = "dynamic pressure times area" }
rate_hat = { equation = "chord*pitchrate/(2*TAS_ref)" }
C_drag = { equation = "drag_0 + drag_speed*TAS/TAS_ref + drag_angle*AoA", description = "drag coefficient" }
C_lift = { equation = "lift_0 + lift_angle*AoA + lift_rate*rate_hat + lift_elev*elev", description = "lift coefficient" }
C_pitch = { equation = "pitch_0 + pitch_angle*AoA + pitch_rate*rate_hat + pitch_elev*elev", description = "pitching moment coefficient" }

[states.TAS]
unit = "m/s"
initial = "TAS_0"
derivative = "(jet*cos(AoA) - force*C_drag)/mass - g*sin(pitch - AoA)"
description = "true airspeed"

[states.AoA]
unit = "rad"
initial = "AoA_0"
derivative = "pitchrate - (force*C_lift + jet*sin(AoA))/(mass*TAS) + g/TAS*cos(pitch - AoA)"
description = "angle of attack"

[states.pitch]
unit = "rad"
initial = "pitch_start"
derivative = "pitchrate"
description = "pitch attitude"

[states.pitchrate]
unit = "rad/s"
initial = "rate_start"
derivative = "force*chord*C_pitch/inertia"
description = "pitch rate"

[outputs]
TAS = { unit = "m/s", equation = "TAS", description = "true airspeed" }
AoA = { unit = "rad", equation = "AoA", description = "angle of attack" }
pitch = { unit = "rad", equation = "pitch", description = "pitch attitude" }
pitchrate = { unit = "rad/s", equation = "pitchrate", description = "pitch rate" }
fwd_acc = { unit = "m/s^2", equation = "(force*(C_lift*sin(AoA) - C_drag*cos(AoA)) + jet)/mass", description = "specific force forward" }
down_acc = { unit = "m/s^2", equation = "-force*(C_lift*cos(AoA) + C_drag*sin(AoA))/mass", description = "specific force down" }
"#;

pub(super) fn make(random: &mut Random, replay: Option<&Replay>) -> Aircraft {
    let mut about = |value: f64| value * random.between(0.85, 1.15);
    let frame = Jet {
        drag: [about(0.025), about(0.01), about(0.35)],
        lift: [about(0.12), about(4.6), about(3.0)],
        pitch: [about(0.04), about(-0.8), about(-18.0), about(-1.3)],
    };
    let controls = [
        Control {
            surface: ELEVATOR,
            amplitude: 0.035,
            unit: 1.5,
            leads: true,
        },
        Control {
            surface: THRUST,
            amplitude: 1500.0,
            unit: 4.0,
            leads: false,
        },
    ];
    let sorties = sorties(
        &controls,
        [16.0, 34.0],
        |random| scene(SPEED, ALPHA, random),
        random,
        replay,
    );
    let channels = vec![
        Channel::new("elev", "deg", Quantity::Command(ELEVATOR), 0.002).given(),
        Channel::new("jet", "N", Quantity::Command(THRUST), 1.0).given(),
        Channel::new("TAS", "m/s", Quantity::Speed, 0.15),
        Channel::new("AoA", "deg", Quantity::Alpha, 0.06),
        Channel::new("pitch", "deg", Quantity::Theta, 0.05),
        Channel::new("pitchrate", "deg/s", Quantity::Q, 0.06),
        Channel::new("fwd_acc", "m/s^2", Quantity::Ax, 0.02),
        Channel::new("down_acc", "m/s^2", Quantity::Az, 0.06),
        Channel::new("sideslip", "deg", Quantity::Beta, 0.02).given(),
        Channel::new("rollrate", "deg/s", Quantity::P, 0.03).given(),
        Channel::new("yawrate", "deg/s", Quantity::R, 0.03).given(),
        Channel::new("altitude", "m", Quantity::Height, 0.5).given(),
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
    let all = "TAS+AoA+pitch+pitchrate+fwd_acc+down_acc";
    vec![
        sensor::bias("pitch", 0.002),
        sensor::bias("pitchrate", 0.001),
        sensor::bias("fwd_acc", 0.02),
        sensor::scale("AoA"),
        sensor::scale("TAS"),
        sensor::scale("pitchrate"),
        sensor::scale("down_acc"),
        sensor::drift("pitch", 2e-4),
        sensor::delay("AoA"),
        sensor::delay("TAS+AoA"),
        sensor::delay("fwd_acc+down_acc"),
        sensor::delay(all).or("input_delay", "elev", None),
        sensor::lag("TAS"),
        sensor::lag("AoA"),
        sensor::position("AoA", Quantity::Alpha, 'x'),
        sensor::position("down_acc", Quantity::Az, 'x'),
        sensor::position("fwd_acc", Quantity::Ax, 'z'),
        sensor::outliers("AoA"),
        sensor::outliers("TAS"),
        surface::scale("jet", THRUST),
        surface::delay("elev", ELEVATOR),
        surface::lag("elev", ELEVATOR),
        surface::rate_limit("elev", ELEVATOR),
        surface::backlash("elev", ELEVATOR),
        term(Slot::Drag, "C_drag", "AoA^2", 1.0, move |m| a(m).powi(2)),
        term(Slot::Pitch, "C_pitch", "AoA^2", 2.0, move |m| a(m).powi(2)),
        term(Slot::Lift, "C_lift", "AoA^2", -5.0, move |m| a(m).powi(2)),
        term(Slot::Lift, "C_lift", "elev", 0.3, |m| m.elevator()),
        term(Slot::Drag, "C_drag", "elev", 0.1, |m| m.elevator()),
        term(Slot::Pitch, "C_pitch", "TAS", 5e-4, |m| m.speed - SPEED),
        term(Slot::Pitch, "C_pitch", "AoA*pitchrate", 2.0, move |m| {
            a(m) * m.q
        }),
        term(Slot::Pitch, "C_pitch", "sideslip^2", 5.0, |m| {
            m.beta * m.beta
        }),
        unsteady(Slot::Pitch, "C_pitch", "AoA", -0.3, |m| m.alpha),
        stall(
            "C_lift+C_drag+C_pitch",
            "AoA",
            ALPHA + 0.06,
            |lost, _, added| {
                added[Slot::Lift as usize] -= 0.4 * lost;
                added[Slot::Drag as usize] += 0.05 * lost;
                added[Slot::Pitch as usize] -= 0.05 * lost;
            },
        ),
        turbulence("AoA", Angle::Alpha),
        gust("AoA", Angle::Alpha),
        sensor::structural_mode("down_acc", "elev", ELEVATOR, 5.0),
        sensor::cross_axis("pitchrate", "rollrate", Quantity::P),
        sensor::swapped("pitch", "AoA"),
    ]
}

fn unknown_faults() -> Vec<Fault> {
    let alpha = |m: &Motion| m.alpha;
    vec![
        unknown::saturation("elev", ELEVATOR, &["C_pitch"]),
        unknown::hinge_moment(Slot::Pitch, "C_pitch", 0.3, alpha),
        unknown::hysteresis(Slot::Lift, "C_lift", 0.1, alpha, |m| m.alphadot),
        unknown::wandering(Slot::Pitch, "C_pitch", 0.005),
        unknown::slosh(Slot::Pitch, "C_pitch", 0.1, alpha),
        unknown::ground_effect(Slot::Lift, "C_lift", "altitude", 0.1, 2000.0, 10.0),
        unknown::clock_drift("TAS"),
        unknown::vibration("down_acc", 0.1),
        unknown::in_one_flight(sensor::scale("AoA")),
        unknown::in_one_flight(term(Slot::Drag, "C_drag", "AoA^2", 1.0, |m| {
            (m.alpha - ALPHA).powi(2)
        })),
    ]
}
