//! An effect that a round accepted.

use super::effect::{Effect, Treatment};
use super::fitted::Fitted;
use super::group::alone;
use super::passed::Passed;
use super::report::{Evidence, Member};
use super::threshold::Threshold;
use crate::model::Added;

#[derive(Clone, Debug)]
pub(super) struct Accepted {
    pub effect: Effect,
    /// The parameters that it added, as they are called in the model with all effects that stand, its size first.
    pub added: Vec<Added>,
    /// The model with it, fitted by output error.
    pub fitted: Fitted,
    pub group: Vec<Member>,
    pub evidence: Evidence,
}

impl Accepted {
    /// The same process noise on a rate, which is likelier by a gain of 2 ln L.
    #[must_use]
    pub(super) fn of_rate(mut self, rate: &str, fitted: &Fitted, gain: f64) -> Self {
        self.effect = Effect::treatment(Treatment::ProcessNoise, rate);
        self.group = alone(&self.effect);
        self.evidence.likelihood_ratio += gain;
        self.fitted = fitted.clone();
        self
    }

    pub(super) fn of(passed: Passed, group: Vec<Member>, threshold: Threshold) -> Self {
        let Passed {
            trial,
            settled,
            gains,
            ..
        } = passed;
        let screened = trial.screened.as_ref();
        let held_out = gains.iter().map(|gain| gain.gain).sum();
        Self {
            group,
            evidence: Evidence {
                likelihood_ratio: trial.likelihood_ratio,
                threshold: threshold.of(trial.freedom, trial.starts),
                score: screened.map(|s| s.score),
                visible_fraction: screened.map(|s| s.visible),
                smallest_seen: screened.map(|s| threshold.smallest_seen(s.one_sigma)),
                held_out: (!gains.is_empty()).then_some(held_out),
                held_out_by_output: gains,
            },
            added: trial.added,
            effect: trial.effect,
            fitted: settled,
        }
    }
}
