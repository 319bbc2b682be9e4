//! Six degrees of freedom declared by velocities along the body's axes; flow angles are definitions.

use super::six::{angle, attitude_and_rates, flown};
use super::{Aircraft, unknown};
use crate::air_faults::{Angle, gust, turbulence};
use crate::fault::Fault;
use crate::force_faults::{term, unsteady};
use crate::motion::{AILERON, ELEVATOR, Quantity, RUDDER, Slot, THRUST};
use crate::random::Random;
use crate::record::Channel;
use crate::replay::Replay;
use crate::{sensor_faults as sensor, surface_faults as surface};

pub(super) const USUAL: &[(&str, &str)] = &[
    ("ub", "u"),
    ("vb", "v"),
    ("wb", "w"),
    ("rollrate", "p"),
    ("pitchrate", "q"),
    ("yawrate", "r"),
    ("bank", "phi"),
    ("pitch", "theta"),
    ("TAS", "V"),
    ("AoA", "alpha"),
    ("sideslip", "beta"),
    ("fwd_acc", "ax"),
    ("lat_acc", "ay"),
    ("down_acc", "az"),
    ("elev", "de"),
    ("ail", "da"),
    ("rud", "dr"),
    ("engine", "thrust"),
    ("C_fwd", "Cx"),
    ("C_side", "Cy"),
    ("C_down", "Cz"),
    ("C_roll", "Cl"),
    ("C_pitch", "Cm"),
    ("C_yaw", "Cn"),
];

const DOCUMENT: &str = r#"
name = "light-aircraft-body-axes"
title = "A light aircraft in six degrees of freedom"

[constants]
g = { value = 9.80665, unit = "m/s^2" }
density = { value = 1.0, unit = "kg/m^3" }
mass = { value = 1150.0, unit = "kg" }
area = { value = 16.0, unit = "m^2" }
span = { value = 10.8, unit = "m" }
chord = { value = 1.5, unit = "m" }
Ixx = { value = 1350.0, unit = "kg*m^2" }
Iyy = { value = 2700.0, unit = "kg*m^2" }
Izz = { value = 3700.0, unit = "kg*m^2" }

[inputs]
elev = { unit = "rad", description = "elevator deflection" }
ail = { unit = "rad", description = "aileron deflection" }
rud = { unit = "rad", description = "rudder deflection" }
engine = { unit = "N", description = "thrust" }

[parameters]
X0 = { start = -0.04, description = "force forward" }
X1 = { start = 0.15, description = "force forward due to angle of attack" }
X2 = { start = 1.5, description = "force forward due to the square of the angle of attack" }
Y1 = { start = -0.45, description = "side force due to sideslip" }
Y2 = { start = 0.1, description = "side force due to rudder" }
Z0 = { start = -0.2, description = "force down" }
Z1 = { start = -4.2, description = "force down due to angle of attack" }
Z2 = { start = -3.0, description = "force down due to pitch rate" }
Z3 = { start = -0.3, description = "force down due to elevator" }
L1 = { start = -0.07, description = "rolling moment due to sideslip" }
L2 = { start = -0.4, description = "roll damping" }
L3 = { start = 0.08, description = "rolling moment due to yaw rate" }
L4 = { start = -0.14, description = "rolling moment due to aileron" }
L5 = { start = 0.01, description = "rolling moment due to rudder" }
M0 = { start = 0.02, description = "pitching moment" }
M1 = { start = -0.6, description = "pitching moment due to angle of attack" }
M2 = { start = -10.0, description = "pitch damping" }
M3 = { start = -1.0, description = "pitching moment due to elevator" }
N1 = { start = 0.06, description = "yawing moment due to sideslip" }
N2 = { start = -0.04, description = "yawing moment due to roll rate" }
N3 = { start = -0.1, description = "yaw damping" }
N5 = { start = -0.06, description = "yawing moment due to rudder" }
V0 = { start = "first(TAS)", unit = "m/s", per = "maneuver", description = "initial speed" }
A0 = { start = "first(AoA)", unit = "rad", per = "maneuver", description = "initial angle of attack" }
B0 = { start = "first(sideslip)", unit = "rad", per = "maneuver", description = "initial sideslip" }
bank_0 = { start = "first(bank)", unit = "rad", per = "maneuver", description = "initial bank angle" }
pitch_0 = { start = "first(pitch)", unit = "rad", per = "maneuver", description = "initial pitch attitude" }

