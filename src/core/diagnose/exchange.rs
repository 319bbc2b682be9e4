//! Exchange: an effect that was accepted while a later one was still missing may have stood for both. Beside the later
//! ones the choice is made again.
//!
//! Going forward alone, each effect is the best beside those before it and not beside those behind it (sequential
//! replacement; A. J. Miller, Subset Selection in Regression, 1990, section 3.3).

use super::accepted::Accepted;
use super::case::Case;
use super::effect::Effect;
use super::fitted::Fitted;
use super::found::Found;
use super::report::Refusal;
use super::review::{name_again, without};
use super::round::round;
use super::watch::{Stopped, Watcher};

/// By less than this share the worth of an effect changes beside others that have nothing to do with it.
const CHANGED: f64 = 0.1;

/// An effect that another is the better explanation than, beside all that were accepted later.
pub(super) struct Exchange {
    /// The place of what goes.
    at: usize,
    by: Accepted,
    /// The model with the other in its place.
    pub fitted: Fitted,
}

/// The first exchange that pays, if there is one. The effect that was accepted last has been chosen beside all others.
///
/// # Errors
/// The watcher stopped it.
pub(super) fn exchange(
    case: &Case,
    declared: &Fitted,
    base: &Fitted,
    found: &Found,
    catalogue: &[Effect],
    number: usize,
    watcher: &mut Watcher<'_>,
) -> Result<Option<Exchange>, Stopped> {
    for at in 0..found.accepted.len().saturating_sub(1) {
        let standing = &found.accepted[at].effect;
        let fitted = without(declared, found, at)
            .and_then(|document| Fitted::settled(case, document, &base.values()).ok());
        let Some(without) = fitted else { continue };
        if is_worth_the_same(&found.accepted[at], base, &without) {
            continue;
        }
        let mut others = found.accepted.clone();
        others.remove(at);
        name_again(&declared.document, &mut others);
        let mut candidates: Vec<Effect> = (catalogue.iter())
            .filter(|effect| !others.iter().any(|other| other.effect.rules_out(effect)))
            .cloned()
            .collect();
        if !candidates.contains(standing) {
            candidates.push(standing.clone());
        }
        let earlier: Vec<_> = others
            .iter()
            .flat_map(|other| other.added.clone())
            .collect();
        let chosen = round(case, &without, candidates, &earlier, number, watcher)?.accepted;
        if let Some(by) = chosen.filter(|by| is_another(by, standing)) {
            return Ok(Some(Exchange {
                at,
                fitted: by.fitted.clone(),
                by,
            }));
        }
    }
    Ok(None)
}

/// Whether the later effects have changed next to nothing of what it is worth: then it has not stood for them.
fn is_worth_the_same(accepted: &Accepted, with: &Fitted, without: &Fitted) -> bool {
    let evidence = |fitted: &Fitted| fitted.clone().likeliest().ln_evidence();
    let now = 2.0 * (evidence(with) - evidence(without));
    let then = accepted.evidence.likelihood_ratio;
    (now - then).abs() < CHANGED * then
}

/// Whether what was chosen is no alias of what stands.
fn is_another(chosen: &Accepted, standing: &Effect) -> bool {
    !chosen.effect.is_noise() && !(chosen.group.iter()).any(|member| member.effect == *standing)
}

impl Exchange {
    /// Takes the effect out that goes, and the other in.
    ///
    /// # Errors
    /// The watcher stopped it.
    pub(super) fn take_place(
        self,
        declared: &Fitted,
        found: &mut Found,
        number: usize,
        watcher: &mut Watcher<'_>,
    ) -> Result<(), Stopped> {
        let removed = found.accepted.remove(self.at);
        let why = format!(
            "it was accepted in an earlier round; beside the later effects {} is the better explanation",
            self.by.effect.name()
        );
        let worth = removed.evidence.likelihood_ratio;
        found.removed(removed, (Refusal::Outdone, why), Some(worth));
        name_again(&declared.document, &mut found.accepted);
        found.accept(self.by, number, watcher)
    }
}
