//! Between the recorded deflection and the one that the air feels.

use crate::fault::{Answer, Fault, Sizing};
use crate::sensor_faults::{lagged, later};

fn surface(
    kind: &'static str,
    input: &str,
    surface: usize,
    sizing: Sizing,
    change: impl Fn(f64, &[f64], f64) -> Vec<f64> + Clone + 'static,
) -> Fault {
    Fault::new(
        Answer::new(kind, input, None),
        sizing,
        move |size, _, plant, _| {
            let change = change.clone();
            let moved = Box::new(move |u: &[f64], step: f64| change(size, u, step));
            plant.surfaces.push((surface, moved));
        },
    )
}

pub(crate) fn bias(input: &str, of: usize) -> Fault {
    let sizing = Sizing::Worth {
        guess: 0.005,
        most: 0.2,
    };
    surface("input_bias", input, of, sizing, |b, u, _| {
        u.iter().map(|u| u + b).collect()
    })
}

pub(crate) fn scale(input: &str, of: usize) -> Fault {
    let sizing = Sizing::Worth {
        guess: 0.1,
        most: 0.6,
    };
    surface("input_scale", input, of, sizing, |k, u, _| {
        u.iter().map(|u| (1.0 + k) * u).collect()
    })
}

pub(crate) fn delay(input: &str, of: usize) -> Fault {
    let sizing = Sizing::Worth {
        guess: 0.05,
        most: 0.4,
    };
    surface("input_delay", input, of, sizing, |by, u, step| {
        later(u, |_| by, step)
    })
    .positive()
}

pub(crate) fn lag(input: &str, of: usize) -> Fault {
    let sizing = Sizing::Worth {
        guess: 0.06,
        most: 1.0,
    };
    surface("actuator_lag", input, of, sizing, |time, u, step| {
        lagged(u, time, step)
    })
    .positive()
}

/// Its size is the inverse of the largest rate, so that a larger one is worse.
pub(crate) fn rate_limit(input: &str, of: usize) -> Fault {
    let sizing = Sizing::Worth {
        guess: 8.0,
        most: 200.0,
    };
    surface(
        "actuator_rate_limit",
        input,
        of,
        sizing,
        |inverse, u, step| {
            let most = step / inverse;
            let mut at = u[0];
            (u.iter())
                .map(|u| {
                    at += (u - at).clamp(-most, most);
                    at
                })
                .collect()
        },
    )
    .positive()
}

/// Play: the surface stays until the linkage takes it along.
pub(crate) fn backlash(input: &str, of: usize) -> Fault {
    let sizing = Sizing::Worth {
        guess: 0.004,
        most: 0.05,
    };
    surface("backlash", input, of, sizing, |half, u, _| {
        let mut at = u[0];
        (u.iter())
            .map(|u| {
                at = at.clamp(u - half, u + half);
                at
            })
            .collect()
    })
    .positive()
}