[definitions]
TAS = { unit = "m/s", equation = "sqrt(ub^2 + vb^2 + wb^2)", description = "true airspeed" }
AoA = { unit = "rad", equation = "atan2(wb, ub)", description = "angle of attack" }
sideslip = { unit = "rad", equation = "asin(vb/TAS)", description = "angle of sideslip" }
force = { unit = "N", equation = "0.5*density*TAS^2*area", description = "dynamic pressure times area" }
roll_hat = { equation = "span*rollrate/(2*TAS)" }
pitch_hat = { equation = "chord*pitchrate/(2*TAS)" }
yaw_hat = { equation = "span*yawrate/(2*TAS)" }
C_fwd = { equation = "X0 + X1*AoA + X2*AoA^2", description = "force coefficient forward" }
C_side = { equation = "Y1*sideslip + Y2*rud", description = "side force coefficient" }
C_down = { equation = "Z0 + Z1*AoA + Z2*pitch_hat + Z3*elev", description = "force coefficient down" }
C_roll = { equation = "L1*sideslip + L2*roll_hat + L3*yaw_hat + L4*ail + L5*rud", description = "rolling moment coefficient" }
C_pitch = { equation = "M0 + M1*AoA + M2*pitch_hat + M3*elev", description = "pitching moment coefficient" }
C_yaw = { equation = "N1*sideslip + N2*roll_hat + N3*yaw_hat + N5*rud", description = "yawing moment coefficient" }
fwd_acc = { unit = "m/s^2", equation = "(force*C_fwd + engine)/mass", description = "specific force forward" }
lat_acc = { unit = "m/s^2", equation = "force*C_side/mass", description = "specific force to the right" }
down_acc = { unit = "m/s^2", equation = "force*C_down/mass", description = "specific force down" }

[states]
ub = { unit = "m/s", initial = "V0*cos(A0)*cos(B0)", derivative = "yawrate*vb - pitchrate*wb - g*sin(pitch) + fwd_acc", description = "velocity forward" }
vb = { unit = "m/s", initial = "V0*sin(B0)", derivative = "rollrate*wb - yawrate*ub + g*sin(bank)*cos(pitch) + lat_acc", description = "velocity to the right" }
wb = { unit = "m/s", initial = "V0*sin(A0)*cos(B0)", derivative = "pitchrate*ub - rollrate*vb + g*cos(bank)*cos(pitch) + down_acc", description = "velocity down" }
rollrate = { unit = "rad/s", initial = "0", derivative = "(force*span*C_roll - (Izz - Iyy)*pitchrate*yawrate)/Ixx", description = "roll rate" }
pitchrate = { unit = "rad/s", initial = "0", derivative = "(force*chord*C_pitch - (Ixx - Izz)*rollrate*yawrate)/Iyy", description = "pitch rate" }
yawrate = { unit = "rad/s", initial = "0", derivative = "(force*span*C_yaw - (Iyy - Ixx)*rollrate*pitchrate)/Izz", description = "yaw rate" }
bank = { unit = "rad", initial = "bank_0", derivative = "rollrate + tan(pitch)*(pitchrate*sin(bank) + yawrate*cos(bank))", description = "bank angle" }
pitch = { unit = "rad", initial = "pitch_0", derivative = "pitchrate*cos(bank) - yawrate*sin(bank)", description = "pitch attitude" }

[outputs]
TAS = { unit = "m/s", equation = "TAS", description = "true airspeed" }
AoA = { unit = "rad", equation = "AoA", description = "angle of attack" }
sideslip = { unit = "rad", equation = "sideslip", description = "angle of sideslip" }
rollrate = { unit = "rad/s", equation = "rollrate", description = "roll rate" }
pitchrate = { unit = "rad/s", equation = "pitchrate", description = "pitch rate" }
yawrate = { unit = "rad/s", equation = "yawrate", description = "yaw rate" }
bank = { unit = "rad", equation = "bank", description = "bank angle" }
pitch = { unit = "rad", equation = "pitch", description = "pitch attitude" }
lat_acc = { unit = "m/s^2", equation = "lat_acc", description = "specific force to the right" }
down_acc = { unit = "m/s^2", equation = "down_acc", description = "specific force down" }
"#;

