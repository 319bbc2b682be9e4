//! What flights that were not fitted say of an effect: whether they are predicted better with it.

use super::effect::{Effect, EffectKind};
use super::fitted::Fitted;
use super::null_model::NullModel;
use super::predicted::Predicted;
use super::refused::Objection;
use super::report::{OutputGain, Refusal};
use super::stack::Layout;
use super::trial::Trial;
use crate::estimate::Role;
use crate::model::EditKind;

/// Flights that were not fitted speak of an effect where it should change their likelihood by at least this.
const HEARD: f64 = 8.0;

/// The least gain there: a fixed part and a share of what the effect should bring,
const LEAST_GAIN: f64 = 2.0;
const LEAST_SHARE: f64 = 0.1;

/// or, where that is less, what an effect of which E is expected brings by chance: its gain spreads by 2 √E about E from
/// the noise of those flights alone, and by as much again from the uncertainty of all parameters.
const SPREADS: f64 = 6.0;

/// Where flights that were not fitted say nothing of an effect, those that were must say this much more.
const UNHEARD: f64 = 2.0;

/// What flights that were not fitted say of an effect.
#[derive(Default)]
pub(super) struct Heard {
    /// By output, of plain errors.
    pub gains: Vec<OutputGain>,
    /// What it is worth where these are fitted themselves, if that was asked.
    pub again: Option<f64>,
}

/// Whether flights that were not fitted are predicted better with it.
pub(super) fn predictive(
    null: &NullModel<'_>,
    trial: &Trial,
    settled: &Fitted,
    least: f64,
) -> Result<Heard, Objection> {
    // a gust comes once, and innovations are no prediction
    let is_heard =
        !trial.effect.is_noise() && trial.effect.kind != EffectKind::Edit(EditKind::Gust);
    let (Some(before), true) = (&null.predicted, is_heard) else {
        return Ok(Heard::default());
    };
    let predicted = Predicted::of(settled, null.case, Role::Validation)
        .map_err(|why| (Refusal::NotPredictive, why.to_string()))?;
    let Some(after) = predicted else {
        return Ok(Heard::default());
    };
    let gains = after.gains_over(before);
    if trial.effect.is_local_in_time() {
        // each flight has a size of its own, found on that flight
        return Ok(Heard { gains, again: None });
    }
    let gain: f64 = gains.iter().map(|gain| gain.gain).sum();
    let expected = after.gain_expected_over(before);
    if expected < HEARD && trial.likelihood_ratio < UNHEARD * least {
        let why = format!(
            "flights that were not fitted hardly show it (their likelihood changes by {expected:.1}), and those that were do not show it clearly enough alone"
        );
        return Err((Refusal::NotPredictive, why));
    }
    // what speaks for it on all flights together
    let in_all = trial.likelihood_ratio + gain;
    let is_clear = trial.likelihood_ratio >= UNHEARD * least;
    let is_seen = gain > 0.0 || is_clear;
    let is_denied =
        expected >= HEARD && (gain < least_gain(expected) || in_all < least || !is_seen);
    let worse = after.clearly_worse_than(before);
    // parameters of a fit are not exact: whether the effect is there is asked as it was of the flights fitted
    let again = match (is_denied || worse.is_some()) && is_clear {
        true => null.shown_again(settled, &trial.added, trial.freedom),
        false => None,
    };
    if again.is_some() {
        return Ok(Heard { gains, again });
    }
    if is_denied {
        let why = format!(
            "it differs between maneuvers: flights that were not fitted are not predicted better with it (gain {gain:.1}, where {expected:.1} is expected)"
        );
        return Err((Refusal::NotPredictive, why));
    }
    if let Some((output, ratio)) = worse {
        let why = format!(
            "{output} of flights that were not fitted is predicted worse with it: RMS error {ratio:.2} times as large"
        );
        return Err((Refusal::NotPredictive, why));
    }
    Ok(Heard { gains, again })
}

/// The gain below which flights that were not fitted speak against an effect that should bring `expected`.
fn least_gain(expected: f64) -> f64 {
    let by_chance = expected - SPREADS * expected.sqrt();
    by_chance.min(LEAST_GAIN + LEAST_SHARE * expected)
}

/// What smaller plain errors are worth: on flights that were not fitted, or where all were, on these. `None` of a gust,
/// which other flights do not have, and of innovations, which are no such errors.
pub(super) fn plain_gain(
    null: &NullModel<'_>,
    effect: &Effect,
    settled: &Fitted,
    gains: &[OutputGain],
) -> Option<f64> {
    if null.predicted.is_none() && !effect.is_noise() {
        let layout = Layout::of(&settled.problem);
        return Some(layout.plain_gain(&null.base.residual, &settled.residual));
    }
    (!gains.is_empty()).then(|| gains.iter().map(|gain| gain.gain).sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A gain is by chance as far below E as six spreads of √E; where E is large a tenth of it must be there.
    #[test]
    fn what_chance_makes_is_not_held_against_an_effect() {
        for (expected, least) in [(9.0, -9.0), (36.0, 0.0), (49.0, 6.9), (400.0, 42.0)] {
            assert!((least_gain(expected) - least).abs() < 1e-12, "{expected}");
        }
    }
}
