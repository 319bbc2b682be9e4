//! One round: screen the catalogue, try what is promising, hear what speaks against it, choose one effect or none.

use rayon::prelude::*;

use super::accepted::Accepted;
use super::case::Case;
use super::effect::{Effect, EffectKind, Treatment};
use super::fitted::Fitted;
use super::gate::pass;
use super::group::group;
use super::null_model::NullModel;
use super::passed::{Noise, Passed};
use super::refused::{after_screen, after_trial, differs, not_fitted, not_significant};
use super::report::{Refusal, RefusedEffect, Step};
use super::screen::{Screen, Screened, independent_questions};
use super::starts::{is_tried_outright, starts};
use super::swapped;
use super::threshold::Threshold;
use super::trial::Trial;
use super::watch::{Stopped, Watcher, ask, tell};
use crate::model::{Added, EditKind};
use crate::stop;

/// Rounds, and so effects, at most: who lacks more than these has another model.
pub(super) const MOST_ROUNDS: usize = 6;

/// Below this share the declared parameters imitate an effect but for their own curvature: it counts as visible only
/// where even so a step promises much.
const INVISIBLE: f64 = 0.01;

/// A promise that curvature alone does not make.
const MUCH: f64 = 20.0;

/// Below this share what is left of an effect is rounding.
const ROUNDING: f64 = 1e-4;

/// A linear step must promise this much for a candidate to be fitted.
const WORTH_A_TRIAL: f64 = 6.0;

/// Candidates that are tried between two looks at whether the rest can still matter.
const TOGETHER: usize = 16;

/// Once a candidate has passed, one that promises less than this share of what has been reached is not tried.
const STILL_IN_PLAY: f64 = 0.3;

/// Of what came of a round.
pub(super) struct Round {
    pub accepted: Option<Accepted>,
    pub refused: Vec<RefusedEffect>,
    /// What passed beside the one that was accepted.
    pub others: Vec<Passed>,
    pub threshold: Threshold,
}

/// A candidate, and what the screen saw of it.
struct Seen {
    effect: Effect,
    /// `None` of what is tried outright, since it has no derivative at no effect.
    screened: Option<Screened>,
}

/// One round with `number`, from the fit of the model as it is; `earlier` are the parameters of the effects in it.
///
/// # Errors
/// The watcher stopped it.
pub(super) fn round(
    case: &Case,
    base: &Fitted,
    candidates: Vec<Effect>,
    earlier: &[Added],
    number: usize,
    watcher: &mut Watcher<'_>,
) -> Result<Round, Stopped> {
    let mut result = Round {
        accepted: None,
        refused: Vec::new(),
        others: Vec::new(),
        threshold: Threshold { questions: 1.0 },
    };
    let (Some(screen), Ok(null)) = (Screen::new(case, base), NullModel::new(case, base, earlier))
    else {
        return Ok(result);
    };
    let seen = screen_all(&screen, candidates, &mut result.refused, watcher)?;
    let count = seen.len();
    let (visible, hidden): (Vec<Seen>, Vec<Seen>) = seen.into_iter().partition(Seen::is_visible);
    let threshold = Threshold {
        questions: questions(&visible),
    };
    result.threshold = threshold;
    let step = Step::Screened {
        round: number,
        candidates: count,
        visible: visible.len(),
        promising: visible.iter().filter(|seen| in_play(seen, &[])).count(),
        rounds: MOST_ROUNDS.max(number),
    };
    tell(watcher, &step)?;
    result.refused.extend(hidden.iter().map(|seen| {
        let why = "the declared parameters imitate it: these data cannot show it, whether it is there or not";
        seen.refused((Refusal::Invisible, why.into()), threshold)
    }));
    let passed = try_promising(&null, visible, threshold, number, &mut result, watcher)?;
    choose(passed, threshold, &mut result);
    Ok(result)
}

impl Seen {
    fn is_visible(&self) -> bool {
        self.screened
            .as_ref()
            .is_none_or(|s| s.visible >= INVISIBLE || (s.visible >= ROUNDING && s.promise > MUCH))
    }

    /// What a linear step promises: of the likelihood with coloured noise, and of plain errors.
    fn promise(&self) -> (f64, f64) {
        (self.screened.as_ref()).map_or((f64::INFINITY, f64::INFINITY), |s| {
            (s.promise.max(s.score), s.plain)
        })
    }

    fn refused(&self, why: (Refusal, String), threshold: Threshold) -> RefusedEffect {
        match &self.screened {
            Some(screened) => after_screen(&self.effect, screened, why, threshold),
            None => not_fitted(self.effect.clone(), why.1),
        }
    }
}

