//! The verdict, and the verdict in a sentence.

use super::accepted::Accepted;
use super::case::Case;
use super::effect::EffectKind;
use super::fitted::Fitted;
use super::found::Found;
use super::report::{FitChange, NamedEffect, Refusal, RefusedEffect, Verdict};
use super::unmodelled::Unmodelled;
use crate::estimate::{Role, five_digits};
use crate::flight::{Shown, shown_in};
use crate::model::EditKind;

/// A member of an alias group that is less likely than this does not keep the likeliest from being named singly.
const UNLIKELY: f64 = 0.01;

/// Fewer samples than this for each free parameter decide nothing.
const LEAST_SAMPLES: usize = 5;

/// What is left when all rounds are over.
pub(super) struct Left<'l> {
    /// Outputs, and inputs that their residuals still follow.
    pub coherent: &'l [(String, String)],
    /// Something that is clearly there, but not in all flights.
    pub differs: Option<&'l RefusedEffect>,
    /// A force in one equation, where white noise alone would hardly leave it.
    pub force: Option<&'l Unmodelled>,
}

pub(super) fn of(case: &Case, declared: &Fitted, found: &Found, left: &Left<'_>) -> Verdict {
    let problem = &declared.problem;
    if found.accepted.is_empty() {
        let too_short = problem.samples() < LEAST_SAMPLES * problem.unknowns.len();
        if too_short || nothing_moves(declared) || unrepeated(case, found) {
            return Verdict::NotTestable;
        }
    }
    let forced = left.force.is_some_and(Unmodelled::is_clear);
    let follows = !left.coherent.is_empty() || forced;
    if follows || (found.accepted.is_empty() && left.differs.is_some()) {
        return Verdict::Unexplained;
    }
    let members = |accepted: &Accepted| likely(&accepted.group).count();
    match found.accepted.iter().map(members).max() {
        None => Verdict::NothingMissing,
        Some(1) => Verdict::Named,
        Some(_) => Verdict::NamedGroup,
    }
}

fn nothing_moves(declared: &Fitted) -> bool {
    let problem = &declared.problem;
    let still = |u: &Vec<f64>| u.iter().all(|v| *v == u[0]);
    !problem.model.inputs.is_empty()
        && (problem.segments.iter()).all(|segment| segment.inputs.iter().all(still))
}

/// Something was significant, and there is but one maneuver on which to see whether it repeats.
fn unrepeated(case: &Case, found: &Found) -> bool {
    let differs = |refused: &RefusedEffect| refused.reason == Refusal::NotRepeatable;
    case.flights.len() == 1 && found.refused.iter().any(differs)
}

fn likely(group: &[super::report::Member]) -> impl Iterator<Item = &super::report::Member> {
    group.iter().filter(|member| member.weight > UNLIKELY)
}

pub(super) fn sentence(
    verdict: Verdict,
    effects: &[NamedEffect],
    fits: &[FitChange],
    left: &Left<'_>,
) -> String {
    match verdict {
        Verdict::Named | Verdict::NamedGroup => with_errors(effects, fits),
        Verdict::NothingMissing => {
            "no effect of the catalogue is missing, and what is left follows no input".into()
        }
        Verdict::Unexplained if effects.is_empty() => {
            format!(
                "something is missing that no effect of the catalogue explains: {}",
                what_is_left(left)
            )
        }
        Verdict::Unexplained => {
            let found = with_errors(effects, fits);
            format!("{found}. That is not all: {}", what_is_left(left))
        }
        Verdict::NotTestable => {
            "the data cannot decide: fly another maneuver that moves every input, at least some seconds long".into()
        }
    }
}

/// The effects in words, each with those that the data cannot tell from it.
fn found(effects: &[NamedEffect]) -> String {
    let of = |effect: &NamedEffect| {
        let members: Vec<String> = likely(&effect.group)
            .map(|member| format!("{} ({:.0} %)", member.effect.name(), 100.0 * member.weight))
            .collect();
        if members.len() < 2 {
            return effect.sentence.clone();
        }
        format!(
            "{} (the data cannot tell apart: {})",
            effect.sentence,
            members.join(", ")
        )
    };
    effects.iter().map(of).collect::<Vec<_>>().join("; ")
}

fn with_errors(effects: &[NamedEffect], fits: &[FitChange]) -> String {
    let found = found(effects);
    // no flight tells of another's gust
    let is_gust = |effect: &NamedEffect| effect.effect.kind == EffectKind::Edit(EditKind::Gust);
    let roles: &[Role] = match effects.iter().all(is_gust) {
        true => &[Role::Estimation],
        false => &[Role::Final, Role::Validation, Role::Estimation],
    };
    match errors(roles, fits) {
        Some(errors) => format!("{found}. {errors}"),
        None => found,
    }
}

/// RMS errors before and after, on data of the first of some roles that there is.
fn errors(roles: &[Role], fits: &[FitChange]) -> Option<String> {
    let mut roles = roles.iter().copied();
    let role = roles.find(|role| fits.iter().any(|fit| fit.role == *role))?;
    let of: Vec<String> = (fits.iter().filter(|fit| fit.role == role))
        .map(|fit| {
            let Shown { scale, unit } = shown_in(&fit.after.unit);
            let [before, after] = [&fit.before, &fit.after].map(|fit| five_digits(fit.rms * scale));
            format!("{} {before} to {after} {unit}", fit.before.name)
        })
        .collect();
    let on = match role {
        Role::Estimation => "of the fit",
        Role::Validation => "of the prediction",
        Role::Final => "of the prediction of data that took no part in any decision",
    };
    Some(format!("RMS error {on}: {}", of.join(", ")))
}

fn what_is_left(left: &Left<'_>) -> String {
    let mut parts = Vec::new();
    if !left.coherent.is_empty() {
        let follows: Vec<String> = (left.coherent.iter())
            .map(|(output, input)| format!("{output} follows {input}"))
            .collect();
        parts.push(format!("what is left of {}", follows.join(", of ")));
    }
    if let Some(differs) = left.differs {
        parts.push(format!(
            "{} is clearly there in the flights that were fitted, but not as such in all: {}",
            differs.effect.name(),
            differs.sentence
        ));
    }
    parts.extend(left.force.map(|force| force.sentence.clone()));
    parts.join("; ")
}
