//! Instruments that do not read what is.

use std::f64::consts::TAU;

use crate::fault::{Answer, Fault, Sizing};
use crate::motion::{Motion, Quantity};
use crate::random::Random;

/// A fault whose reading depends on what the sensor would read, the motion and the time between values.
pub(crate) fn with_motion(
    kind: &'static str,
    channel: &str,
    sizing: Sizing,
    change: impl Fn(f64, &[f64], &[Motion], f64) -> Vec<f64> + Clone + 'static,
) -> Fault {
    let name = channel.to_string();
    Fault::new(
        Answer::new(kind, channel, None),
        sizing,
        move |size, _, plant, _| {
            let change = change.clone();
            let reading =
                Box::new(move |y: &[f64], m: &[Motion], step: f64| change(size, y, m, step));
            plant.sensors.push((name.clone(), reading));
        },
    )
}

fn each(y: &[f64], change: impl Fn(f64) -> f64) -> Vec<f64> {
    y.iter().map(|y| change(*y)).collect()
}

/// `guess` is a size in SI.
pub(crate) fn bias(channel: &str, guess: f64) -> Fault {
    let sizing = Sizing::Worth {
        guess,
        most: 50.0 * guess,
    };
    with_motion("sensor_bias", channel, sizing, |b, y, _, _| {
        each(y, |y| y + b)
    })
}

pub(crate) fn scale(channel: &str) -> Fault {
    let sizing = Sizing::Worth {
        guess: 0.08,
        most: 0.5,
    };
    with_motion("sensor_scale", channel, sizing, |k, y, _, _| {
        each(y, |y| (1.0 + k) * y)
    })
}

/// `guess` is per second.
pub(crate) fn drift(channel: &str, guess: f64) -> Fault {
    let sizing = Sizing::Worth {
        guess,
        most: 50.0 * guess,
    };
    with_motion("sensor_drift", channel, sizing, |d, y, m, _| {
        y.iter().zip(m).map(|(y, m)| y + d * m.time).collect()
    })
}

/// Values of a series later than they are, by what is said for each; its first value before that.
pub(crate) fn later(y: &[f64], by: impl Fn(usize) -> f64, step: f64) -> Vec<f64> {
    let last = y.len() - 1;
    (0..y.len())
        .map(|k| {
            let at = (k as f64 - by(k) / step).clamp(0.0, last as f64);
            let (i, s) = (at as usize, at.fract());
            y[i] + s * (y[(i + 1).min(last)] - y[i])
        })
        .collect()
}

const DELAY: Sizing = Sizing::Worth {
    guess: 0.06,
    most: 0.4,
};

/// One delay for all that share a clock, joined by `+`.
pub(crate) fn delay(channels: &str) -> Fault {
    let names: Vec<String> = channels.split('+').map(ToString::to_string).collect();
    let install = move |size: f64, _: usize, plant: &mut crate::plant::Plant, _: &mut Random| {
        for name in &names {
            let reading =
                Box::new(move |y: &[f64], _: &[Motion], step: f64| later(y, |_| size, step));
            plant.sensors.push((name.clone(), reading));
        }
    };
    Fault::new(Answer::new("sensor_delay", channels, None), DELAY, install).positive()
}

/// First-order lag, exact for a straight line between values.
pub(crate) fn lagged(y: &[f64], time: f64, step: f64) -> Vec<f64> {
    let a = (-step / time).exp();
    let mut state = y[0];
    let mut before = y[0];
    (y.iter())
        .map(|&now| {
            let slope = (now - before) / step;
            state = now - slope * time + (state - before + slope * time) * a;
            before = now;
            state
        })
        .collect()
}

pub(crate) fn lag(channel: &str) -> Fault {
    let sizing = Sizing::Worth {
        guess: 0.08,
        most: 1.5,
    };
    with_motion("sensor_lag", channel, sizing, |time, y, _, step| {
        lagged(y, time, step)
    })
    .positive()
}