/// Screens what has a derivative at no effect; the rest is to be tried outright.
fn screen_all(
    screen: &Screen<'_>,
    candidates: Vec<Effect>,
    refused: &mut Vec<RefusedEffect>,
    watcher: &mut Watcher<'_>,
) -> Result<Vec<Seen>, Stopped> {
    let mut all = Vec::new();
    for some in candidates.chunks(TOGETHER) {
        ask(watcher)?;
        let one = stop::shared(|effect: &Effect| seen(screen, effect));
        for seen in some.par_iter().map(one).collect::<Vec<_>>() {
            match seen {
                Ok(seen) => all.push(seen),
                Err(unfit) => refused.push(*unfit),
            }
        }
    }
    Ok(all)
}

/// A candidate, screened where it can be; or why it is refused.
fn seen(screen: &Screen<'_>, effect: &Effect) -> Result<Seen, Box<RefusedEffect>> {
    let effect = effect.clone();
    if let Some(why) = swapped::is_refuted(&effect, screen.base) {
        return Err(Box::new(not_significant(effect, why)));
    }
    if is_tried_outright(effect.kind)
        || effect.kind == EffectKind::Treatment(Treatment::ProcessNoise)
    {
        return Ok(Seen {
            effect,
            screened: None,
        });
    }
    match screened(screen, &effect) {
        Ok(screened) => Ok(Seen {
            effect,
            screened: Some(screened),
        }),
        Err(why) => Err(Box::new(not_fitted(effect, why))),
    }
}

/// The screen of a candidate, from the best of its starts.
fn screened(screen: &Screen<'_>, effect: &Effect) -> Result<Screened, String> {
    let base = &screen.base.document;
    let edited = effect.apply(base).map_err(|error| error.to_string())?;
    let mut best: Option<Screened> = None;
    let mut failure = String::new();
    let starts = starts(screen.case, effect, &edited);
    let count = starts.len();
    for start in starts {
        match screen.of(&edited, &start) {
            Ok(seen) if best.as_ref().is_none_or(|best| seen.promise > best.promise) => {
                best = Some(seen);
            }
            Ok(_) => {}
            Err(why) => failure = why,
        }
    }
    let mut best = best.ok_or(failure)?;
    best.starts = count;
    Ok(best)
}

/// How many independent questions the visible candidates ask.
fn questions(visible: &[Seen]) -> f64 {
    let screened = || visible.iter().filter_map(|seen| seen.screened.as_ref());
    let directions: Vec<&[f64]> = screened().map(|s| &*s.direction).collect();
    independent_questions(&directions) + (visible.len() - directions.len()) as f64
}

/// Tries what is promising, the most promising first, as long as what is left could still matter.
fn try_promising(
    null: &NullModel<'_>,
    visible: Vec<Seen>,
    threshold: Threshold,
    number: usize,
    result: &mut Round,
    watcher: &mut Watcher<'_>,
) -> Result<Vec<Passed>, Stopped> {
    let mut waiting = in_order(visible);
    let mut passed: Vec<Passed> = Vec::new();
    while !waiting.is_empty() {
        let rest = waiting.split_off(waiting.len().min(TOGETHER));
        let (tried, left): (Vec<Seen>, Vec<Seen>) =
            waiting.into_iter().partition(|seen| in_play(seen, &passed));
        result
            .refused
            .extend(left.iter().map(|seen| not_tried(seen, &passed, threshold)));
        ask(watcher)?;
        let trials: Vec<(Effect, Result<Trial, String>)> = (tried.into_par_iter())
            .map(stop::shared(|seen: Seen| {
                let effect = seen.effect.clone();
                (effect, Trial::of(null, seen.effect, seen.screened))
            }))
            .collect();
        let judged: Vec<_> = trials
            .into_par_iter()
            .map(stop::shared(|(effect, trial)| match trial {
                Ok(trial) => Ok(pass(null, trial, threshold)),
                Err(why) => Err(Box::new(not_fitted(effect, why))),
            }))
            .collect();
        for judged in judged {
            match judged {
                Err(unfit) => result.refused.push(*unfit),
                Ok(Ok(one)) => {
                    tell(watcher, &tried_step(&one.trial, number))?;
                    passed.push(one);
                }
                Ok(Err(refused)) => {
                    let (trial, why) = *refused;
                    tell(watcher, &tried_step(&trial, number))?;
                    tell_refusal(&trial, &why, number, watcher)?;
                    let refused = after_trial(&trial, why, None, threshold);
                    result.refused.push(refused);
                }
            }
        }
        waiting = rest;
    }
    Ok(passed)
}

fn tried_step(trial: &Trial, round: usize) -> Step {
    Step::Tried {
        round,
        name: trial.effect.name(),
        likelihood_ratio: trial.likelihood_ratio,
    }
}

