//! A diagnosis as a story: what was left over, what it was traced to, what that changed, and what was refused.

use maud::{Markup, html};

use super::{model_diff, unmodelled};
use crate::diagnose::{Diagnosis, FitChange, NamedEffect, Refusal, RefusedEffect, Verdict};
use crate::estimate::{Role, five_digits as number};
use crate::flight::{Shown, shown_in};

/// The whole story.
pub(super) fn story(diagnosis: &Diagnosis) -> Markup {
    html! {
        section aria-labelledby="diagnosis" {
            h2 id="diagnosis" { "What the model lacks" }
            p.verdict { strong { (in_a_word(diagnosis.verdict)) } ": " (diagnosis.sentence) }
            @for remark in &diagnosis.remarks { p.note { (remark) } }
            h3 { "Before and after" }
            (fits(&diagnosis.fits))
            @for (at, effect) in diagnosis.effects.iter().enumerate() { (named(at + 1, effect)) }
            @if !diagnosis.diff.is_empty() {
                h3 { "What was added to the model" }
                (model_diff::changes([(&diagnosis.model, "declared model"), (&diagnosis.model, "with the effects")], &diagnosis.diff))
                h3 { "What that did to the declared parameters" }
                (parameters(diagnosis))
            }
            @if let Some(found) = &diagnosis.unmodelled { (unmodelled::section(found)) }
            (refused(&diagnosis.refused))
        }
    }
}

fn in_a_word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NothingMissing => "Nothing is missing",
        Verdict::Named => "Found",
        Verdict::NamedGroup => "Found, as one of a group",
        Verdict::Unexplained => "Something is missing that no candidate explains",
        Verdict::NotTestable => "The data cannot decide",
    }
}

/// Rms residual of each output with the declared model and with the effects in it, flights that took no part last.
fn fits(fits: &[FitChange]) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label="Rms residual before and after" {
            table {
                thead { tr {
                    th scope="col" { "flights" } th scope="col" { "output" } th scope="col" { "unit" }
                    th.number scope="col" { "rms residual before" } th.number scope="col" { "after" } th.number scope="col" { "change" }
                    th scope="col" { "before, after" }
                } }
                tbody { @for fit in fits { (fit_row(fit)) } }
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
        Role::Estimation => "fitted",
        Role::Validation => "checked on",
        Role::Final => "kept for the end",
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
                            td.soft { (unit) } td.number { (number(parameter.estimate * scale)) }
                            td.number { @if let Some(error) = parameter.standard_error { (number(error * scale)) } }
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
            p { "The data cannot tell it from these; weights by likelihood:" }
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
                            td.number { (number(parameter.before * scale)) } td.number { (number(parameter.after * scale)) }
                            td.number.soft { @if let Some(error) = parameter.standard_error { (number(error * scale)) } }
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
        h3 { "What was tried and refused" }
        @if rivals.is_empty() { p { "No other candidate stood out from the noise." } }
        @else { (candidates(&rivals)) }
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
