//! Flight path reconstruction: recorded forces and rates drive the kinematics, and what is left over are instruments
//! and wind.

use super::six::{attitude_and_rates, flown, ramp};
use super::{Aircraft, unknown};
use crate::fault::{Answer, Fault, Sizing};
use crate::motion::{Air, Quantity};
use crate::random::Random;
use crate::record::Channel;
use crate::replay::Replay;
use crate::sensor_faults as sensor;

pub(super) const USUAL: &[(&str, &str)] = &[
    ("ub", "u"),
    ("vb", "v"),
    ("wb", "w"),
    ("rollrate", "p"),
    ("pitchrate", "q"),
    ("yawrate", "r"),
    ("bank", "phi"),
    ("pitch", "theta"),
    ("heading", "psi"),
    ("TAS", "V"),
    ("AoA", "alpha"),
    ("sideslip", "beta"),
    ("fx", "ax"),
    ("fy", "ay"),
    ("fz", "az"),
    ("north", "x"),
    ("east", "y"),
    ("altitude", "h"),
];

const DOCUMENT: &str = r#"
name = "path-from-inertial-data"
title = "Flight path from accelerometers and gyros, against air data, attitude and position"

[constants]
g = { value = 9.80665, unit = "m/s^2" }

[inputs]
fx = { unit = "m/s^2", description = "specific force forward" }
fy = { unit = "m/s^2", description = "specific force to the right" }
fz = { unit = "m/s^2", description = "specific force down" }
rollrate = { unit = "rad/s", description = "roll rate" }
pitchrate = { unit = "rad/s", description = "pitch rate" }
yawrate = { unit = "rad/s", description = "yaw rate" }

[parameters]
roll_gyro = { start = 0.0, unit = "deg/s", description = "bias of the roll rate gyro" }
pitch_gyro = { start = 0.0, unit = "deg/s", description = "bias of the pitch rate gyro" }
yaw_gyro = { start = 0.0, unit = "deg/s", description = "bias of the yaw rate gyro" }
V0 = { start = "first(TAS)", unit = "m/s", per = "maneuver", description = "initial speed" }
A0 = { start = "first(AoA)", unit = "rad", per = "maneuver", description = "initial angle of attack" }
B0 = { start = "first(sideslip)", unit = "rad", per = "maneuver", description = "initial sideslip" }
bank_0 = { start = "first(bank)", unit = "rad", per = "maneuver", description = "initial bank angle" }
pitch_0 = { start = "first(pitch)", unit = "rad", per = "maneuver", description = "initial pitch attitude" }
heading_0 = { start = "first(heading)", unit = "rad", per = "maneuver", description = "initial heading" }
north_0 = { start = "first(north)", unit = "m", per = "maneuver", description = "initial position" }
east_0 = { start = "first(east)", unit = "m", per = "maneuver", description = "initial position" }
altitude_0 = { start = "first(altitude)", unit = "m", per = "maneuver", description = "initial altitude" }

[definitions]
roll = { unit = "rad/s", equation = "rollrate - roll_gyro" }
nose = { unit = "rad/s", equation = "pitchrate - pitch_gyro" }
turn = { unit = "rad/s", equation = "yawrate - yaw_gyro" }
forward = { unit = "m/s", equation = "ub*cos(pitch) + (vb*sin(bank) + wb*cos(bank))*sin(pitch)", description = "horizontal velocity along the heading" }
sideways = { unit = "m/s", equation = "vb*cos(bank) - wb*sin(bank)", description = "horizontal velocity to the right" }

[states]
ub = { unit = "m/s", initial = "V0*cos(A0)*cos(B0)", derivative = "turn*vb - nose*wb - g*sin(pitch) + fx", description = "velocity forward" }
vb = { unit = "m/s", initial = "V0*sin(B0)", derivative = "roll*wb - turn*ub + g*sin(bank)*cos(pitch) + fy", description = "velocity to the right" }
wb = { unit = "m/s", initial = "V0*sin(A0)*cos(B0)", derivative = "nose*ub - roll*vb + g*cos(bank)*cos(pitch) + fz", description = "velocity down" }
bank = { unit = "rad", initial = "bank_0", derivative = "roll + tan(pitch)*(nose*sin(bank) + turn*cos(bank))", description = "bank angle" }
pitch = { unit = "rad", initial = "pitch_0", derivative = "nose*cos(bank) - turn*sin(bank)", description = "pitch attitude" }
heading = { unit = "rad", initial = "heading_0", derivative = "(nose*sin(bank) + turn*cos(bank))/cos(pitch)", description = "heading" }
north = { unit = "m", initial = "north_0", derivative = "forward*cos(heading) - sideways*sin(heading)", description = "position north" }
east = { unit = "m", initial = "east_0", derivative = "forward*sin(heading) + sideways*cos(heading)", description = "position east" }
altitude = { unit = "m", initial = "altitude_0", derivative = "ub*sin(pitch) - (vb*sin(bank) + wb*cos(bank))*cos(pitch)", description = "altitude" }

