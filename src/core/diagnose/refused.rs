//! Candidates that were not accepted, with the reason.

use super::effect::Effect;
use super::report::{Refusal, RefusedEffect};
use super::screen::Screened;
use super::threshold::Threshold;
use super::trial::Trial;

/// One that could not be fitted at all.
pub(super) fn not_fitted(effect: Effect, why: String) -> RefusedEffect {
    RefusedEffect {
        effect,
        reason: Refusal::NotFitted,
        sentence: why,
        likelihood_ratio: None,
        visible_fraction: None,
        smallest_seen: None,
        held_out: None,
    }
}

/// One that was tried; `held_out` is its gain on flights that were not fitted.
pub(super) fn after_trial(
    trial: &Trial,
    (reason, sentence): (Refusal, String),
    held_out: Option<f64>,
    threshold: Threshold,
) -> RefusedEffect {
    let screened = trial.screened.as_ref();
    RefusedEffect {
        effect: trial.effect.clone(),
        reason,
        sentence,
        likelihood_ratio: Some(trial.likelihood_ratio),
        visible_fraction: screened.map(|s| s.visible),
        smallest_seen: screened.map(|s| threshold.smallest_seen(s.one_sigma)),
        held_out,
    }
}

/// One that the screen left out.
pub(super) fn after_screen(
    effect: &Effect,
    screened: &Screened,
    (reason, sentence): (Refusal, String),
    threshold: Threshold,
) -> RefusedEffect {
    let seen = reason != Refusal::Invisible;
    RefusedEffect {
        effect: effect.clone(),
        reason,
        sentence,
        likelihood_ratio: seen.then_some(screened.promise),
        visible_fraction: Some(screened.visible),
        smallest_seen: seen.then(|| threshold.smallest_seen(screened.one_sigma)),
        held_out: None,
    }
}