/// A vane or an accelerometer some metres from where it is thought to be.
pub(crate) fn position(channel: &str, quantity: Quantity, axis: char) -> Fault {
    let error = move |arm: f64, m: &Motion| {
        let (p, q, r) = (m.p, m.q, m.r);
        let v = m.speed;
        arm * match (quantity, axis) {
            (Quantity::Alpha, 'x') => -q / v,
            (Quantity::Alpha, _) => p / v,
            (Quantity::Beta, 'x') => r / v,
            (Quantity::Beta, _) => -p / v,
            (Quantity::Ax, 'x') => -q * q - r * r,
            (Quantity::Ax, 'y') => p * q - m.rdot,
            (Quantity::Ax, _) => p * r + m.qdot,
            (Quantity::Ay, 'x') => p * q + m.rdot,
            (Quantity::Ay, 'y') => -p * p - r * r,
            (Quantity::Ay, _) => q * r - m.pdot,
            (Quantity::Az, 'x') => p * r - m.qdot,
            (Quantity::Az, 'y') => q * r + m.pdot,
            _ => -p * p - q * q,
        }
    };
    let name = channel.to_string();
    let answer = Answer::new("sensor_position", channel, Some(&axis.to_string()));
    let sizing = Sizing::Worth {
        guess: 2.0,
        most: 20.0,
    };
    Fault::new(answer, sizing, move |arm, _, plant, _| {
        let reading = Box::new(move |y: &[f64], m: &[Motion], _: f64| {
            y.iter().zip(m).map(|(y, m)| y + error(arm, m)).collect()
        });
        plant.sensors.push((name.clone(), reading));
    })
}

/// A sensor that is not quite on its axis: it sees another motion too.
pub(crate) fn cross_axis(channel: &str, other: &str, seen: Quantity) -> Fault {
    let sizing = Sizing::Worth {
        guess: 0.05,
        most: 0.25,
    };
    let fault = with_motion(
        "sensor_cross_axis",
        channel,
        sizing,
        move |share, y, m, _| {
            y.iter()
                .zip(m)
                .map(|(y, m)| y + share * m.of(seen))
                .collect()
        },
    );
    Fault {
        name: format!("sensor_cross_axis {channel} sees {other}"),
        answers: vec![Answer::new("sensor_cross_axis", channel, Some(other))],
        ..fault
    }
}

/// Two channels under each other's name.
pub(crate) fn swapped(a: &str, b: &str) -> Fault {
    let names = (a.to_string(), b.to_string());
    let fault = Fault::new(
        Answer::new("swapped_channels", &format!("{a}+{b}"), None),
        Sizing::Given([1.0; 3]),
        move |_, _, plant, _| {
            plant.swapped = Some(names.clone());
        },
    );
    fault.positive()
}

/// Spikes of 7 to 15 noise deviations; the size is how many there are in a flight. With a stuck stretch at times.
pub(crate) fn outliers(channel: &str) -> Fault {
    let name = channel.to_string();
    let answer = Answer::new("sensor_outliers", channel, None);
    let sizing = Sizing::Given([4.0, 10.0, 30.0]);
    let fault = Fault::new(answer, sizing, move |count, _, plant, random| {
        let seed = random.index(1 << 30) as u64;
        let spoil = move |y: &mut [f64], noise: f64| {
            let mut random = Random::new(seed, "spikes");
            for _ in 0..count as usize {
                let k = random.index(y.len());
                y[k] += random.sign() * random.between(7.0, 15.0) * noise;
            }
        };
        plant.records.push((name.clone(), Box::new(spoil)));
    });
    fault.positive()
}

/// A lightly damped mode that a control shakes, on top of what the sensor sees.
pub(crate) fn structural_mode(channel: &str, control: &str, surface: usize, guess: f64) -> Fault {
    let name = channel.to_string();
    let answer = Answer::new("structural_mode", channel, Some(control));
    let sizing = Sizing::Worth {
        guess,
        most: 100.0 * guess,
    };
    Fault::new(answer, sizing, move |gain, _, plant, _| {
        let (frequency, damping) = (TAU * 2.2, 0.04);
        let reading = Box::new(move |y: &[f64], m: &[Motion], step: f64| {
            let first = m[0].command[surface];
            let (mut place, mut rate) = (0.0, 0.0);
            (y.iter().zip(m))
                .map(|(y, m)| {
                    let now = place;
                    let u = gain * (m.command[surface] - first);
                    rate += step
                        * (frequency * frequency * (u - place) - 2.0 * damping * frequency * rate);
                    place += step * rate;
                    y + now
                })
                .collect()
        });
        plant.sensors.push((name.clone(), reading));
    })
}
