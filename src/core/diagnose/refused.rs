//! Candidates that a round refused, with the reason.

use super::effect::Effect;
use super::null_model::{POWER, Threshold};
use super::report::{Refusal, RefusedEffect};
use super::screen::Screened;
use super::trial::Trial;

/// Below this share the declared parameters imitate an effect but for their own curvature: it counts as visible only
/// where even so a step promises much.
const INVISIBLE: f64 = 0.01;

/// A promise that curvature alone does not make.
const MUCH: f64 = 20.0;

/// Below this share what is left of an effect is rounding.
const ROUNDING: f64 = 1e-4;

pub(super) fn refused(
    effect: Effect,
    reason: Refusal,
    sentence: String,
    likelihood_ratio: Option<f64>,
    seen: Option<(&Screened, f64)>,
) -> RefusedEffect {
    RefusedEffect {
        effect,
        reason,
        sentence,
        likelihood_ratio,
        visible_fraction: seen.map(|(s, _)| s.visible),
        smallest_seen: seen.map(|(s, root)| s.one_sigma * (root + POWER)),
        held_out: None,
    }
}

pub(super) fn after_trial(
    trial: &Trial,
    reason: Refusal,
    why: String,
    threshold: &Threshold,
) -> RefusedEffect {
    let seen = trial
        .screened
        .as_ref()
        .map(|s| (s, threshold.of(1, 1).sqrt()));
    let held_out = trial.held_out.as_ref().map(|gains| gains.iter().sum());
    RefusedEffect {
        held_out,
        ..refused(
            trial.effect.clone(),
            reason,
            why,
            Some(trial.likelihood_ratio),
            seen,
        )
    }
}

pub(super) fn after_screen(
    effect: &Effect,
    screened: &Result<Screened, String>,
    threshold: &Threshold,
) -> RefusedEffect {
    let seen = match screened {
        Err(why) => return refused(effect.clone(), Refusal::NotFitted, why.clone(), None, None),
        Ok(seen) => seen,
    };
    let root = threshold.of(1, 1).sqrt();
    if !is_visible(screened) {
        let why = "the declared parameters imitate it: these data cannot show it, whether it is there or not";
        return RefusedEffect {
            smallest_seen: None,
            ..refused(
                effect.clone(),
                Refusal::Invisible,
                why.into(),
                None,
                Some((seen, root)),
            )
        };
    }
    let why = format!(
        "one linear step promises a likelihood ratio of {:.1}, no more than noise gives",
        seen.promise.max(0.0)
    );
    refused(
        effect.clone(),
        Refusal::NotSignificant,
        why,
        Some(seen.promise),
        Some((seen, root)),
    )
}

/// Whether a candidate can be seen at all.
pub(super) fn is_visible(screened: &Result<Screened, String>) -> bool {
    screened
        .as_ref()
        .is_ok_and(|s| s.visible >= INVISIBLE || (s.visible >= ROUNDING && s.promise > MUCH))
}
