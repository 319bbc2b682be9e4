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
mod exchange;
mod fitted;
mod flight;
mod found;
mod gate;
mod group;
mod heard;
mod inconclusive;
mod knowledge;
mod lines;
mod null_model;
mod outliers;
#[cfg(test)]
mod pairs;
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
mod search;
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
mod two_at_once;
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
use search::Search;
use watch::{Stopped, ask};

/// Finds what the declared model of a case lacks.
///
/// # Errors
/// The declared model cannot be fitted at all, or `watcher` stopped it.
pub fn diagnose(case: &Case, watcher: &mut Watcher<'_>) -> Result<Conclusion, Inconclusive> {
    let declared = Declared::of(case, watcher)?;
    let mut found = Found::default();
    let mut base = declared.fitted.clone();
    let cleaned = clean(case, &declared.fitted, &mut base, &mut found, watcher)?;
    let case = cleaned.as_ref().unwrap_or(case);
    let mut search = Search::new(case, declared, base, found);
    search.run(watcher)?;
    let Search {
        declared,
        start,
        mut base,
        mut found,
        picture,
        ..
    } = search;
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
