//! Review: what no longer holds with later effects in the model, or what these made needless, is taken out again.

use super::accepted::Accepted;
use super::case::Case;
use super::disturbed::again;
use super::fitted::Fitted;
use super::found::Found;
use super::gate::holds;
use super::report::Refusal;
use crate::model::{EditError, ModelDocument};

/// An effect that is to go, what speaks against it, and the likelihood ratio that it was worth in the end.
struct Leaving {
    at: usize,
    without: ModelDocument,
    why: (Refusal, String),
    worth: Option<f64>,
}

/// Takes out effects that no longer pass, one at a time: first those whose size says nothing any more, then those whose
/// removal costs less than what they had to pass, the least needed first.
pub(super) fn review(case: &Case, declared: &Fitted, base: &mut Fitted, found: &mut Found) {
    while found.accepted.len() > 1 {
        let leaving = untenable(declared, base, found);
        let leaving = leaving.or_else(|| needless(case, declared, base, found));
        let Some(leaving) = leaving else { break };
        let fitted = match base.estimate.filter {
            Some(_) => again(case, base, leaving.without),
            None => Fitted::settled(case, leaving.without, &base.values()),
        };
        let Ok(fitted) = fitted else { break };
        *base = fitted;
        let removed = found.accepted.remove(leaving.at);
        found.removed(removed, leaving.why, leaving.worth);
        name_again(&declared.document, &mut found.accepted);
    }
}

/// The last effect whose size has come to a bound of its range, or to nothing.
fn untenable(declared: &Fitted, base: &Fitted, found: &Found) -> Option<Leaving> {
    (0..found.accepted.len()).rev().find_map(|at| {
        let Accepted { effect, added, .. } = &found.accepted[at];
        if effect.edits.is_empty() {
            return None;
        }
        let (refusal, why) = holds(effect, base, added).err()?;
        Some(Leaving {
            at,
            without: without(declared, found, at)?,
            why: (
                refusal,
                format!(
                    "it was accepted in an earlier round; with the later effects in the model {why}"
                ),
            ),
            worth: None,
        })
    })
}

/// The effect whose removal costs least, if that is less than what it had to pass.
fn needless(case: &Case, declared: &Fitted, base: &Fitted, found: &Found) -> Option<Leaving> {
    let evidence = |fitted: Fitted| fitted.likeliest().ln_evidence();
    let with = evidence(base.clone());
    let fit = |document: ModelDocument| match base.estimate.filter {
        Some(_) => again(case, base, document),
        None => Fitted::trial(case, document, &base.values()),
    };
    let of = |at: usize| {
        let without = without(declared, found, at)?;
        let fitted = fit(without.clone()).ok()?;
        let cost = 2.0 * (with - evidence(fitted));
        let beyond = cost - found.accepted[at].evidence.threshold;
        let why = format!(
            "it was accepted in an earlier round; with the later effects in the model its likelihood ratio is only {cost:.1}"
        );
        let leaving = Leaving {
            at,
            without,
            why: (Refusal::Needless, why),
            worth: Some(cost),
        };
        (beyond < 0.0).then_some((beyond, leaving))
    };
    let needless = (0..found.accepted.len()).filter_map(of);
    let least = needless.min_by(|a, b| a.0.total_cmp(&b.0));
    least.map(|(_, leaving)| leaving)
}

/// The document with all effects but one. What is a way to fit rather than an edit is not taken out.
pub(super) fn without(declared: &Fitted, found: &Found, at: usize) -> Option<ModelDocument> {
    if found.accepted[at].effect.edits.is_empty() {
        return None;
    }
    let others = (found.accepted.iter().enumerate()).filter(|(other, _)| *other != at);
    let without = others
        .map(|(_, accepted)| accepted)
        .try_fold(declared.document.clone(), |document, accepted| {
            Ok::<_, EditError>(accepted.effect.apply(&document)?.document)
        });
    without.ok()
}

/// The parameters that each effect adds, now that another is gone: a name that was numbered, because the other had
/// taken it, is free again.
pub(super) fn name_again(declared: &ModelDocument, accepted: &mut [Accepted]) {
    let mut document = declared.clone();
    for accepted in accepted {
        if let Ok(with) = accepted.effect.apply(&document) {
            accepted.added = with.added;
            document = with.document;
        }
    }
}
