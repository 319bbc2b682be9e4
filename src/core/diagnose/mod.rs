//! Closing the loop: what a model cannot explain, which effect it lacks, and what the error is with that effect added.
//!
//! [`diagnose`] fits the declared model, and goes in rounds: it screens the catalogue of effects against the residual
//! (projecting out all that the declared parameters can imitate, the residual whitened), fits what is promising,
//! accepts an effect that is significant by a colour-aware likelihood, within its physical range, alike in all parts
//! of the data, and that helps to predict flights which were not fitted. What the data cannot tell apart is one alias
//! group, what they cannot show is reported as invisible. An [`Effect`] is an edit of the model document, so that
//! what results is a document again.

mod accepted;
mod answer;
mod case;
mod catalogue;
mod colour;
mod difference;
mod disturbed;
mod effect;
mod fitted;
mod flight;
mod found;
mod gate;
mod group;
mod null_model;
mod outliers;
mod polish;
mod predicted;
mod projection;
mod refused;
mod repeats;
mod report;
mod residual;
mod review;
mod round;
mod screen;
mod sentence;
mod stack;
mod starts;
mod terms;
mod threshold;
mod trial;
mod unmodelled;
mod watch;

pub use case::{Case, Unfit};
pub use catalogue::candidates;
pub use difference::difference;
pub use effect::{Effect, EffectKind, Treatment};
pub use flight::Flight;
pub use report::{
    Diagnosis, DocumentChange, EffectParameter, Evidence, FitChange, Member, NamedEffect,
    OutputGain, ParameterChange, Refusal, RefusedEffect, Step, Verdict,
};
pub use residual::{ResidualAnalysis, SpectralLine, analyse};
pub use watch::Watcher;

use accepted::Accepted;
use answer::answer;
use disturbed::disturbed_throughout;
use fitted::Fitted;
use found::Found;
use review::remove_needless;
use round::round;
use watch::{Stopped, ask, tell};

use crate::estimate::{Estimate, TimeHistory, estimate};

/// Rounds, and so effects, at most: who lacks more than these has another model.
const MOST_ROUNDS: usize = 4;

/// Everything that a diagnosis comes to.
pub struct Conclusion {
    pub diagnosis: Diagnosis,
    /// Of the model with the effects in it.
    pub estimate: Estimate,
    pub histories: Vec<TimeHistory>,
}

/// Why there is no conclusion.
#[derive(Debug)]
pub enum Inconclusive {
    /// The declared model cannot be fitted.
    Unfit(Unfit),
    /// It was asked to stop.
    Stopped,
}

impl From<Unfit> for Inconclusive {
    fn from(why: Unfit) -> Self {
        Self::Unfit(why)
    }
}

impl From<Stopped> for Inconclusive {
    fn from(_: Stopped) -> Self {
        Self::Stopped
    }
}

/// Finds what the declared model of a case lacks.
///
/// # Errors
/// The declared model cannot be fitted at all, or `watcher` stopped it.
pub fn diagnose(case: &Case, watcher: &mut Watcher<'_>) -> Result<Conclusion, Inconclusive> {
    let (declared, fitted) = declared(case, watcher)?;
    let mut found = Found::default();
    let mut base = declared.clone();
    let cleaned = clean(case, &declared, &mut base, &mut found, watcher)?;
    let case = cleaned.as_ref().unwrap_or(case);
    let catalogue = catalogue::candidates(case, &declared.problem.model);
    for number in 1..=MOST_ROUNDS {
        let left: Vec<Effect> = (catalogue.iter())
            .filter(|effect| !found.accepted.iter().any(|a| a.effect == **effect))
            .cloned()
            .collect();
        let round = round(case, &base, left, number, watcher)?;
        found.refuse(round.refused);
        let Some(accepted) = round.accepted else {
            break;
        };
        let calm = std::mem::replace(&mut base, accepted.fitted.clone());
        let last = accepted.effect.is_noise();
        accept(accepted, number, &mut found, watcher)?;
        if last {
            base = disturbed_throughout(case, &calm, base);
            break;
        }
    }
    remove_needless(case, &declared, &mut base, &mut found);
    Ok(answer(case, &declared, &fitted, &base, found)?)
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
        accept(outlying, 0, found, watcher)?;
    }
    Ok(Some(without))
}

fn accept(
    accepted: Accepted,
    round: usize,
    found: &mut Found,
    watcher: &mut Watcher<'_>,
) -> Result<(), Stopped> {
    let step = Step::Accepted {
        round,
        name: accepted.effect.name(),
        likelihood_ratio: accepted.evidence.likelihood_ratio,
        sentence: sentence::of(&accepted.effect, &accepted.added, &accepted.fitted.estimate),
    };
    found.accepted.push(accepted);
    tell(watcher, &step)
}

/// The declared model, fitted as the job's options say, and its time histories.
fn declared(
    case: &Case,
    watcher: &mut Watcher<'_>,
) -> Result<(Fitted, Vec<TimeHistory>), Inconclusive> {
    let problem = case.problem(&case.document, &case::Values::new())?;
    let mut stopped = Ok(());
    let solution = estimate(&problem, &mut |_| {
        stopped = stopped.and(ask(watcher));
        match stopped {
            Ok(()) => std::ops::ControlFlow::Continue(()),
            Err(Stopped) => std::ops::ControlFlow::Break(()),
        }
    });
    stopped?;
    let solution = solution.map_err(|_| {
        Unfit("with the start values the simulation of the declared model leaves the range of numbers".into())
    })?;
    let step = Step::Fitted {
        round: 0,
        cost: solution.estimate.cost,
        iterations: solution.estimate.iterations,
    };
    tell(watcher, &step)?;
    let fitted = Fitted::of(
        case.document.clone(),
        problem,
        solution.estimate,
        &solution.histories,
    );
    Ok((fitted, solution.histories))
}
