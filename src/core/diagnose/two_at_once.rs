//! Two effects that hide each other: neither is the same in all flights, or predicts those that were not fitted, as long as the other
//! is missing.
//!
//! What is clearly there and was refused for that is put in for the time being. If then another passes, it stays, and the choice of
//! the first is made again beside it, by the rules that hold for all.

use std::cmp::Ordering;

use super::accepted::Accepted;
use super::case::Case;
use super::effect::Effect;
use super::fitted::Fitted;
use super::found::{CLEARLY, Found};
use super::null_model::NullModel;
use super::report::{Refusal, RefusedEffect};
use super::round::round;
use super::trial::Trial;
use super::watch::{Stopped, Watcher};

/// Of those that were refused the likeliest are put in, so many.
const PUT_IN: usize = 2;

/// The two effects that pass one beside the other, if there are two.
///
/// # Errors
/// The watcher stopped it.
pub(super) fn two_at_once(
    case: &Case,
    base: &Fitted,
    found: &Found,
    refused: &[RefusedEffect],
    candidates: &[Effect],
    number: usize,
    watcher: &mut Watcher<'_>,
) -> Result<Option<[Accepted; 2]>, Stopped> {
    let earlier = found.added();
    let Ok(null) = NullModel::new(case, base, &earlier) else {
        return Ok(None);
    };
    for effect in clearest(refused) {
        let Ok(trial) = Trial::of(&null, effect, None) else {
            continue;
        };
        let document = trial.likeliest.document.clone();
        let Ok(with) = Fitted::settled(case, document, &trial.likeliest.values()) else {
            continue;
        };
        let but_for = |taken: &Effect| -> Vec<Effect> {
            let left = candidates.iter().filter(|other| !taken.rules_out(other));
            left.cloned().collect()
        };
        let put_in = [earlier.clone(), trial.added.clone()].concat();
        let left = but_for(&trial.effect);
        let second = round(case, &with, left, &put_in, number, watcher)?.accepted;
        let Some(second) = second.filter(|second| !second.effect.is_noise()) else {
            continue;
        };
        let Some((second, alone)) = beside(case, base, second) else {
            continue;
        };
        let added = [earlier.clone(), second.added.clone()].concat();
        let left = but_for(&second.effect);
        let first = round(case, &alone, left, &added, number, watcher)?.accepted;
        if let Some(first) = first.filter(|first| !first.effect.is_noise()) {
            return Ok(Some([second, first]));
        }
    }
    Ok(None)
}

/// What explains far more than chance, and was refused by other flights alone, the likeliest first.
fn clearest(refused: &[RefusedEffect]) -> Vec<Effect> {
    let ratio = |refused: &RefusedEffect| refused.likelihood_ratio.unwrap_or(0.0);
    let mut hidden: Vec<&RefusedEffect> = (refused.iter())
        .filter(|refused| {
            matches!(
                refused.reason,
                Refusal::NotRepeatable | Refusal::NotPredictive
            ) && ratio(refused) > CLEARLY
        })
        .collect();
    hidden.sort_by(|a, b| ratio(b).partial_cmp(&ratio(a)).unwrap_or(Ordering::Equal));
    let clearest = hidden.into_iter().take(PUT_IN);
    clearest.map(|refused| refused.effect.clone()).collect()
}

/// An effect that passed beside one that is no longer there, and the model with it alone.
fn beside(case: &Case, base: &Fitted, mut accepted: Accepted) -> Option<(Accepted, Fitted)> {
    let edited = accepted.effect.apply(&base.document).ok()?;
    let alone = Fitted::settled(case, edited.document, &accepted.fitted.values()).ok()?;
    accepted.added = edited.added;
    accepted.fitted = alone.clone();
    Some((accepted, alone))
}
