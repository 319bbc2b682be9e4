//! One round: screen the catalogue, try what is promising, hear what speaks against it, accept one effect or none.

use rayon::prelude::*;

use super::case::Case;
use super::colour::Colour;
use super::effect::{Effect, EffectKind, Treatment};
use super::fitted::Fitted;
use super::found::Accepted;
use super::group::group;
use super::null_model::{NullModel, Threshold};
use super::refused::{after_screen, after_trial, is_visible, refused};
use super::report::{Refusal, RefusedEffect, Step};
use super::screen::{Screen, Screened, independent_questions};
use super::stack::Layout;
use super::trial::{Trial, is_tried_outright, starts};
use super::watch::{Stopped, Watcher, ask, tell};
use crate::model::EditKind;

/// A linear step must promise this much for a candidate to be fitted.
const WORTH_A_TRIAL: f64 = 6.0;
const MOST_TRIALS: usize = 16;

/// Candidates between two occasions to stop.
const TOGETHER: usize = 8;

/// The outcome of a round.
#[derive(Default)]
pub(super) struct Round {
    pub accepted: Option<Accepted>,
    pub refused: Vec<RefusedEffect>,
}

/// A screened candidate, or why it was not.
type Seen = (Effect, Result<Screened, String>);

/// A candidate to be tried, with its screen where it has one.
type ToTry = (Effect, Option<Screened>);

/// The round of that number, from the fit of the model as it is.
///
/// # Errors
/// The watcher stopped it.
pub(super) fn round(
    case: &Case,
    base: &Fitted,
    candidates: Vec<Effect>,
    number: usize,
    watcher: &mut Watcher<'_>,
) -> Result<Round, Stopped> {
    let mut result = Round::default();
    let layout = Layout::of(&base.problem);
    let colour = Colour::of_best_order(&layout, &base.residual);
    let Some(screen) = Screen::new(case, base, &colour) else {
        return Ok(result);
    };
    let (outright, local): (Vec<Effect>, Vec<Effect>) =
        (candidates.into_iter()).partition(has_no_derivative);
    let seen = screen_all(case, base, &screen, &local, watcher)?;
    let threshold = Threshold {
        questions: questions(&seen) + outright.len() as f64,
    };
    tell(watcher, &screened_step(&seen, outright.len(), number))?;

    let orders = colour.orders();
    let coloured = orders.iter().any(|&order| order > 0);
    let outright = outright
        .into_iter()
        .filter(|effect| coloured || !effect.is_noise())
        .map(|effect| (effect, None));
    let to_try: Vec<ToTry> = promising(&seen).into_iter().chain(outright).collect();
    let null_model = NullModel::new(case, base, &orders);
    let trials = try_all(&null_model, &to_try, number, &mut result, watcher)?;
    let passing = object(
        &null_model,
        trials,
        &threshold,
        number,
        &mut result,
        watcher,
    )?;
    let untried = untried(&seen, &passing, &result, &threshold);
    choose(&null_model, passing, &threshold, &mut result);
    result.refused.extend(untried);
    Ok(result)
}

/// What has no derivative at no effect, so that the screen cannot see it.
fn has_no_derivative(effect: &Effect) -> bool {
    is_tried_outright(effect.kind)
        || matches!(effect.kind, EffectKind::Treatment(Treatment::ProcessNoise))
}

fn screen_all(
    case: &Case,
    base: &Fitted,
    screen: &Screen<'_>,
    candidates: &[Effect],
    watcher: &mut Watcher<'_>,
) -> Result<Vec<Seen>, Stopped> {
    let mut seen: Vec<Seen> = Vec::new();
    for some in candidates.chunks(TOGETHER) {
        ask(watcher)?;
        let screened = some.to_vec().into_par_iter().map(|effect| {
            let screened = screened(case, base, screen, &effect);
            (effect, screened)
        });
        seen.extend(screened.collect::<Vec<Seen>>());
    }
    Ok(seen)
}

/// How many independent questions the candidates that can be seen ask.
fn questions(seen: &[Seen]) -> f64 {
    let visible = seen.iter().filter(|(_, s)| is_visible(s));
    let directions: Vec<&[f64]> = visible
        .filter_map(|(_, s)| Some(&*s.as_ref().ok()?.direction))
        .collect();
    independent_questions(&directions)
}

fn screened_step(seen: &[Seen], outright: usize, round: usize) -> Step {
    let visible = seen.iter().filter(|(_, s)| is_visible(s)).count();
    Step::Screened {
        round,
        candidates: seen.len() + outright,
        visible: visible + outright,
    }
}

