//! Effects that the rounds found, and those that they refused.

use super::accepted::Accepted;
use super::effect::Effect;
use super::report::{Refusal, RefusedEffect, Step};
use super::sentence;
use super::watch::{Stopped, Watcher, tell};
use crate::model::Added;

/// A likelihood ratio that no chance makes, however many candidates there are.
pub(super) const CLEARLY: f64 = 40.0;

/// Effects that were accepted, in their order, and candidates that were not, with the reason.
#[derive(Default)]
pub(super) struct Found {
    pub accepted: Vec<Accepted>,
    pub refused: Vec<RefusedEffect>,
    /// The rate that something disturbs which nothing recorded tells of, and which is no turbulence.
    pub pushed: Option<String>,
}

impl Found {
    /// Takes an effect in, and tells of it.
    ///
    /// # Errors
    /// The watcher stopped it.
    pub(super) fn accept(
        &mut self,
        accepted: Accepted,
        round: usize,
        watcher: &mut Watcher<'_>,
    ) -> Result<(), Stopped> {
        let step = Step::Accepted {
            round,
            name: accepted.effect.name(),
            likelihood_ratio: accepted.evidence.likelihood_ratio,
            sentence: sentence::of(&accepted.effect, &accepted.fitted.sizes(&accepted.added)),
        };
        self.accepted.push(accepted);
        tell(watcher, &step)
    }

    /// The parameters that the accepted effects added.
    pub(super) fn added(&self) -> Vec<Added> {
        let accepted = self.accepted.iter();
        accepted.flat_map(|a| a.added.iter().cloned()).collect()
    }

    /// What explains clearly more than chance, and is not that effect all the same: other flights deny it, its size is none
    /// that such an effect has, or its fit does not converge.
    pub(super) fn clear_but_refused(&self) -> Option<&RefusedEffect> {
        use Refusal::{NotFitted, NotPredictive, NotRepeatable, OutOfRange};
        let is_open = |refused: &&RefusedEffect| {
            let reasons = [NotFitted, NotPredictive, NotRepeatable, OutOfRange];
            reasons.contains(&refused.reason)
        };
        let clearly = |refused: &&RefusedEffect| {
            refused
                .likelihood_ratio
                .is_some_and(|ratio| ratio > CLEARLY)
        };
        let most = |refused: &&RefusedEffect| refused.likelihood_ratio.unwrap_or(0.0);
        (self.refused.iter())
            .filter(|refused| !self.stands(&refused.effect))
            .filter(is_open)
            .filter(clearly)
            .max_by(|a, b| most(a).total_cmp(&most(b)))
    }

    /// Takes over why a round refused candidates. Of each, that is kept which speaks of the most that it explained.
    pub(super) fn refuse(&mut self, refused: Vec<RefusedEffect>) {
        let explained =
            |refused: &RefusedEffect| refused.likelihood_ratio.unwrap_or(f64::NEG_INFINITY);
        for new in refused {
            match self.refused.iter_mut().find(|old| old.effect == new.effect) {
                Some(old) if explained(old) > explained(&new) => {}
                Some(old) => *old = new,
                None => self.refused.push(new),
            }
        }
    }

    /// Candidates that stand in the group of one that was accepted, or were accepted later, were not refused.
    pub(super) fn truly_refused(&self) -> Vec<RefusedEffect> {
        let refused = (self.refused.iter()).filter(|refused| !self.stands(&refused.effect));
        refused.cloned().collect()
    }

    /// Whether an effect was accepted, singly or in a group.
    fn stands(&self, effect: &Effect) -> bool {
        let mut groups = self.accepted.iter().flat_map(|accepted| &accepted.group);
        groups.any(|member| member.effect == *effect)
    }

    /// Notes why an effect that was accepted was taken out again, and what it was worth in the end, if that is known.
    pub(super) fn removed(
        &mut self,
        removed: Accepted,
        (reason, sentence): (Refusal, String),
        worth: Option<f64>,
    ) {
        self.refused
            .retain(|refused| refused.effect != removed.effect);
        self.refused.push(RefusedEffect {
            sentence,
            effect: removed.effect,
            reason,
            likelihood_ratio: worth,
            visible_fraction: removed.evidence.visible_fraction,
            smallest_seen: removed.evidence.smallest_seen,
            held_out: removed.evidence.held_out,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::EditKind;

    fn refused(ratio: Option<f64>, reason: Refusal) -> RefusedEffect {
        RefusedEffect {
            effect: Effect::edit(EditKind::SensorBias, "q", None),
            reason,
            sentence: String::new(),
            likelihood_ratio: ratio,
            visible_fraction: None,
            smallest_seen: None,
            held_out: None,
        }
    }

    /// A fit that does not converge, or ends at no size of its kind, explains what is there all the same.
    #[test]
    fn what_is_clear_and_was_refused_is_not_passed_over() {
        use Refusal::{Invisible, NotFitted, NotPredictive, NotSignificant, OutOfRange, Outdone};
        let is_told = |ratio: f64, reason: Refusal| {
            let mut found = Found::default();
            found.refuse(vec![refused(Some(ratio), reason)]);
            found.clear_but_refused().is_some()
        };
        for reason in [NotFitted, OutOfRange, NotPredictive] {
            assert!(is_told(CLEARLY + 1.0, reason), "{reason:?}");
            assert!(!is_told(CLEARLY - 1.0, reason), "{reason:?}");
        }
        for reason in [Invisible, NotSignificant, Outdone] {
            assert!(!is_told(CLEARLY + 1.0, reason), "{reason:?}");
        }
    }

    #[test]
    fn of_all_rounds_the_reason_is_kept_that_explains_most() {
        let mut found = Found::default();
        for (ratio, reason) in [
            (None, Refusal::Invisible),
            (Some(40.0), Refusal::NotPredictive),
            (Some(0.3), Refusal::NotSignificant),
        ] {
            found.refuse(vec![refused(ratio, reason)]);
        }
        assert_eq!(
            found.truly_refused(),
            [refused(Some(40.0), Refusal::NotPredictive)]
        );
    }
}
