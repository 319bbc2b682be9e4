//! Effects that the rounds found, and those that they refused.

use super::accepted::Accepted;
use super::effect::{Effect, Treatment};
use super::group::alone;
use super::report::{Refusal, RefusedEffect};
use crate::model::Added;

/// A likelihood ratio that no chance makes, however many candidates there are.
const CLEARLY: f64 = 40.0;

/// Effects that were accepted, in their order, and candidates that were not, with the reason.
#[derive(Default)]
pub(super) struct Found {
    pub accepted: Vec<Accepted>,
    pub refused: Vec<RefusedEffect>,
    /// The rate that something disturbs which nothing recorded tells of, and which is no turbulence.
    pub pushed: Option<String>,
}

impl Found {
    /// The process noise that was accepted last is that of a rate.
    pub(super) fn is_no_turbulence(&mut self, rate: String) {
        if let Some(last) = self.accepted.last_mut() {
            last.effect = Effect::treatment(Treatment::ProcessNoise, rate.as_str());
            last.group = alone(&last.effect);
        }
        self.pushed = Some(rate);
    }

    /// The parameters that the accepted effects added.
    pub(super) fn added(&self) -> Vec<Added> {
        let accepted = self.accepted.iter();
        accepted.flat_map(|a| a.added.iter().cloned()).collect()
    }

    /// Whether something was clearly there on the flights that were fitted, and was not so on others.
    pub(super) fn differs_between_maneuvers(&self) -> Option<&RefusedEffect> {
        let differs = |refused: &&RefusedEffect| {
            matches!(
                refused.reason,
                Refusal::NotPredictive | Refusal::NotRepeatable
            )
        };
        let clearly = |refused: &&RefusedEffect| {
            refused
                .likelihood_ratio
                .is_some_and(|ratio| ratio > CLEARLY)
        };
        let most = |refused: &&RefusedEffect| refused.likelihood_ratio.unwrap_or(0.0);
        (self.refused.iter())
            .filter(differs)
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
        let stands = |effect: &Effect| {
            let groups = self.accepted.iter().flat_map(|accepted| &accepted.group);
            groups
                .map(|member| &member.effect)
                .any(|member| member == effect)
        };
        let refused = self
            .refused
            .iter()
            .filter(|refused| !stands(&refused.effect));
        refused.cloned().collect()
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

    #[test]
    fn of_all_rounds_the_reason_is_kept_that_explains_most() {
        let refused = |ratio: Option<f64>, reason: Refusal| RefusedEffect {
            effect: Effect::edit(EditKind::SensorBias, "q", None),
            reason,
            sentence: String::new(),
            likelihood_ratio: ratio,
            visible_fraction: None,
            smallest_seen: None,
            held_out: None,
        };
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
