//! One round: screen the catalogue, try what is promising, accept one effect or none.

use std::ops::ControlFlow;

use rayon::prelude::*;

use super::case::Case;
use super::colour::Colour;
use super::effect::{Effect, EffectKind, Treatment};
use super::fitted::Fitted;
use super::found::Accepted;
use super::group::group;
use super::null_model::{NullModel, POWER, Threshold};
use super::report::{Refusal, RefusedEffect, Step};
use super::screen::{Screen, Screened, independent_questions};
use super::stack::Layout;
use super::trial::{Trial, is_tried_outright, starts};
use crate::model::EditKind;

/// Below this share the declared parameters imitate an effect but for their own curvature: it counts as visible only
/// where even so a step promises much.
const INVISIBLE: f64 = 0.01;

/// A promise that curvature alone does not make.
const MUCH: f64 = 20.0;

/// Below this share what is left of an effect is rounding.
const ROUNDING: f64 = 1e-4;

/// A linear step must promise this much for a candidate to be fitted.
const WORTH_A_TRIAL: f64 = 6.0;
const MOST_TRIALS: usize = 16;

/// Candidates between two occasions to stop.
const TOGETHER: usize = 8;

/// The outcome of a round.
pub(super) struct Round {
    pub accepted: Option<Accepted>,
    pub refused: Vec<RefusedEffect>,
    pub stopped: bool,
}

/// Told of all progress, and asked every now and then with nothing to tell; may stop the diagnosis.
pub type Watcher<'o> = dyn FnMut(Option<&Step>) -> ControlFlow<()> + 'o;

/// A screened candidate, or why it was not.
type Seen = (Effect, Result<Screened, String>);

pub(super) fn round(
    case: &Case,
    base: &Fitted,
    candidates: Vec<Effect>,
    number: usize,
    watcher: &mut Watcher<'_>,
) -> Round {
    let layout = Layout::of(&base.problem);
    let colour = Colour::of_best_order(&layout, &base.residual);
    let mut result = Round {
        accepted: None,
        refused: Vec::new(),
        stopped: false,
    };
    let Some(screen) = Screen::new(case, base, &colour) else {
        return result;
    };
    let (outright, local): (Vec<Effect>, Vec<Effect>) =
        candidates.into_iter().partition(|effect| {
            is_tried_outright(effect.kind)
                || matches!(effect.kind, EffectKind::Treatment(Treatment::ProcessNoise))
        });
    let mut seen: Vec<Seen> = Vec::new();
    for some in local.chunks(TOGETHER) {
        if watcher(None).is_break() {
            result.stopped = true;
            return result;
        }
        let screened = some.to_vec().into_par_iter().map(|effect| {
            let screened = screened(case, base, &screen, &effect);
            (effect, screened)
        });
        seen.extend(screened.collect::<Vec<Seen>>());
    }
    let visible: Vec<&Seen> = seen.iter().filter(|(_, s)| is_visible(s)).collect();
    let directions: Vec<&[f64]> = visible
        .iter()
        .filter_map(|(_, s)| Some(&*s.as_ref().ok()?.direction))
        .collect();
    let questions = independent_questions(&directions) + outright.len() as f64;
    let step = Step::Screened {
        round: number,
        candidates: seen.len() + outright.len(),
        visible: visible.len() + outright.len(),
    };
    if watcher(Some(&step)).is_break() {
        result.stopped = true;
        return result;
    }
    let threshold = Threshold { questions };

    let mut promising: Vec<&Seen> = visible;
    promising.retain(|(_, s)| {
        s.as_ref()
            .is_ok_and(|s| s.promise.max(s.score) > WORTH_A_TRIAL)
    });
    let promise = |seen: &Seen| seen.1.as_ref().map_or(0.0, |s| s.promise);
    promising.sort_by(|a, b| promise(b).total_cmp(&promise(a)));
    promising.truncate(MOST_TRIALS);
    // a delay of some samples is no small change: one linear step says little of it
    let delays = seen
        .iter()
        .filter(|(effect, s)| is_visible(s) && is_delay(effect));
    for delay in delays {
        if !promising.iter().any(|(effect, _)| *effect == delay.0) {
            promising.push(delay);
        }
    }
    let mut to_try: Vec<(Effect, Option<Screened>)> = promising
        .iter()
        .filter_map(|(effect, s)| Some((effect.clone(), Some(s.clone().ok()?))))
        .collect();
    let coloured = colour.orders().iter().any(|&order| order > 0);
    to_try.extend(
        outright
            .into_iter()
            .filter(|effect| coloured || !effect.is_noise())
            .map(|e| (e, None)),
    );

    let orders = colour.orders();
    let null_model = NullModel::new(case, base, &orders);
    let mut trials: Vec<Trial> = Vec::new();
    for some in to_try.chunks(TOGETHER) {
        if watcher(None).is_break() {
            result.stopped = true;
            return result;
        }
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
                    if watcher(Some(&step)).is_break() {
                        result.stopped = true;
                        return result;
                    }
                }
                Err(why) => {
                    result
                        .refused
                        .push(refused(effect, Refusal::NotFitted, why, None, None))
                }
            }
        }
    }

    let mut passing: Vec<Trial> = Vec::new();
    for trial in trials {
        match null_model.objection(&trial, &threshold) {
            None => passing.push(trial),
            Some((reason, why)) => {
                if reason != Refusal::NotSignificant {
                    let step = Step::Refused {
                        round: number,
                        name: trial.effect.name(),
                        reason,
                        sentence: why.clone(),
                    };
                    if watcher(Some(&step)).is_break() {
                        result.stopped = true;
                    }
                }
                result
                    .refused
                    .push(of_trial(&trial, reason, why, &threshold));
            }
        }
    }
    passing.sort_by(|a, b| b.merit().total_cmp(&a.merit()));
    let tried = |effect: &Effect| {
        result.refused.iter().any(|r| r.effect == *effect)
            || passing.iter().any(|t| t.effect == *effect)
    };
    let untried: Vec<RefusedEffect> = seen
        .iter()
        .filter(|(effect, _)| !tried(effect))
        .map(|(effect, screened)| of_screen(effect, screened, &threshold))
        .collect();
    let mut passing = passing.into_iter();
    if let Some(best) = passing.next() {
        let others: Vec<Trial> = passing.collect();
        let others: Vec<&Trial> = others.iter().collect();
        let group = group(&best, &others);
        for other in others {
            let why = format!(
                "{} explains the data better, by {:.1} in the log-likelihood",
                best.effect.name(),
                0.5 * (best.merit() - other.merit())
            );
            result
                .refused
                .push(of_trial(other, Refusal::Outdone, why, &threshold));
        }
        result.accepted = Some(null_model.accepted(best, group, &threshold));
    }
    result.refused.extend(untried);
    result
}

