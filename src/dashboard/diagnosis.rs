//! A diagnosis as a story: what was found, the errors before and after, what that changed, what is left, what was refused.

use maud::{Markup, html};

use super::{model_diff, unmodelled};
use crate::diagnose::{Diagnosis, FitChange, Member, NamedEffect, Refusal, RefusedEffect, Verdict};
use crate::estimate::{Role, five_digits as number};
use crate::flight::{Shown, bounded, shown_in};

/// A member of a group that is less likely is not told in the verdict.
const UNLIKELY: f64 = 0.01;

/// The whole story; `picture` shows what the effects explain.
pub(super) fn story(diagnosis: &Diagnosis, picture: &Markup) -> Markup {
    html! {
        section aria-labelledby="diagnosis" {
            h2 id="diagnosis" { "What the model lacks" }
            (verdict(diagnosis))
            @for remark in &diagnosis.remarks { p.note { (remark) } }
            h3 { "Errors before and after" }
            (fits(&diagnosis.fits))
            @if !diagnosis.effects.is_empty() { (picture) }
            @for (at, effect) in diagnosis.effects.iter().enumerate() { (named(at + 1, effect)) }
            @if !diagnosis.diff.is_empty() {
                h3 { "What was added to the model" }
                (model_diff::changes([(&diagnosis.model, "declared model"), (&diagnosis.model, "with the effects")], &diagnosis.diff))
                h3 { "What that did to the declared parameters" }
                (parameters(diagnosis))
            }
            @if let Some(left) = left_over(diagnosis) {
                h3 { "What is not explained" }
                p { (left) }
            }
            @if let Some(found) = &diagnosis.unmodelled { (unmodelled::section(found)) }
            (refused(&diagnosis.refused))
        }
    }
}

/// What was found, each effect with its size.
fn verdict(diagnosis: &Diagnosis) -> Markup {
    html! {
        div.verdict {
            @match diagnosis.effects.as_slice() {
                [] => p { strong { (in_a_word(diagnosis)) }
                    @if diagnosis.verdict == Verdict::NotTestable { @if let Some(remedy) = &diagnosis.left_over { ": " (remedy) } } },
                [effect] => p { strong { (in_a_word(diagnosis)) ": " } (effect.sentence) (alternatives(effect)) },
                effects => {
                    p { strong { (in_a_word(diagnosis)) ":" } }
                    ol { @for effect in effects { li { (effect.sentence) (alternatives(effect)) } } }
                }
            }
        }
    }
}

fn in_a_word(diagnosis: &Diagnosis) -> &'static str {
    match diagnosis.verdict {
        Verdict::NothingMissing => "Nothing is missing",
        Verdict::Named => "Found",
        Verdict::NamedGroup => "Found, as one of a group",
        Verdict::Unexplained if diagnosis.effects.is_empty() => {
            "Something is missing that no effect of the catalogue explains"
        }
        Verdict::Unexplained => "Found, and more is missing",
        Verdict::NotTestable => "The data cannot decide",
    }
}

/// A remedy stands in the verdict.
fn left_over(diagnosis: &Diagnosis) -> Option<&str> {
    let left = diagnosis.left_over.as_deref();
    left.filter(|_| diagnosis.verdict != Verdict::NotTestable)
}

/// What the data cannot tell an effect from.
fn alternatives(effect: &NamedEffect) -> Markup {
    let name = effect.effect.name();
    let others = effect
        .group
        .iter()
        .filter(|member| member.effect.name() != name);
    let others: Vec<&Member> = others.filter(|member| member.weight > UNLIKELY).collect();
    html! {
        @if !others.is_empty() {
            "; or, which the data cannot tell from it, "
            @for (at, member) in others.iter().enumerate() {
                @if at > 0 { ", " } (member.effect.name()) " (" (format!("{:.0} %", 100.0 * member.weight)) ")"
            }
        }
    }
}

/// Rms residual of each output with the declared model and with the effects in it, flights that took no part first.
fn fits(fits: &[FitChange]) -> Markup {
    let mut sorted: Vec<&FitChange> = fits.iter().collect();
    sorted.sort_by_key(|fit| match fit.role {
        Role::Final => 0,
        Role::Validation => 1,
        Role::Estimation => 2,
    });
    html! {
        div.scroll tabindex="0" role="region" aria-label="Rms residual before and after" {
            table {
                thead { tr {
                    th scope="col" { "flights" } th scope="col" { "output" } th scope="col" { "unit" }
                    th.number scope="col" { "rms residual before" } th.number scope="col" { "after" } th.number scope="col" { "change" }
                    th scope="col" { "before, after" }
                } }
                tbody { @for fit in sorted { (fit_row(fit)) } }
            }
        }
    }
}

fn fit_row(fit: &FitChange) -> Markup {
    let Shown { scale, unit } = shown_in(&fit.before.unit);
    let (before, after) = (fit.before.rms, fit.after.rms);
    let largest = before.max(after);
    let width = |rms: f64| {
        let share = if largest > 0.0 { rms / largest } else { 0.0 };
        format!("width: {:.1}rem", 8.0 * share)
    };
    html! {
        tr {
            td { (part(fit.role)) @if let Some(segment) = &fit.segment { " " span.soft { (segment) } } }
            td { (fit.before.name) } td.soft { (unit) }
            td.number { (number(before * scale)) } td.number { (number(after * scale)) }
            td.number { @if before > 0.0 { (format!("{:+.1} %", 100.0 * (after / before - 1.0))) } }
            td { span.bar style=(width(before)) {} span.bar.after style=(width(after)) {} }
        }
    }
}

