//! Closing the loop: what a model cannot explain, which effect it lacks, and what the error is with that effect added.
//!
//! [`diagnose`] fits the declared model, and goes in rounds: it screens the catalogue of effects against the residual
//! (projecting out all that the declared parameters can imitate, the residual whitened), fits what is promising,
//! accepts an effect that is significant by a colour-aware likelihood, within its physical range, alike in all parts
//! of the data, and that is borne out by flights which were not fitted, as far as chance allows. What the data cannot tell apart is one alias
//! group, what they cannot show is reported as invisible. An [`Effect`] is an edit of the model document, so that
//! what results is a document again.
//!
//! Invariant: no decision looks at flights of the role `Final`, and every candidate is accepted or refused with a reason.

mod accepted;
mod answer;
mod beside_noise;
mod candidates;
mod case;
mod colour;
mod declared;
mod difference;
mod disturbed;
mod effect;
mod elsewhere;
mod fitted;
mod flight;
mod found;
mod gate;
mod group;
mod inconclusive;
mod knowledge;
mod lines;
mod null_model;
mod outliers;
mod passed;
mod plausible;
mod polish;
mod predicted;
mod projection;
mod refused;
mod remarks;
mod repeats;
mod report;
mod residual;
mod review;
mod rival;
mod round;
mod screen;
mod sentence;
mod share_left;
mod size;
mod spikes;
mod stack;
mod starts;
mod swapped;
#[cfg(test)]
mod tests;
mod threshold;
mod trial;
#[cfg(test)]
mod truth;
mod turbulence;
mod unmodelled;
mod verdict;
mod watch;

pub use answer::Conclusion;
pub use candidates::{TakenFor, candidates};
pub use case::{Case, Unfit};
pub use difference::difference;
pub use effect::{Effect, EffectKind, Treatment};
pub use flight::Flight;
pub use inconclusive::Inconclusive;
pub use knowledge::{Knowledge, KnownSize};
pub use plausible::Plausible;
pub use report::{
    Diagnosis, DocumentChange, EffectParameter, Evidence, FitChange, Member, NamedEffect,
    OutputGain, ParameterChange, Refusal, RefusedEffect, Step, Verdict,
};
pub use residual::{ResidualAnalysis, SpectralLine, analyse};
pub use unmodelled::{
    ForceCurve, ForceDependence, ForceElsewhere, ForceHistory, ForceIn, ForceInterval,
    ForceSpectrum, LeftBy, Unmodelled,
};
pub use watch::Watcher;

use answer::answer;
use declared::Declared;
use fitted::Fitted;
use found::Found;
use review::review;
use rival::Rival;
use round::{MOST_ROUNDS, Round, round};
use turbulence::Disturbed;
use watch::{Stopped, ask};

/// How often the declared model's fit may turn out to have ended in a false minimum.
const MOST_RENEWALS: usize = 2;

/// Finds what the declared model of a case lacks.
///
/// # Errors
/// The declared model cannot be fitted at all, or `watcher` stopped it.
pub fn diagnose(case: &Case, watcher: &mut Watcher<'_>) -> Result<Conclusion, Inconclusive> {
    let mut declared = Declared::of(case, watcher)?;
    let mut found = Found::default();
    let mut base = declared.fitted.clone();
    let cleaned = clean(case, &declared.fitted, &mut base, &mut found, watcher)?;
    let case = cleaned.as_ref().unwrap_or(case);
    let mut start = base.clone();
    let catalogue = candidates::candidates(case, &declared.fitted.problem.model);
    let mut pool = catalogue.clone();
    // of the last fit, where it was looked for
    let mut picture = None;
    let mut number = 1;
    while number <= MOST_ROUNDS {
        let left: Vec<Effect> = (pool.iter())
            .filter(|effect| !found.accepted.iter().any(|a| a.effect.rules_out(effect)))
            .cloned()
            .collect();
        let round = round(case, &base, left, &found.added(), number, watcher)?;
        let Round {
            accepted,
            refused,
            others,
            threshold,
        } = round;
        let Some(accepted) = accepted else {
            found.refuse(refused);
            if picture.is_some() {
                break;
            }
            // what the catalogue has no word for may still have a form
            ask(watcher)?;
            let seen = unmodelled::found(case, &base);
            pool = seen
                .as_ref()
                .map_or_else(Vec::new, |seen| seen.beyond(&catalogue));
            case.knowledge.apply(&mut pool);
            picture = Some(seen);
            if pool.is_empty() {
                break;
            }
            continue;
        };
        picture = None;
        pool.clone_from(&catalogue);
        // what made the difference may be where the fit began, not the effect
        if found.accepted.is_empty()
            && !accepted.effect.is_noise()
            && declared.renewals() < MOST_RENEWALS
            && let Some(lower) = declared.lower(case, &accepted.fitted, watcher)
        {
            base = lower.fitted.clone();
            start = base.clone();
            declared = lower;
            continue;
        }
        found.refuse(refused);
        if accepted.effect.is_noise() {
            let disturbed = Disturbed {
                case,
                calm: &base,
                accepted,
                others,
                threshold,
                number,
            };
            base = turbulence::settle(disturbed, &mut found, watcher)?;
            break;
        }
        base = accepted.fitted.clone();
        found.accept(accepted, number, watcher)?;
        number += 1;
    }
    let standing = found.accepted.len();
    review(case, &declared.fitted, &mut base, &mut found);
    let picture = match picture {
        Some(seen) if found.accepted.len() == standing => seen,
        _ => {
            ask(watcher)?;
            unmodelled::found(case, &base)
        }
    };
    ask(watcher)?;
    let rival = Rival::of(case, &start, &base, &found);
    Ok(answer(case, &declared, &base, found, picture, rival)?)
}

/// Leaves out samples that are no measurements; `None` where there are none.
fn clean(
    case: &Case,
    declared: &Fitted,
    base: &mut Fitted,
    found: &mut Found,
    watcher: &mut Watcher<'_>,
) -> Result<Option<Case>, Stopped> {
    let Some((without, outliers)) = outliers::clean(case, declared) else {
        return Ok(None);
    };
    for outlying in outliers {
        *base = outlying.fitted.clone();
        found.accept(outlying, 0, watcher)?;
    }
    Ok(Some(without))
}