[outputs]
TAS = { unit = "m/s", equation = "sqrt(ub^2 + vb^2 + wb^2)", description = "true airspeed" }
AoA = { unit = "rad", equation = "atan2(wb, ub)", description = "angle of attack" }
sideslip = { unit = "rad", equation = "asin(vb/sqrt(ub^2 + vb^2 + wb^2))", description = "angle of sideslip" }
bank = { unit = "rad", equation = "bank", description = "bank angle" }
pitch = { unit = "rad", equation = "pitch", description = "pitch attitude" }
heading = { unit = "rad", equation = "heading", description = "heading" }
north = { unit = "m", equation = "north", description = "position north" }
east = { unit = "m", equation = "east", description = "position east" }
altitude = { unit = "m", equation = "altitude", description = "altitude" }
"#;

pub(super) fn make(random: &mut Random, replay: Option<&Replay>) -> Aircraft {
    let mut channels = vec![
        Channel::new("fx", "m/s^2", Quantity::Ax, 0.01).given(),
        Channel::new("fy", "m/s^2", Quantity::Ay, 0.01).given(),
        Channel::new("fz", "m/s^2", Quantity::Az, 0.02).given(),
    ];
    channels.extend(attitude_and_rates(0.15).into_iter().map(Channel::given));
    channels.extend([
        Channel::new("TAS", "m/s", Quantity::Speed, 0.2),
        Channel::new("AoA", "deg", Quantity::Alpha, 0.1),
        Channel::new("sideslip", "deg", Quantity::Beta, 0.1),
        Channel::new("bank", "deg", Quantity::Phi, 0.15),
        Channel::new("pitch", "deg", Quantity::Theta, 0.1),
        Channel::new("heading", "deg", Quantity::Psi, 0.2),
        Channel::new("north", "m", Quantity::North, 0.8),
        Channel::new("east", "m", Quantity::East, 0.8),
        Channel::new("altitude", "m", Quantity::Height, 0.8),
    ]);
    flown(
        DOCUMENT,
        channels,
        [faults(), unknown_faults()],
        random,
        replay,
    )
}

const NAMES: [&str; 3] = ["north", "east", "down"];

/// The model has no wind, so that its name is the diagnosis's.
fn wind(term: &'static str, direction: usize, guess: f64) -> Fault {
    let answer = Answer::new("wind", "*", Some(term));
    let sizing = Sizing::Worth { guess, most: 60.0 };
    let fault = Fault::new(answer, sizing, move |size, _, plant, _| {
        if term == "constant" {
            plant.air.push(Box::new(move |_| {
                let mut air = Air::default();
                air.wind[direction] = size;
                air
            }));
        } else {
            plant.air.push(Box::new(ramp(direction, size)));
        }
    });
    Fault {
        name: format!("wind {term} {}", NAMES[direction]),
        ..fault
    }
}

fn faults() -> Vec<Fault> {
    vec![
        wind("constant", 0, 2.0),
        wind("constant", 1, 2.0),
        wind("constant", 2, 1.0),
        wind("ramp", 0, 2.0),
        wind("ramp", 2, 1.0),
        sensor::bias("fx", 0.02).or("input_bias", "fx", None),
        sensor::bias("fz", 0.02).or("input_bias", "fz", None),
        sensor::bias("AoA", 0.002),
        sensor::bias("sideslip", 0.002),
        sensor::bias("pitch", 0.002),
        sensor::scale("AoA"),
        sensor::scale("TAS"),
        sensor::scale("fz").or("input_scale", "fz", None),
        sensor::scale("yawrate").or("input_scale", "yawrate", None),
        sensor::scale("rollrate").or("input_scale", "rollrate", None),
        sensor::drift("pitch", 2e-4),
        sensor::delay("TAS+AoA+sideslip"),
        sensor::delay("bank+pitch+heading"),
        sensor::delay("north+east+altitude"),
        sensor::delay("AoA"),
        sensor::lag("TAS"),
        sensor::position("AoA", Quantity::Alpha, 'x'),
        sensor::position("sideslip", Quantity::Beta, 'x'),
        sensor::outliers("altitude"),
        sensor::outliers("AoA"),
        sensor::cross_axis("sideslip", "AoA", Quantity::Alpha),
        sensor::swapped("bank", "pitch"),
    ]
}

fn unknown_faults() -> Vec<Fault> {
    vec![
        unknown::clock_drift("TAS"),
        unknown::clock_drift("bank"),
        unknown::vibration("AoA", 0.002),
        unknown::in_one_flight(sensor::scale("TAS")),
        unknown::in_one_flight(sensor::bias("AoA", 0.003)),
    ]
}
