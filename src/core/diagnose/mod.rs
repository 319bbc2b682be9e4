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
mod repeats;
mod report;
mod residual;
mod review;
mod rival;
mod round;
mod screen;
mod sentence;
mod size;
mod spikes;
mod stack;
mod starts;
#[cfg(test)]
mod tests;
mod threshold;
mod trial;
#[cfg(test)]
mod truth;
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
    ForceSpectrum, Unmodelled,
};
pub use watch::Watcher;

use accepted::Accepted;
use answer::answer;
use beside_noise::beside_noise;
use declared::Declared;
use disturbed::{disturbed_elsewhere, disturbed_throughout};
use fitted::Fitted;
use found::Found;
use review::review;
use rival::Rival;
use round::{Round, round};
use watch::{Stopped, ask, tell};

/// Rounds, and so effects, at most: who lacks more than these has another model.
const MOST_ROUNDS: usize = 6;

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
            mut others,
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
        let calm = std::mem::replace(&mut base, accepted.fitted.clone());
        let last = accepted.effect.is_noise();
        accept(accepted, number, &mut found, watcher)?;
        if last {
            base = match disturbed_elsewhere(case, &calm, &base) {
                Some((rate, fitted)) => {
                    found.is_no_turbulence(rate);
                    fitted
                }
                None => disturbed_throughout(case, &calm, base),
            };
            while number < MOST_ROUNDS
                && let Some(further) = beside_noise(case, &base, &others, threshold)
            {
                ask(watcher)?;
                number += 1;
                others.retain(|other| !further.effect.rules_out(&other.trial.effect));
                base = further.fitted.clone();
                accept(further, number, &mut found, watcher)?;
            }
            break;
        }
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
        accept(outlying, 0, found, watcher)?;
    }
    Ok(Some(without))
}

fn accept(
    accepted: Accepted,
    round: usize,
    found: &mut Found,
    watcher: &mut Watcher<'_>,
) -> Result<(), Stopped> {
    let step = Step::Accepted {
        round,
        name: accepted.effect.name(),
        likelihood_ratio: accepted.evidence.likelihood_ratio,
        sentence: sentence::of(&accepted.effect, &accepted.fitted.sizes(&accepted.added)),
    };
    found.accepted.push(accepted);
    tell(watcher, &step)
}
