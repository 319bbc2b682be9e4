//! Sizes of faults: by what they are worth to someone who knows them, as a likelihood ratio.

use serde_json::{Map, json};

use crate::case::{Setting, Sized};
use crate::fault::Sizing;
use crate::job::estimate;
use crate::likelihood::{ln_likelihood_of_best_colour, residuals, squares};
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

/// The size of a fault that has a strength; `None` where the model imitates it, or no aircraft has that much of it.
pub(crate) fn size(setting: &Setting, fault: usize, strength: Strength) -> Option<f64> {
    let mut random = Random::new(setting.seed, "strength");
    let (least, most_worth) = strength.range();
    let wanted = least * (most_worth / least).powf(random.uniform());
    let sign = if setting.aircraft.faults[fault].signed {
        random.sign()
    } else {
        1.0
    };
    let (guess, most, disturbs) = match setting.aircraft.faults[fault].sizing {
        Sizing::Given(sizes) => return Some(sizes[2 - strength as usize]),
        Sizing::Worth { guess, most } => (guess, most, false),
        Sizing::Disturbance { guess, most } => (guess, most, true),
    };
    let mut size = sign * guess;
    // without the fault: what sampling and discrete inputs make
    let none = if disturbs {
        0.0
    } else {
        worth(setting, &vec![])?
    };
    let mut below = 0.0;
    let mut above = f64::INFINITY;
    for _ in 0..TRIES {
        let found = match disturbs {
            true => worth_of_disturbance(setting, fault, size),
            false => worth(setting, &vec![(fault, size)]).map(|w| w - none),
        };
        // what does not stay in the air is too large
        let found = found.unwrap_or(f64::INFINITY);
        if (0.8 * wanted..1.25 * wanted).contains(&found) {
            return (size.abs() <= most.abs()).then_some(size);
        }
        let now = size.abs();
        if found < wanted {
            below = now.max(below);
        } else {
            above = now.min(above);
        }
        if below >= most.abs() {
            return None;
        }
        let share = (wanted / found.max(1e-3)).sqrt().clamp(0.1, 6.0);
        let mut next = now * share;
        if above.is_finite() && !(below..above).contains(&next) || (found.is_infinite()) {
            next = if below > 0.0 {
                (below * above).sqrt()
            } else {
                0.3 * above
            };
        }
        size = sign * next;
    }
    None
}

/// Twice the logarithm of the likelihood ratio of knowing the faults: what is left of noise-free flights when the
/// declared model has done what it can.
pub(crate) fn worth(setting: &Setting, sized: &Sized) -> Option<f64> {
    let recordings = setting.flown(sized, false)?;
    let result = estimate(&setting.document, &recordings, &setting.known_noise()).ok()?;
    Some(squares(
        &residuals(&result),
        &setting.noises,
        &setting.deviations(),
    ))
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
    let of = |result| ln_likelihood_of_best_colour(&residuals(result));
    Some((2.0 * (of(&filtered) - of(&plain))).max(0.0))
}