/// The candidates of which a linear step promises most, and all delays that can be seen.
fn promising(seen: &[Seen]) -> Vec<ToTry> {
    let mut promising: Vec<&Seen> = (seen.iter())
        .filter(|(_, s)| is_visible(s))
        .filter(|(_, s)| {
            s.as_ref()
                .is_ok_and(|s| s.promise.max(s.score) > WORTH_A_TRIAL)
        })
        .collect();
    let promise = |seen: &Seen| seen.1.as_ref().map_or(0.0, |s| s.promise);
    promising.sort_by(|a, b| promise(b).total_cmp(&promise(a)));
    promising.truncate(MOST_TRIALS);
    // a delay of some samples is no small change: one linear step says little of it
    let delays = (seen.iter()).filter(|(effect, s)| is_visible(s) && is_delay(effect));
    for delay in delays {
        if !promising.iter().any(|(effect, _)| *effect == delay.0) {
            promising.push(delay);
        }
    }
    promising
        .into_iter()
        .filter_map(|(effect, s)| Some((effect.clone(), Some(s.clone().ok()?))))
        .collect()
}

/// Fits the candidates; those that cannot be fitted are refused.
fn try_all(
    null_model: &NullModel<'_>,
    to_try: &[ToTry],
    number: usize,
    result: &mut Round,
    watcher: &mut Watcher<'_>,
) -> Result<Vec<Trial>, Stopped> {
    let mut trials: Vec<Trial> = Vec::new();
    for some in to_try.chunks(TOGETHER) {
        ask(watcher)?;
        let tried: Vec<(Effect, Result<Trial, String>)> = (some.to_vec().into_par_iter())
            .map(|(effect, screened)| (effect.clone(), null_model.trial(effect, screened)))
            .collect();
        for (effect, trial) in tried {
            match trial {
                Ok(trial) => {
                    let step = Step::Tried {
                        round: number,
                        name: effect.name(),
                        likelihood_ratio: trial.likelihood_ratio,
                    };
                    trials.push(trial);
                    tell(watcher, &step)?;
                }
                Err(why) => {
                    let refused = refused(effect, Refusal::NotFitted, why, None, None);
                    result.refused.push(refused);
                }
            }
        }
    }
    Ok(trials)
}

/// The trials that nothing speaks against; the others are refused.
fn object(
    null_model: &NullModel<'_>,
    trials: Vec<Trial>,
    threshold: &Threshold,
    number: usize,
    result: &mut Round,
    watcher: &mut Watcher<'_>,
) -> Result<Vec<Trial>, Stopped> {
    let mut passing: Vec<Trial> = Vec::new();
    for trial in trials {
        let Some((reason, why)) = null_model.objection(&trial, threshold) else {
            passing.push(trial);
            continue;
        };
        if reason != Refusal::NotSignificant {
            let step = Step::Refused {
                round: number,
                name: trial.effect.name(),
                reason,
                sentence: why.clone(),
            };
            tell(watcher, &step)?;
        }
        let refused = after_trial(&trial, reason, why, threshold);
        result.refused.push(refused);
    }
    passing.sort_by(|a, b| b.merit().total_cmp(&a.merit()));
    Ok(passing)
}

/// Candidates that were screened and not tried, refused for what the screen said.
fn untried(
    seen: &[Seen],
    passing: &[Trial],
    result: &Round,
    threshold: &Threshold,
) -> Vec<RefusedEffect> {
    let tried = |effect: &Effect| {
        result.refused.iter().any(|r| r.effect == *effect)
            || passing.iter().any(|t| t.effect == *effect)
    };
    (seen.iter())
        .filter(|(effect, _)| !tried(effect))
        .map(|(effect, screened)| after_screen(effect, screened, threshold))
        .collect()
}

/// Accepts the best of those that passed, with the group that the data cannot tell from it; the others were outdone.
fn choose(
    null_model: &NullModel<'_>,
    passing: Vec<Trial>,
    threshold: &Threshold,
    result: &mut Round,
) {
    let mut passing = passing.into_iter();
    let Some(best) = passing.next() else {
        return;
    };
    let others: Vec<Trial> = passing.collect();
    let others: Vec<&Trial> = others.iter().collect();
    let group = group(&best, &others);
    for other in others {
        let why = format!(
            "{} explains the data better, by {:.1} in the log-likelihood",
            best.effect.name(),
            0.5 * (best.merit() - other.merit())
        );
        let refused = after_trial(other, Refusal::Outdone, why, threshold);
        result.refused.push(refused);
    }
    result.accepted = Some(null_model.accepted(best, group, threshold));
}

fn is_delay(effect: &Effect) -> bool {
    effect.kind == EffectKind::Edit(EditKind::SensorDelay)
}

/// The screen of a candidate, from the best of its starts.
fn screened(
    case: &Case,
    base: &Fitted,
    screen: &Screen<'_>,
    effect: &Effect,
) -> Result<Screened, String> {
    let edited = effect
        .apply(&base.document)
        .map_err(|error| error.to_string())?;
    let mut best: Option<Screened> = None;
    let mut failure = String::new();
    let starts = starts(case, effect, &edited);
    let count = starts.len();
    for start in starts {
        match screen.of(&edited, &start) {
            Ok(seen) if best.as_ref().is_none_or(|best| seen.promise > best.promise) => {
                best = Some(seen)
            }
            Ok(_) => {}
            Err(why) => failure = why,
        }
    }
    let mut best = best.ok_or(failure)?;
    best.starts = count;
    Ok(best)
}
