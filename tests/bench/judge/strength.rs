//! Sizes of faults: by what they are worth to someone who knows them, as a likelihood ratio.

use serde_json::{Map, json};
use trimtab_core::job::JobResult;

use crate::case::{Setting, Sized};
use crate::fault::{Fault, Sizing};
use crate::job::estimate;
use crate::likelihood::{ln_likelihood_of_best_colour, of_histories, squares};
use crate::polish;
use crate::random::Random;

#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(crate) enum Strength {
    Clear,
    Moderate,
    Weak,
}

impl Strength {
    pub(crate) const ALL: [Self; 3] = [Self::Clear, Self::Moderate, Self::Weak];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Clear => "clear",
            Self::Moderate => "moderate",
            Self::Weak => "weak",
        }
    }

    /// Twice the logarithm of the likelihood ratio.
    fn range(self) -> (f64, f64) {
        match self {
            Self::Clear => (220.0, 700.0),
            Self::Moderate => (70.0, 180.0),
            Self::Weak => (28.0, 58.0),
        }
    }
}

/// How many times a size is tried.
const TRIES: usize = 9;

/// The size of a fault that has a strength, and what it is worth, where that is known; `None` where the model imitates
/// it, or no aircraft has that much of it.
pub(crate) fn size(
    setting: &Setting,
    fault: usize,
    strength: Strength,
) -> Option<(f64, Option<f64>)> {
    let mut random = Random::new(setting.seed, "strength");
    let (least, most) = strength.range();
    let wanted = least * (most / least).powf(random.uniform());
    let Fault { signed, sizing, .. } = setting.aircraft.faults[fault];
    let sign = if signed { random.sign() } else { 1.0 };
    let (size, worth) = match sizing {
        Sizing::Given(sizes) => return Some((sizes[2 - strength as usize], None)),
        Sizing::Worth { guess, most } => {
            // without the fault: what sampling makes of the inputs
            let none = worth(setting, &vec![])?;
            let of = |size: f64| Some(worth(setting, &vec![(fault, sign * size)])? - none);
            search(wanted, guess.abs(), most.abs(), of)?
        }
        Sizing::Disturbance { guess, most } => {
            let of = |size: f64| worth_of_disturbance(setting, fault, sign * size);
            search(wanted, guess, most, of)?
        }
    };
    Some((sign * size, Some(worth)))
}

/// A size above zero that is worth what is wanted, or nearly: worth grows with the square, or so.
fn search(
    wanted: f64,
    guess: f64,
    most: f64,
    worth: impl Fn(f64) -> Option<f64>,
) -> Option<(f64, f64)> {
    let (mut size, mut below, mut above) = (guess, 0.0_f64, f64::INFINITY);
    for _ in 0..TRIES {
        // what does not stay in the air is too large
        let found = worth(size).unwrap_or(f64::INFINITY);
        if (0.8 * wanted..1.25 * wanted).contains(&found) {
            return (size <= most).then_some((size, found));
        }
        if found < wanted {
            below = below.max(size);
        } else {
            above = above.min(size);
        }
        if below >= most {
            return None;
        }
        size *= (wanted / found.max(1e-3)).sqrt().clamp(0.1, 6.0);
        if above.is_finite() && !(below..above).contains(&size) {
            size = if below > 0.0 {
                (below * above).sqrt()
            } else {
                0.3 * above
            };
        }
    }
    None
}

/// Whether one of two faults, worth so much alone, is worth less beside the other than the weakest that is asked for: what
/// both leave is the sum of what each leaves, so that their worths are squares of lengths, and those of the sum give the
/// angle between them. Two arms that cancel are no case.
pub(crate) fn hide_each_other(one: f64, other: f64, both: f64) -> bool {
    let cosine = (both - one - other) / (2.0 * (one * other).sqrt());
    let beside = one.min(other) * (1.0 - (cosine * cosine).min(1.0));
    beside < Strength::Weak.range().0
}

/// Twice the logarithm of the likelihood ratio of knowing the faults: what is left of noise-free flights when the
/// declared model has done what it can.
pub(crate) fn worth(setting: &Setting, sized: &Sized) -> Option<f64> {
    let recordings = setting.flown(sized, false)?;
    let (options, noise) = (setting.known_noise(), setting.deviations());
    let left = polish::fitted(
        &setting.document,
        &recordings,
        &options,
        &setting.noises,
        Some(&noise),
    );
    Some(squares(&left.ok()?, &setting.noises, &noise))
}

/// The same of what disturbs a state: by the filter, against the best that coloured noise explains.
fn worth_of_disturbance(setting: &Setting, fault: usize, size: f64) -> Option<f64> {
    let recordings = setting.flown(&vec![(fault, size)], true)?;
    let plain = estimate(
        &setting.document,
        &recordings,
        &json!({"error_bounds": "conventional"}),
    )
    .ok()?;
    let target = &setting.aircraft.faults[fault].answers[0].target;
    let target = setting.renamed(target);
    let still: Map<String, serde_json::Value> = (setting.document.states.keys())
        .filter(|state| **state != target)
        .map(|state| (state.clone(), json!({"start": 0.0, "fixed": true})))
        .collect();
    let options = json!({"estimator": "filter_error", "error_bounds": "conventional", "process_noise": still});
    let filtered = estimate(&setting.document, &recordings, &options).ok()?;
    let of = |result: &JobResult| ln_likelihood_of_best_colour(&of_histories(&result.histories));
    Some((2.0 * (of(&filtered) - of(&plain))).max(0.0))
}
