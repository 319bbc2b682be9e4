//! Effects beside turbulence: what passed without it is fitted again by the filter that knows of it.

use rayon::prelude::*;

use super::accepted::Accepted;
use super::case::{Case, Values};
use super::disturbed::fit;
use super::effect::EffectKind;
use super::fitted::Fitted;
use super::gate::holds;
use super::group::alone;
use super::passed::Passed;
use super::threshold::Threshold;
use super::trial::Trial;
use crate::model::EditKind;
use crate::stop;

/// Candidates that are fitted again, the likeliest first: what turbulence leaves of the rest is less still.
const MOST_TRIED: usize = 6;

/// The likeliest of some candidates beside the process noise of a fit; `None` where none is clearly there.
pub(super) fn beside_noise(
    case: &Case,
    base: &Fitted,
    candidates: &[Passed],
    threshold: Threshold,
) -> Option<Accepted> {
    let mut candidates: Vec<&Passed> = candidates.iter().filter(|one| is_spoken_for(one)).collect();
    candidates.sort_by(|a, b| {
        let of = |passed: &Passed| passed.trial.likelihood_ratio;
        of(b).total_cmp(&of(a))
    });
    candidates.truncate(MOST_TRIED);
    let tried: Vec<Passed> = (candidates.into_par_iter())
        .filter_map(stop::shared(|passed| {
            filtered(case, base, passed, threshold)
        }))
        .collect();
    let price = |passed: &Passed| {
        let samples = passed.settled.problem.samples().max(1) as f64;
        passed.trial.likelihood_ratio - passed.trial.freedom as f64 * samples.ln()
    };
    let best = tried
        .into_iter()
        .max_by(|a, b| price(a).total_cmp(&price(b)))?;
    let group = alone(&best.trial.effect);
    Some(Accepted::of(best, group, threshold))
}

/// Whether flights that were not fitted spoke for it: a filter predicts a sample ahead, and with it on one flight alone much
/// seems to be better. Turbulence and a gust of one flight explain the same.
fn is_spoken_for(passed: &Passed) -> bool {
    let effect = &passed.trial.effect;
    let gain: f64 = passed.gains.iter().map(|gain| gain.gain).sum();
    !effect.is_noise() && effect.kind != EffectKind::Edit(EditKind::Gust) && gain > 0.0
}

/// A candidate fitted with the process noise of `base`; `None` where it is not clearly there beside it, or the filter
/// knows no such effect.
fn filtered(case: &Case, base: &Fitted, passed: &Passed, threshold: Threshold) -> Option<Passed> {
    let Passed { trial, settled, .. } = passed;
    let edited = trial.effect.apply(&base.document).ok()?;
    let names = edited.added.iter().map(|added| added.name.as_str());
    let names: Vec<&str> = names.collect();
    let start: Values = (settled.values().into_iter())
        .filter(|((name, _), _)| names.contains(&name.as_str()))
        .collect();
    let mut problem = case
        .problem(&edited.document, &base.values_with(&start))
        .ok()?;
    problem.options = base.problem.options.clone();
    let fitted = fit(edited.document, problem).ok()?;
    let likelihood_ratio = 2.0 * (fitted.ln_evidence() - base.ln_evidence());
    let least = threshold.of(trial.freedom, trial.starts);
    let is_there =
        likelihood_ratio >= least && holds(&trial.effect, &fitted, &edited.added).is_ok();
    is_there.then(|| Passed {
        trial: Trial {
            likelihood_ratio,
            added: edited.added,
            ..trial.clone()
        },
        settled: fitted,
        gains: Vec::new(),
        plain_gain: None,
    })
}
