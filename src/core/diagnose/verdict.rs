//! The verdict, and the verdict in a sentence.

use super::accepted::Accepted;
use super::case::Case;
use super::effect::EffectKind;
use super::fitted::Fitted;
use super::found::Found;
use super::report::{
    FitChange, NOTHING, NamedEffect, Refusal, RefusedEffect, UNDECIDED, UNEXPLAINED, Verdict,
};
use super::unmodelled::Unmodelled;
use crate::estimate::{Role, five_digits};
use crate::flight::{Shown, shown_in};
use crate::model::EditKind;

/// A member of an alias group that is less likely than this does not keep the likeliest from being named singly.
const UNLIKELY: f64 = 0.01;

/// Fewer samples than this for each free parameter decide nothing.
const LEAST_SAMPLES: usize = 5;

/// So many terms describe what is missing; their forms are hardly those of nature.
const PATCHWORK: usize = 3;

/// What is left when all rounds are over.
pub(super) struct Left<'l> {
    /// Outputs, and inputs that their residuals still follow.
    pub coherent: &'l [(String, String)],
    /// A candidate that explains clearly more than chance, and was refused all the same.
    pub refused: Option<&'l RefusedEffect>,
    /// How many terms the equations of motion were given, see [`terms`].
    pub terms: usize,
    /// A rate that something pushes which nothing recorded tells of.
    pub pushed: Option<&'l str>,
    /// Whether the names are in doubt.
    pub doubt: Option<Doubt>,
    /// A force in one equation, where white noise alone would hardly leave it.
    pub force: Option<&'l Unmodelled>,
}

/// A force of no form explains what the declared model leaves as well as what was named: twice the gains of ln L.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Doubt {
    pub named: f64,
    pub force: f64,
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
    let patched = left.terms >= PATCHWORK;
    let doubtful = patched || left.doubt.is_some() || left.pushed.is_some();
    let follows = !left.coherent.is_empty() || forced || doubtful;
    if follows || (found.accepted.is_empty() && left.refused.is_some()) {
        return Verdict::Unexplained;
    }
    let members = |accepted: &Accepted| likely(&accepted.group).count();
    match found.accepted.iter().map(members).max() {
        None => Verdict::NothingMissing,
        Some(1) => Verdict::Named,
        Some(_) => Verdict::NamedGroup,
    }
}

/// How many terms the equations of motion were given.
pub(super) fn terms(found: &Found) -> usize {
    use EditKind::{MissingTerm, StallHysteresis, UnrecordedInput, UnsteadyAero};
    let is_term = |accepted: &&Accepted| {
        matches!(
            accepted.effect.kind,
            EffectKind::Edit(MissingTerm | StallHysteresis | UnrecordedInput | UnsteadyAero)
        )
    };
    found.accepted.iter().filter(is_term).count()
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
    left_over: Option<&str>,
) -> String {
    let left_over = left_over.unwrap_or_default();
    match verdict {
        Verdict::Named | Verdict::NamedGroup => with_errors(effects, fits),
        Verdict::NothingMissing => NOTHING.into(),
        Verdict::Unexplained if effects.is_empty() => format!("{UNEXPLAINED}: {left_over}"),
        Verdict::Unexplained => {
            let found = with_errors(effects, fits);
            format!("{found}. That is not all: {left_over}")
        }
        Verdict::NotTestable => format!("{UNDECIDED}: {left_over}"),
    }
}

/// What is left unexplained, or to be done.
pub(super) fn left_over(verdict: Verdict, left: &Left<'_>) -> Option<String> {
    match verdict {
        Verdict::Named | Verdict::NamedGroup | Verdict::NothingMissing => None,
        Verdict::Unexplained => Some(what_is_left(left)),
        Verdict::NotTestable => Some(
            "fly another maneuver that moves every input, at least some seconds long".to_string(),
        ),
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

fn clear_but_refused(refused: &RefusedEffect) -> String {
    let RefusedEffect {
        effect, sentence, ..
    } = refused;
    let name = effect.name();
    match refused.reason {
        Refusal::NotPredictive | Refusal::NotRepeatable => format!(
            "{name} is clearly there in the flights that were fitted, but not as such in all: {sentence}"
        ),
        _ => format!("{name} would explain much of it, but {sentence}"),
    }
}

fn what_is_left(left: &Left<'_>) -> String {
    let mut parts = Vec::new();
    if !left.coherent.is_empty() {
        let follows: Vec<String> = (left.coherent.iter())
            .map(|(output, input)| format!("{output} follows {input}"))
            .collect();
        parts.push(format!("what is left of {}", follows.join(", of ")));
    }
    parts.extend(left.refused.map(clear_but_refused));
    parts.extend(left.doubt.map(|Doubt { named, force }| {
        format!("its name is in doubt: a force of no form in one equation of the declared model explains about as much (2 ln L {force:.0}, the effects named {named:.0})")
    }));
    if left.terms >= PATCHWORK {
        parts.push(format!(
            "{} terms together describe what is missing: what it is has another form",
            left.terms
        ));
    }
    parts.extend(left.pushed.map(|rate| {
        format!("what disturbs {rate} is no turbulence, which would come by the flow, and nothing recorded tells of it")
    }));
    parts.extend(left.force.map(|force| force.sentence.clone()));
    parts.join("; ")
}