/// What part a flight takes, in a word.
pub(super) fn part(role: Role) -> &'static str {
    match role {
        Role::Estimation => "estimation",
        Role::Validation => "validation",
        Role::Final => "final test",
    }
}

fn named(at: usize, effect: &NamedEffect) -> Markup {
    let evidence = &effect.evidence;
    html! {
        h3 { (at) ". " (effect.effect.word()) ": " (effect.effect.target) }
        p { (effect.sentence) }
        div.scroll tabindex="0" role="region" aria-label="What the effect added" {
            table {
                thead { tr {
                    th scope="col" { "added parameter" } th scope="col" { "unit" } th.number scope="col" { "estimate" } th.number scope="col" { "standard error" }
                } }
                tbody {
                    @for parameter in &effect.parameters {
                        @let Shown { scale, unit } = shown_in(&parameter.unit);
                        tr {
                            th scope="row" { (parameter.name) @if let Some(segment) = &parameter.segment { " [" (segment) "]" } }
                            td.soft { (unit) }
                            @for cell in bounded(parameter.estimate * scale, parameter.standard_error.map(|error| error * scale)) { td.number { (cell) } }
                        }
                    }
                }
            }
        }
        dl.facts {
            dt { "evidence" } dd {
                "likelihood ratio " (format!("{:.1}", evidence.likelihood_ratio)) ", to pass: " (format!("{:.1}", evidence.threshold))
            }
            @if let Some(gain) = evidence.held_out {
                dt { "on flights not fitted" } dd { "twice the gain of ln L: " (format!("{gain:.1}")) }
            }
            @if let Some(share) = evidence.visible_fraction {
                dt { "visible" } dd { (format!("{:.0} %", 100.0 * share)) " of it is not imitated by declared parameters" }
            }
        }
        @if effect.group.len() > 1 {
            p { "The data cannot tell apart, with weights by likelihood:" }
            ul { @for member in &effect.group { li { (member.effect.name()) ", " (format!("{:.0} %", 100.0 * member.weight)) } } }
        }
    }
}

fn parameters(diagnosis: &Diagnosis) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label="Declared parameters before and after" {
            table {
                thead { tr {
                    th scope="col" { "parameter" } th scope="col" { "unit" } th.number scope="col" { "declared model" } th.number scope="col" { "with the effects" }
                    th.number scope="col" { "standard error" } th.number scope="col" { "shift, standard errors" }
                } }
                tbody {
                    @for parameter in &diagnosis.parameters {
                        @let Shown { scale, unit } = shown_in(&parameter.unit);
                        tr {
                            th scope="row" { (parameter.name) @if let Some(segment) = &parameter.segment { " [" (segment) "]" } }
                            td.soft { (unit) }
                            td.number { (number(parameter.before * scale)) }
                            @for cell in bounded(parameter.after * scale, parameter.standard_error.map(|error| error * scale)) { td.number { (cell) } }
                            td.number { @if let Some(shift) = parameter.shift { (format!("{shift:+.1}")) } }
                        }
                    }
                }
            }
        }
    }
}

/// The other candidates, the likeliest first, by what became of them.
fn refused(effects: &[RefusedEffect]) -> Markup {
    let mut sorted: Vec<&RefusedEffect> = effects.iter().collect();
    let ratio = |effect: &RefusedEffect| effect.likelihood_ratio.unwrap_or(f64::NEG_INFINITY);
    sorted.sort_by(|a, b| ratio(b).total_cmp(&ratio(a)));
    let stood_out = |effect: &&RefusedEffect| {
        !matches!(effect.reason, Refusal::Invisible | Refusal::NotSignificant)
    };
    let (rivals, others): (Vec<_>, Vec<_>) = sorted.into_iter().partition(stood_out);
    html! {
        h3 { "Refused candidates" }
        @if rivals.is_empty() { p { "No other candidate stood out from the noise." } }
        @else {
            details { summary { "Candidates that stood out from the noise, and why they were refused (" (rivals.len()) ")" } (candidates(&rivals)) }
        }
        @if !others.is_empty() {
            details {
                summary { "Candidates that explain no more than noise, or that these data cannot show (" (others.len()) ")" }
                (candidates(&others))
            }
        }
    }
}

fn candidates(effects: &[&RefusedEffect]) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label="Candidates" {
            table {
                thead { tr { th scope="col" { "candidate" } th.number scope="col" { "likelihood ratio" } th scope="col" { "refused because" } th scope="col" { "in full" } } }
                tbody {
                    @for effect in effects {
                        tr {
                            th scope="row" { (effect.effect.name()) }
                            td.number { @if let Some(ratio) = effect.likelihood_ratio { (format!("{ratio:.1}")) } }
                            td { (because(effect.reason)) }
                            td.soft.words { (effect.sentence) }
                        }
                    }
                }
            }
        }
    }
}

fn because(reason: Refusal) -> &'static str {
    match reason {
        Refusal::Invisible => "these data cannot show it",
        Refusal::NotSignificant => "no more than noise",
        Refusal::Outdone => "another explains more",
        Refusal::OutOfRange => "beyond what is physical",
        Refusal::NotRepeatable => "differs from flight to flight",
        Refusal::NotPredictive => "predicts no better",
        Refusal::Needless => "needless with the others",
        Refusal::NotFitted => "could not be fitted",
    }
}
