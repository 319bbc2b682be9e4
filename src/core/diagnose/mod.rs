//! Closing the loop: what a model cannot explain, which effect it lacks, and what the error is with that effect added.
//!
//! [`diagnose`] fits the declared model, and goes in rounds: it screens the catalogue of effects against the residual
//! (projecting out all that the declared parameters can imitate, the residual whitened), fits what is promising,
//! accepts an effect that is significant by a colour-aware likelihood, within its physical range, alike in all parts
//! of the data, and that helps to predict flights which were not fitted. What the data cannot tell apart is one alias
//! group, what they cannot show is reported as invisible. An [`Effect`] is an edit of the model document, so that
//! what results is a document again.

mod answer;
mod candidates;
mod case;
mod colour;
mod difference;
mod effect;
mod fitted;
mod flight;
mod found;
mod group;
mod knowledge;
mod needless;
mod null_model;
mod outliers;
mod plausible;
mod polish;
mod projection;
mod report;
mod residual;
mod round;
mod screen;
mod sentence;
mod size;
mod stack;
mod trial;

pub use answer::Conclusion;
pub use candidates::{TakenFor, candidates};
pub use case::{Case, Unfit};
pub use difference::difference;
pub use effect::{Effect, EffectKind, Treatment};
pub use flight::Flight;
pub use knowledge::{Knowledge, KnownSize};
pub use plausible::Plausible;
pub use report::{
    Diagnosis, DocumentChange, EffectParameter, Evidence, FitChange, Member, NamedEffect,
    OutputGain, ParameterChange, Refusal, RefusedEffect, Step, Verdict,
};
pub use residual::{ResidualAnalysis, SpectralLine, analyse};
pub use round::Watcher;

use answer::answer;
use fitted::Fitted;
use found::Found;
use round::round;

use crate::estimate::{TimeHistory, Unusable, estimate};

/// Rounds, and so effects, at most: who lacks more than these has another model.
const MOST_ROUNDS: usize = 4;

/// Why there is no conclusion.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum Inconclusive {
    /// A model does not meet the recordings, or comes to nothing.
    #[error(transparent)]
    Unfit(#[from] Unfit),
    /// The start values of the declared model lead nowhere.
    #[error("the declared model cannot be fitted from its start values: {0}")]
    NoStart(#[from] Unusable),
    /// It was asked to stop.
    #[error("stopped on request")]
    Stopped,
}

/// Finds what the declared model of a case lacks.
///
/// # Errors
/// The declared model cannot be fitted at all, or `watcher` stopped it.
pub fn diagnose(case: &Case, watcher: &mut Watcher<'_>) -> Result<Conclusion, Inconclusive> {
    let (declared, fitted) = declared(case, watcher)?;
    let mut found = Found::default();
    let mut base = declared.clone();
    let mut cleaned = None;
    if let Some((without, accepted)) = outliers::clean(case, &declared) {
        for accepted in accepted {
            let step = Step::Accepted {
                round: 0,
                name: accepted.effect.name(),
                likelihood_ratio: accepted.evidence.likelihood_ratio,
                sentence: sentence::words(&accepted.effect),
            };
            base = accepted.fitted.clone();
            found.accepted.push(accepted);
            if watcher(Some(&step)).is_break() {
                return Err(Inconclusive::Stopped);
            }
        }
        cleaned = Some(without);
    }
    let case = cleaned.as_ref().unwrap_or(case);
    let catalogue = candidates::candidates(case, &declared.problem.model);
    for number in 1..=MOST_ROUNDS {
        let left: Vec<Effect> = (catalogue.iter())
            .filter(|effect| !found.accepted.iter().any(|a| a.effect == **effect))
            .cloned()
            .collect();
        let round = round(case, &base, left, number, watcher);
        if round.stopped {
            return Err(Inconclusive::Stopped);
        }
        found.refuse(round.refused);
        let Some(accepted) = round.accepted else {
            break;
        };
        let step = Step::Accepted {
            round: number,
            name: accepted.effect.name(),
            likelihood_ratio: accepted.evidence.likelihood_ratio,
            sentence: sentence::of(&accepted.effect, &accepted.fitted.sizes(&accepted.added)),
        };
        let last = accepted.effect.is_noise();
        let calm = std::mem::replace(&mut base, accepted.fitted.clone());
        found.accepted.push(accepted);
        if watcher(Some(&step)).is_break() {
            return Err(Inconclusive::Stopped);
        }
        if last {
            base = trial::disturbed_throughout(case, &calm, base);
            break;
        }
    }
    needless::remove(case, &declared, &mut base, &mut found);
    Ok(answer(case, &declared, &fitted, &base, found)?)
}

/// The declared model, fitted as the job's options say, and its time histories.
fn declared(
    case: &Case,
    watcher: &mut Watcher<'_>,
) -> Result<(Fitted, Vec<TimeHistory>), Inconclusive> {
    let problem = case.problem(&case.document, &case::Values::new())?;
    let mut stopped = false;
    let solution = estimate(&problem, &mut |_| {
        let asked = watcher(None);
        stopped |= asked.is_break();
        asked
    });
    let solution = solution?;
    let step = Step::Fitted {
        round: 0,
        cost: solution.estimate.cost,
        iterations: solution.estimate.iterations,
    };
    stopped |= watcher(Some(&step)).is_break();
    if stopped {
        return Err(Inconclusive::Stopped);
    }
    let fitted = Fitted::of(case.document.clone(), problem, &solution);
    Ok((fitted, solution.histories))
}