fn tell_refusal(
    trial: &Trial,
    (reason, sentence): &(Refusal, String),
    round: usize,
    watcher: &mut Watcher<'_>,
) -> Result<(), Stopped> {
    if *reason == Refusal::NotSignificant {
        return Ok(());
    }
    let step = Step::Refused {
        round,
        name: trial.effect.name(),
        reason: *reason,
        sentence: sentence.clone(),
    };
    tell(watcher, &step)
}

/// Candidates by what they promise: the likelihood with coloured noise and plain errors take turns, for an effect that
/// is slow shows in these, and one that is quick in that. What is tried outright comes first.
fn in_order(visible: Vec<Seen>) -> Vec<Seen> {
    let ranks = |by: fn(&Seen) -> f64| {
        let mut order: Vec<usize> = (0..visible.len()).collect();
        order.sort_by(|&a, &b| by(&visible[b]).total_cmp(&by(&visible[a])));
        let mut ranks = vec![0; order.len()];
        order
            .iter()
            .enumerate()
            .for_each(|(rank, &place)| ranks[place] = rank);
        ranks
    };
    let (coloured, plain) = (
        ranks(|seen| seen.promise().0),
        ranks(|seen| seen.promise().1),
    );
    let mut ranked: Vec<(usize, Seen)> = (visible.into_iter().enumerate())
        .map(|(place, seen)| (coloured[place].min(plain[place]), seen))
        .collect();
    ranked.sort_by_key(|(rank, _)| *rank);
    ranked.into_iter().map(|(_, seen)| seen).collect()
}

/// Whether a candidate could still matter.
fn in_play(seen: &Seen, passed: &[Passed]) -> bool {
    let (coloured, plain) = seen.promise();
    // a delay of some samples is no small change: one linear step says little of it
    if seen.effect.kind == EffectKind::Edit(EditKind::SensorDelay) {
        return true;
    }
    if coloured <= WORTH_A_TRIAL {
        return false;
    }
    // promises against promises: a step from afar may promise far less than it leads to
    let reached = |of: fn(&Passed) -> (f64, f64)| {
        passed.iter().map(of).fold((0.0_f64, 0.0_f64), |best, one| {
            (best.0.max(one.0), best.1.max(one.1))
        })
    };
    let (by_likelihood, by_errors) = reached(Passed::promise);
    passed.is_empty()
        || coloured > STILL_IN_PLAY * by_likelihood
        || plain > STILL_IN_PLAY * by_errors
}

/// Why a candidate was left untried.
fn not_tried(seen: &Seen, passed: &[Passed], threshold: Threshold) -> RefusedEffect {
    let (promise, _) = seen.promise();
    let best = passed.iter().max_by(|a, b| {
        a.trial
            .likelihood_ratio
            .total_cmp(&b.trial.likelihood_ratio)
    });
    let why = match best {
        Some(best) if promise > WORTH_A_TRIAL => (
            Refusal::Outdone,
            format!(
                "not tried: one linear step promises a likelihood ratio of {promise:.1}, where {} reaches {:.1}",
                best.trial.effect.name(),
                best.trial.likelihood_ratio
            ),
        ),
        _ if seen.screened.as_ref().is_some_and(Screened::differs) => {
            let own = seen.screened.as_ref().map_or(0.0, |screened| screened.own);
            (Refusal::NotRepeatable, differs(promise, own))
        }
        _ => (
            Refusal::NotSignificant,
            format!(
                "one linear step promises a likelihood ratio of {:.1}, no more than noise gives",
                promise.max(0.0)
            ),
        ),
    };
    seen.refused(why, threshold)
}

/// Accepts the best of those that passed; the others were outdone.
fn choose(mut passed: Vec<Passed>, threshold: Threshold, result: &mut Round) {
    let noise = Noise::left_by(&passed);
    passed.sort_by(|a, b| b.merit(noise).total_cmp(&a.merit(noise)));
    let mut passed = passed.into_iter();
    let Some(best) = passed.next() else {
        return;
    };
    let others: Vec<Passed> = passed.collect();
    let group = group(&best, &others, noise);
    for other in &others {
        let why = format!(
            "{} is the better explanation, by {:.1} (gains of the likelihood and of plain errors, less the price of parameters and of an unusual size)",
            best.trial.effect.name(),
            best.merit(noise) - other.merit(noise)
        );
        let held_out: f64 = other.gains.iter().map(|gain| gain.gain).sum();
        result.refused.push(after_trial(
            &other.trial,
            (Refusal::Outdone, why),
            (!other.gains.is_empty()).then_some(held_out),
            threshold,
        ));
    }
    result.accepted = Some(Accepted::of(best, group, threshold));
    result.others = others;
}
