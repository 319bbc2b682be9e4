//! Inputs as pilots and test engineers give them: continuous in time, and no faster than a hand.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::random::Random;
use crate::replay::Replay;

pub(crate) type Command = Arc<dyn Fn(f64) -> f64 + Send + Sync>;

pub(crate) fn still() -> Command {
    Arc::new(|_| 0.0)
}

/// From 0 to 1 in `rise` seconds, without a corner.
fn ramp(t: f64, rise: f64) -> f64 {
    let s = (t / rise).clamp(0.0, 1.0);
    s * s * s * (10.0 + s * (6.0 * s - 15.0))
}

/// Levels that follow each other at the given lengths; before and behind it is zero.
fn steps(start: f64, levels: Vec<(f64, f64)>, rise: f64) -> Command {
    Arc::new(move |t| {
        let (mut at, mut before, mut value) = (start, 0.0, 0.0);
        for &(length, level) in levels.iter().chain(&[(0.0, 0.0)]) {
            value += (level - before) * ramp(t - at, rise);
            (at, before) = (at + length, level);
        }
        value
    })
}

/// How a maneuver is flown.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Shape {
    Doublet,
    ThreeTwoOneOne,
    Steps,
    Sweep,
    Pilot,
    Replay,
}

impl Shape {
    pub(crate) const ALL: [Self; 6] = [
        Self::Doublet,
        Self::ThreeTwoOneOne,
        Self::Steps,
        Self::Sweep,
        Self::Pilot,
        Self::Replay,
    ];
}

/// What one control does in a maneuver: from `start` on, at most `amplitude` large, with a usual time of `unit` seconds.
pub(crate) struct Given<'r> {
    pub shape: Shape,
    pub start: f64,
    pub duration: f64,
    pub unit: f64,
    pub amplitude: f64,
    pub replay: Option<&'r Replay>,
    /// The control that a replay takes from a real flight.
    pub control: usize,
}

pub(crate) fn command(given: &Given<'_>, random: &mut Random) -> Command {
    let Given {
        start,
        duration,
        unit,
        amplitude,
        ..
    } = *given;
    let rise = random.between(0.18, 0.35);
    let unit = unit * random.between(0.85, 1.15);
    match (given.shape, given.replay) {
        (Shape::Doublet, _) => {
            let mut levels = vec![(unit, amplitude), (unit, -amplitude)];
            // once more the other way round, if there is time
            if start + 10.0 * unit < 0.7 * duration {
                let rest = 6.0 * unit;
                levels.extend([
                    (rest, 0.0),
                    (0.8 * unit, -amplitude),
                    (0.8 * unit, amplitude),
                ]);
            }
            steps(start, levels, rise)
        }
        (Shape::ThreeTwoOneOne, _) => {
            let a = amplitude;
            let short = 0.7 * unit;
            let levels = vec![
                (3.0 * short, 0.8 * a),
                (2.0 * short, -0.9 * a),
                (short, a),
                (short, -a),
            ];
            steps(start, levels, rise)
        }
        (Shape::Steps, _) => {
            let mut levels = Vec::new();
            let mut at = start;
            while at < duration - 2.0 {
                let length = unit * random.between(0.6, 2.2);
                levels.push((length, amplitude * random.between(-1.0, 1.0)));
                at += length;
            }
            steps(start, levels, rise)
        }
        (Shape::Sweep, _) => {
            let (slow, fast) = (0.15, (0.8 / unit).min(1.6));
            let length = duration - start - 1.0;
            Arc::new(move |t| {
                let s = (t - start).clamp(0.0, length);
                let phase = slow * s + (fast - slow) * s * s / (2.0 * length);
                let fade = ramp(t - start, 1.0) * ramp(start + length - t, 1.0);
                amplitude * fade * (TAU * phase).sin()
            })
        }
        (Shape::Replay, Some(replay)) => replay.command(given.control, start, amplitude, random),
        (Shape::Pilot | Shape::Replay, _) => {
            let waves: Vec<(f64, f64, f64)> = (0..9)
                .map(|_| {
                    let frequency = random.between(0.08, 0.9 / unit.max(0.6));
                    let height = random.normal() / (1.0 + (frequency / 0.4).powi(2)).sqrt();
                    (frequency, height, random.between(0.0, TAU))
                })
                .collect();
            let whole: f64 = waves
                .iter()
                .map(|(_, h, _)| h * h / 2.0)
                .sum::<f64>()
                .sqrt();
            Arc::new(move |t| {
                let sum: f64 = (waves.iter())
                    .map(|(f, h, phase)| h * (TAU * f * t + phase).sin())
                    .sum();
                0.55 * amplitude / whole * ramp(t - start, 1.5) * sum
            })
        }
    }
}
