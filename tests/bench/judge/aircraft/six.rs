//! A light aircraft in six degrees of freedom: velocities along the body's axes, coefficients, attitude, path.

use std::f64::consts::TAU;

use super::maneuvers::{Control, sample, scene, sorties};
use super::{Aircraft, both};
use crate::fault::Fault;
use crate::motion::{
    AILERON, Added, Airframe, Around, ELEVATOR, Motion, Quantity, RUDDER, Slot, THRUST, Trim,
};
use crate::random::Random;
use crate::record::Channel;
use crate::replay::Replay;

pub(super) const G: f64 = 9.80665;
const MASS: f64 = 1150.0;
const AREA: f64 = 16.0;
const SPAN: f64 = 10.8;
const CHORD: f64 = 1.5;
const RHO: f64 = 1.0;
const INERTIA: [f64; 3] = [1350.0, 2700.0, 3700.0];
const SPEED: f64 = 58.0;
pub(super) const ALPHA: f64 = 0.06;

struct Six {
    fwd: [f64; 3],
    side: [f64; 2],
    down: [f64; 4],
    roll: [f64; 5],
    pitch: [f64; 4],
    yaw: [f64; 5],
}

/// By number in the state.
pub(super) const W: usize = 2;
const HEIGHT: usize = 11;

impl Airframe for Six {
    fn start(&self) -> Vec<f64> {
        let mut x = vec![0.0; 12];
        (x[0], x[W], x[7], x[HEIGHT]) = (SPEED * ALPHA.cos(), SPEED * ALPHA.sin(), ALPHA, 500.0);
        x
    }

    fn rates(
        &self,
        x: &[f64],
        around: &Around<'_>,
        added: &Added,
        motion: &mut Motion,
        dx: &mut [f64],
    ) {
        let (u, v, w, p, q, r) = (x[0], x[1], x[2], x[3], x[4], x[5]);
        let (phi, theta, psi) = (x[6], x[7], x[8]);
        let speed = (u * u + v * v + w * w).sqrt();
        let (alpha, beta) = (w.atan2(u), (v / speed).asin());
        let qs = 0.5 * RHO * speed * speed * AREA;
        let (phat, qhat, rhat) = (
            SPAN * p / (2.0 * speed),
            CHORD * q / (2.0 * speed),
            SPAN * r / (2.0 * speed),
        );
        let (de, da, dr) = (motion.elevator(), motion.aileron(), motion.rudder());
        let plus = |slot: Slot| added[slot as usize];
        let fwd =
            self.fwd[0] + self.fwd[1] * alpha + self.fwd[2] * alpha * alpha + plus(Slot::Drag);
        let side = self.side[0] * beta + self.side[1] * dr + plus(Slot::Side);
        let down = self.down[0]
            + self.down[1] * alpha
            + self.down[2] * qhat
            + self.down[3] * de
            + plus(Slot::Lift);
        let moment = |c: &[f64; 5]| c[0] * beta + c[1] * phat + c[2] * rhat + c[3] * da + c[4] * dr;
        let roll = moment(&self.roll) + plus(Slot::Roll);
        let yaw = moment(&self.yaw) + plus(Slot::Yaw);
        let [cm0, cma, cmq, cmde] = self.pitch;
        let pitch = cm0 + cma * alpha + cmq * qhat + cmde * de + plus(Slot::Pitch);
        let ax = (qs * fwd + motion.surface[THRUST]) / MASS;
        let (ay, az) = (qs * side / MASS, qs * down / MASS);
        let ((sphi, cphi), (stheta, ctheta), (spsi, cpsi)) =
            (phi.sin_cos(), theta.sin_cos(), psi.sin_cos());
        // what changes of the wind comes to the velocity through the air with the other sign
        let [wn, we, wd] = around.air.wind_rate;
        let (ahead, aside) = (wn * cpsi + we * spsi, we * cpsi - wn * spsi);
        let gust = [
            ahead * ctheta - wd * stheta,
            aside * cphi + (ahead * stheta + wd * ctheta) * sphi,
            -aside * sphi + (ahead * stheta + wd * ctheta) * cphi,
        ];
        dx[0] = r * v - q * w - G * stheta + ax - gust[0];
        dx[1] = p * w - r * u + G * sphi * ctheta + ay - gust[1] + speed * around.air.beta_rate;
        dx[2] = q * u - p * v + G * cphi * ctheta + az - gust[2] + speed * around.air.alpha_rate;
        let [ix, iy, iz] = INERTIA;
        dx[3] = (qs * SPAN * roll - (iz - iy) * q * r) / ix;
        dx[4] = (qs * CHORD * pitch - (ix - iz) * p * r) / iy;
        dx[5] = (qs * SPAN * yaw - (iy - ix) * p * q) / iz;
        dx[6] = p + theta.tan() * (q * sphi + r * cphi);
        dx[7] = q * cphi - r * sphi;
        dx[8] = (q * sphi + r * cphi) / ctheta;
        let forward = u * ctheta + (v * sphi + w * cphi) * stheta;
        let sideways = v * cphi - w * sphi;
        let [wind_n, wind_e, wind_d] = around.air.wind;
        dx[9] = forward * cpsi - sideways * spsi + wind_n;
        dx[10] = forward * spsi + sideways * cpsi + wind_e;
        dx[HEIGHT] = u * stheta - (v * sphi + w * cphi) * ctheta - wind_d;
        (motion.speed, motion.alpha, motion.beta) = (speed, alpha, beta);
        motion.alphadot = (u * dx[2] - w * dx[0]) / (u * u + w * w);
        (motion.p, motion.q, motion.r) = (p, q, r);
        (motion.pdot, motion.qdot, motion.rdot) = (dx[3], dx[4], dx[5]);
        (motion.phi, motion.theta, motion.psi) = (phi, theta, psi);
        (motion.north, motion.east, motion.height) = (x[9], x[10], x[HEIGHT]);
        (motion.ax, motion.ay, motion.az) = (ax, ay, az);
    }