fn is_delay(effect: &Effect) -> bool {
    effect.kind == EffectKind::Edit(EditKind::SensorDelay)
}

fn is_visible(screened: &Result<Screened, String>) -> bool {
    screened
        .as_ref()
        .is_ok_and(|s| s.visible >= INVISIBLE || (s.visible >= ROUNDING && s.promise > MUCH))
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

fn refused(
    effect: Effect,
    reason: Refusal,
    sentence: String,
    likelihood_ratio: Option<f64>,
    seen: Option<(&Screened, f64)>,
) -> RefusedEffect {
    RefusedEffect {
        effect,
        reason,
        sentence,
        likelihood_ratio,
        visible_fraction: seen.map(|(s, _)| s.visible),
        smallest_seen: seen.map(|(s, root)| s.one_sigma * (root + POWER)),
        held_out: None,
    }
}

fn of_trial(trial: &Trial, reason: Refusal, why: String, threshold: &Threshold) -> RefusedEffect {
    let seen = trial
        .screened
        .as_ref()
        .map(|s| (s, threshold.of(1, 1).sqrt()));
    let held_out = trial.held_out.as_ref().map(|gains| gains.iter().sum());
    RefusedEffect {
        held_out,
        ..refused(
            trial.effect.clone(),
            reason,
            why,
            Some(trial.likelihood_ratio),
            seen,
        )
    }
}

fn of_screen(
    effect: &Effect,
    screened: &Result<Screened, String>,
    threshold: &Threshold,
) -> RefusedEffect {
    let seen = match screened {
        Err(why) => return refused(effect.clone(), Refusal::NotFitted, why.clone(), None, None),
        Ok(seen) => seen,
    };
    let root = threshold.of(1, 1).sqrt();
    if !is_visible(screened) {
        let why = "the declared parameters imitate it: these data cannot show it, whether it is there or not";
        return RefusedEffect {
            smallest_seen: None,
            ..refused(
                effect.clone(),
                Refusal::Invisible,
                why.into(),
                None,
                Some((seen, root)),
            )
        };
    }
    let why = format!(
        "one linear step promises a likelihood ratio of {:.1}, no more than noise gives",
        seen.promise.max(0.0)
    );
    refused(
        effect.clone(),
        Refusal::NotSignificant,
        why,
        Some(seen.promise),
        Some((seen, root)),
    )
}
