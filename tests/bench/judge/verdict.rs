//! What a diagnosis answered, held against what was so.

use serde::Serialize;
use trimtab_core::diagnose::{Diagnosis, NamedEffect, Verdict};

use crate::case::Setting;
use crate::design::{Design, Set};
use crate::fault::Fault;
use crate::oracle;
use crate::record::Recording;

#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Outcome {
    /// Named first and singly; of nulls: nothing was named.
    Right,
    /// Named in a group that the data cannot tell apart.
    Group,
    /// Named otherwise, and the oracle cannot tell the two apart either.
    Alias,
    /// One of a pair.
    Half,
    /// Something else was named first; of nulls: a false alarm.
    Wrong,
    /// Nothing was named, and nothing said to be missing.
    Missed,
    /// Nothing was named, and something said to be missing.
    Unexplained,
    NotTestable,
    /// The diagnosis failed.
    Failed,
    /// No size makes the fault this strong in this model: there was no case.
    Unseeable,
}

/// Members of a group below this weight do not count.
const UNLIKELY: f64 = 0.01;

fn matches(setting: &Setting, fault: &Fault, effect: &trimtab_core::diagnose::Effect) -> bool {
    let (kind, target) = (effect.word(), setting.own(&effect.target));
    let term = effect.term.as_deref().map(|term| setting.own(term));
    fault
        .answers
        .iter()
        .any(|answer| answer.is(&kind, &target, term.as_deref()))
}

fn members(named: &NamedEffect) -> impl Iterator<Item = &trimtab_core::diagnose::Effect> {
    let likely = named.group.iter().filter(|member| member.weight > UNLIKELY);
    likely.map(|member| &member.effect)
}

/// Of one named effect and one fault.
fn single(
    setting: &Setting,
    recordings: &[Recording],
    faults: usize,
    fault: &Fault,
    named: &NamedEffect,
) -> Outcome {
    let in_group = members(named).any(|effect| matches(setting, fault, effect));
    let first = matches(setting, fault, &named.effect);
    if first && members(named).count() <= 1 {
        Outcome::Right
    } else if first || in_group {
        Outcome::Group
    } else if faults == 1
        && oracle::is_alias(
            setting,
            recordings,
            faults,
            &named.effect,
            &named.parameters,
        )
    {
        Outcome::Alias
    } else {
        Outcome::Wrong
    }
}

pub(crate) fn judge(
    setting: &Setting,
    recordings: &[Recording],
    design: &Design,
    diagnosis: &Diagnosis,
) -> Outcome {
    let Some(first) = diagnosis.effects.first() else {
        return match diagnosis.verdict {
            Verdict::NotTestable => Outcome::NotTestable,
            Verdict::Unexplained => Outcome::Unexplained,
            _ if design.set == Set::Nulls => Outcome::Right,
            _ => Outcome::Missed,
        };
    };
    let faults: Vec<&Fault> = design
        .faults
        .iter()
        .map(|f| &setting.aircraft.faults[*f])
        .collect();
    match design.set {
        Set::Nulls => Outcome::Wrong,
        Set::Unknown => of_unknown(setting, recordings, faults[0], diagnosis),
        Set::Effects => single(setting, recordings, 1, faults[0], first),
        Set::Pairs => {
            let of = |fault: &Fault, named: &NamedEffect| {
                single(setting, recordings, 2, fault, named) != Outcome::Wrong
            };
            let found = faults
                .iter()
                .filter(|fault| diagnosis.effects.iter().any(|named| of(fault, named)));
            match found.count() {
                2 => Outcome::Right,
                1 if faults.iter().any(|fault| of(fault, first)) => Outcome::Half,
                _ => Outcome::Wrong,
            }
        }
    }
}

/// What is in no catalogue has no right name: one that is tolerated, or fits as well as the truth, or a group, or any
/// name behind which the diagnosis says that something is still unexplained.
fn of_unknown(
    setting: &Setting,
    recordings: &[Recording],
    fault: &Fault,
    diagnosis: &Diagnosis,
) -> Outcome {
    let outcomes = diagnosis
        .effects
        .iter()
        .map(|named| single(setting, recordings, 1, fault, named));
    let outcomes: Vec<Outcome> = outcomes.collect();
    match outcomes[0] {
        Outcome::Wrong if diagnosis.verdict == Verdict::Unexplained => Outcome::Unexplained,
        Outcome::Wrong if members(&diagnosis.effects[0]).count() > 1 => Outcome::Group,
        first => first,
    }
}

/// Whether an answer to what is in no catalogue points to where it is: by name, in what it says is left.
pub(crate) fn points(setting: &Setting, fault: &Fault, diagnosis: &Diagnosis) -> bool {
    let said = diagnosis.remarks.iter().chain([&diagnosis.sentence]);
    let said: Vec<String> = said.map(|text| setting.own(text)).collect();
    let words = said
        .iter()
        .flat_map(|text| text.split(|c: char| !c.is_alphanumeric() && c != '_'));
    let words: Vec<&str> = words.collect();
    fault
        .shows_in
        .iter()
        .any(|place| words.contains(&place.as_str()))
}

/// Why the truth itself was refused, if it was.
pub(crate) fn refusal(setting: &Setting, design: &Design, diagnosis: &Diagnosis) -> Option<String> {
    let faults: Vec<&Fault> = design
        .faults
        .iter()
        .map(|f| &setting.aircraft.faults[*f])
        .collect();
    let refused = (diagnosis.refused.iter()).find(|refused| {
        faults
            .iter()
            .any(|fault| matches(setting, fault, &refused.effect))
    })?;
    Some(refused.sentence.clone())
}
