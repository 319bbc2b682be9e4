//! Review: what later effects made needless is taken out again.

use super::accepted::Accepted;
use super::case::Case;
use super::fitted::Fitted;
use super::found::Found;
use crate::model::{EditError, ModelDocument};

/// Takes out effects whose removal costs less than what they had to pass, one at a time, the least needed first.
pub(super) fn remove_needless(
    case: &Case,
    declared: &Fitted,
    base: &mut Fitted,
    found: &mut Found,
) {
    while found.accepted.len() > 1 {
        let evidence = base.clone().likeliest().ln_evidence();
        let needless = (0..found.accepted.len())
            .filter_map(|at| {
                let (cost, document) = removal(case, declared, base, found, at, evidence)?;
                let needed = found.accepted[at].evidence.threshold;
                (cost < needed).then_some((cost - needed, cost, at, document))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, cost, at, document)) = needless else {
            break;
        };
        let Ok(fitted) = Fitted::settled(case, document, &base.values()) else {
            break;
        };
        *base = fitted;
        let removed = found.accepted.remove(at);
        found.needless(removed, cost);
        name_again(&declared.document, &mut found.accepted);
    }
}

/// The likelihood ratio that removing an effect costs, and the document without it.
fn removal(
    case: &Case,
    declared: &Fitted,
    base: &Fitted,
    found: &Found,
    at: usize,
    evidence: f64,
) -> Option<(f64, ModelDocument)> {
    // what is a way to fit rather than an edit is not taken out
    if found.accepted[at].effect.edits.is_empty() {
        return None;
    }
    let others = (found.accepted.iter().enumerate()).filter(|(other, _)| *other != at);
    let without = others
        .map(|(_, accepted)| accepted)
        .try_fold(declared.document.clone(), |document, accepted| {
            Ok::<_, EditError>(accepted.effect.apply(&document)?.document)
        });
    let without = without.ok()?;
    let fitted = Fitted::trial(case, without.clone(), &base.values()).ok()?;
    Some((2.0 * (evidence - fitted.likeliest().ln_evidence()), without))
}

/// The parameters that each effect adds, now that another is gone: a name that was numbered, because the other had
/// taken it, is free again.
fn name_again(declared: &ModelDocument, accepted: &mut [Accepted]) {
    let mut document = declared.clone();
    for accepted in accepted {
        if let Ok(with) = accepted.effect.apply(&document) {
            accepted.added = with.added;
            document = with.document;
        }
    }
}