pub(super) fn make(random: &mut Random, replay: Option<&Replay>) -> Aircraft {
    let mut channels = vec![
        Channel::new("elev", "deg", Quantity::Command(ELEVATOR), 0.002).given(),
        Channel::new("ail", "deg", Quantity::Command(AILERON), 0.003).given(),
        Channel::new("rud", "deg", Quantity::Command(RUDDER), 0.003).given(),
        Channel::new("engine", "N", Quantity::Command(THRUST), 2.0).given(),
        Channel::new("TAS", "m/s", Quantity::Speed, 0.15),
        Channel::new("AoA", "deg", Quantity::Alpha, 0.08),
        Channel::new("sideslip", "deg", Quantity::Beta, 0.08),
    ];
    channels.extend(attitude_and_rates(1.0));
    channels.extend([
        Channel::new("bank", "deg", Quantity::Phi, 0.1),
        Channel::new("pitch", "deg", Quantity::Theta, 0.08),
        Channel::new("lat_acc", "m/s^2", Quantity::Ay, 0.03),
        Channel::new("down_acc", "m/s^2", Quantity::Az, 0.08),
    ]);
    flown(
        DOCUMENT,
        channels,
        [faults(), unknown_faults()],
        random,
        replay,
    )
}

fn faults() -> Vec<Fault> {
    vec![
        sensor::bias("sideslip", 0.003),
        sensor::bias("pitchrate", 0.002),
        sensor::scale("yawrate"),
        sensor::scale("AoA"),
        sensor::delay("AoA+sideslip+TAS"),
        sensor::delay("rollrate+pitchrate+yawrate"),
        sensor::lag("AoA"),
        sensor::position("AoA", Quantity::Alpha, 'x'),
        sensor::position("sideslip", Quantity::Beta, 'x'),
        sensor::position("lat_acc", Quantity::Ay, 'x'),
        sensor::outliers("sideslip"),
        surface::scale("engine", THRUST),
        surface::lag("elev", ELEVATOR),
        surface::rate_limit("ail", AILERON),
        surface::backlash("elev", ELEVATOR),
        term(Slot::Pitch, "C_pitch", "AoA^2", 2.0, |m| angle(m).powi(2)),
        term(Slot::Yaw, "C_yaw", "ail", 0.01, |m| m.aileron()),
        term(Slot::Side, "C_side", "roll_hat", 0.1, |m| {
            m.p * 10.8 / (2.0 * m.speed)
        })
        .or("missing_term", "C_side", Some("rollrate")),
        term(Slot::Roll, "C_roll", "AoA*sideslip", 1.0, |m| {
            m.alpha * m.beta
        }),
        term(Slot::Yaw, "C_yaw", "sideslip*abs(sideslip)", 0.2, |m| {
            m.beta * m.beta.abs()
        }),
        unsteady(Slot::Pitch, "C_pitch", "AoA", -0.5, |m| m.alpha),
        turbulence("wb", Angle::Alpha).or("process_noise", "AoA", None),
        gust("AoA", Angle::Alpha).or("gust", "wb", None),
        sensor::structural_mode("down_acc", "elev", ELEVATOR, 5.0),
        sensor::cross_axis("yawrate", "rollrate", Quantity::P),
    ]
}

fn unknown_faults() -> Vec<Fault> {
    vec![
        unknown::saturation("ail", AILERON, &["C_roll"]),
        unknown::hinge_moment(Slot::Yaw, "C_yaw", 0.03, |m| m.beta),
        unknown::hysteresis(Slot::Pitch, "C_pitch", 0.3, |m| m.alpha, |m| m.alphadot),
        unknown::wandering(Slot::Pitch, "C_pitch", 0.004),
        unknown::slosh(Slot::Roll, "C_roll", 0.05, |m| m.ay / 9.8),
        unknown::clock_drift("AoA"),
        unknown::in_one_flight(sensor::scale("AoA")),
    ]
}
