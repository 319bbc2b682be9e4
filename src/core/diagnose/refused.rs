//! Candidates that were not accepted, with the reason.

use super::effect::Effect;
use super::report::{Refusal, RefusedEffect};
use super::screen::Screened;
use super::threshold::Threshold;
use super::trial::Trial;

/// Why a candidate is not accepted, and the reason in a sentence.
pub(super) type Objection = (Refusal, String);

/// One that could not be fitted at all.
pub(super) fn not_fitted(effect: Effect, why: String) -> RefusedEffect {
    untried(effect, Refusal::NotFitted, why)
}

/// One that the declared fit speaks against, so that it was not tried.
pub(super) fn not_significant(effect: Effect, why: String) -> RefusedEffect {
    untried(effect, Refusal::NotSignificant, why)
}

fn untried(effect: Effect, reason: Refusal, why: String) -> RefusedEffect {
    RefusedEffect {
        effect,
        reason,
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
    (reason, sentence): Objection,
    held_out: Option<f64>,
    threshold: Threshold,
) -> RefusedEffect {
    let screened = trial.screened.as_ref();
    // of what differs between flights, with a size for each
    let own = screened.filter(|s| reason == Refusal::NotRepeatable && s.differs());
    let ratio = own.map_or(trial.likelihood_ratio, |s| {
        s.own.max(trial.likelihood_ratio)
    });
    RefusedEffect {
        effect: trial.effect.clone(),
        reason,
        sentence,
        likelihood_ratio: Some(ratio),
        visible_fraction: screened.map(|s| s.visible),
        smallest_seen: screened.map(|s| threshold.smallest_seen(s.one_sigma)),
        held_out,
    }
}

/// One that the screen left out.
pub(super) fn after_screen(
    effect: &Effect,
    screened: &Screened,
    (reason, sentence): Objection,
    threshold: Threshold,
) -> RefusedEffect {
    let seen = reason != Refusal::Invisible;
    let promise = match reason {
        Refusal::NotRepeatable => screened.own,
        _ => screened.promise,
    };
    RefusedEffect {
        effect: effect.clone(),
        reason,
        sentence,
        likelihood_ratio: seen.then_some(promise),
        visible_fraction: Some(screened.visible),
        smallest_seen: seen.then(|| threshold.smallest_seen(screened.one_sigma)),
        held_out: None,
    }
}

/// Why a candidate is refused that is there in some flights alone.
pub(super) fn differs(in_all: f64, own: f64) -> String {
    format!(
        "it differs between maneuvers: with a size of its own in each one linear step promises a likelihood ratio of {own:.1}, with one for all {:.1}",
        in_all.max(0.0)
    )
}