    fn trim(&self) -> Vec<(Trim, usize)> {
        vec![
            (Trim::Surface(THRUST), 0),
            (Trim::State(W), 2),
            (Trim::Surface(ELEVATOR), 4),
        ]
    }
}

fn frame(random: &mut Random) -> Six {
    let mut about = |value: f64| value * random.between(0.85, 1.15);
    Six {
        fwd: [about(-0.03), about(0.2), about(2.0)],
        side: [about(-0.5), about(0.14)],
        down: [about(-0.15), about(-4.6), about(-4.0), about(-0.4)],
        roll: [
            about(-0.08),
            about(-0.45),
            about(0.1),
            about(-0.16),
            about(0.012),
        ],
        pitch: [about(0.03), about(-0.75), about(-12.0), about(-1.1)],
        yaw: [about(0.075), about(-0.05), about(-0.11), 0.0, about(-0.07)],
    }
}

/// The aircraft with its flights; document, channels and faults are for the models that are declared of it.
pub(super) fn flown(
    document: &str,
    channels: Vec<Channel>,
    [faults, unknown]: [Vec<Fault>; 2],
    random: &mut Random,
    replay: Option<&Replay>,
) -> Aircraft {
    let frame = frame(random);
    let control = |surface, amplitude, unit, leads| Control {
        surface,
        amplitude,
        unit,
        leads,
    };
    let controls = [
        control(ELEVATOR, 0.05, 1.0, true),
        control(AILERON, 0.06, 1.2, true),
        control(RUDDER, 0.08, 1.2, true),
        control(THRUST, 300.0, 4.0, false),
    ];
    let sorties = sorties(
        &controls,
        [14.0, 24.0],
        |random| scene(SPEED, ALPHA, random),
        random,
        replay,
    );
    Aircraft {
        frame: Box::new(frame),
        document: document.to_string(),
        channels,
        sorties,
        sample: sample(random).clamp(0.02, 0.025),
        faults: both(faults, unknown),
    }
}

/// Slow changes of the wind, m/s and m/s^2, in one direction of north, east and down.
pub(super) fn ramp(direction: usize, by: f64) -> impl Fn(f64) -> crate::motion::Air {
    move |t| {
        let mut air = crate::motion::Air::default();
        air.wind[direction] = by * (1.0 - (TAU * t / 40.0).cos()) / 2.0;
        air.wind_rate[direction] = by * TAU / 80.0 * (TAU * t / 40.0).sin();
        air
    }
}

pub(super) fn attitude_and_rates(noise: f64) -> Vec<Channel> {
    vec![
        Channel::new("rollrate", "deg/s", Quantity::P, 0.15 * noise),
        Channel::new("pitchrate", "deg/s", Quantity::Q, 0.1 * noise),
        Channel::new("yawrate", "deg/s", Quantity::R, 0.08 * noise),
    ]
}

/// About the angle at which it flies.
pub(super) fn angle(m: &Motion) -> f64 {
    m.alpha - ALPHA
}
