//! What a diagnosis answered, held against what was so.

use serde::Serialize;
use trimtab_core::diagnose::{Diagnosis, Effect, NamedEffect, Verdict};

use crate::case::{Setting, Sized};
use crate::design::Set;
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

/// What was so in one case, for answers to be held against it.
pub(crate) struct Judge<'c> {
    pub setting: &'c Setting,
    pub recordings: &'c [Recording],
    pub set: Set,
    pub sized: &'c Sized,
}

impl Judge<'_> {
    fn faults(&self) -> impl Iterator<Item = &Fault> {
        self.sized
            .iter()
            .map(|(fault, _)| &self.setting.aircraft.faults[*fault])
    }

    fn matches(&self, fault: &Fault, effect: &Effect) -> bool {
        let (kind, (target, term)) = (effect.word(), self.setting.place(effect));
        fault
            .answers
            .iter()
            .any(|answer| answer.is(&kind, &target, term.as_deref()))
    }

    pub(crate) fn outcome(&self, diagnosis: &Diagnosis) -> Outcome {
        let Some(first) = diagnosis.effects.first() else {
            return match diagnosis.verdict {
                Verdict::NotTestable => Outcome::NotTestable,
                Verdict::Unexplained => Outcome::Unexplained,
                _ if self.set == Set::Nulls => Outcome::Right,
                _ => Outcome::Missed,
            };
        };
        match self.set {
            Set::Nulls => Outcome::Wrong,
            Set::Effects => self.of_one(first),
            Set::Pairs => self.of_pair(diagnosis),
            Set::Unknown => match self.of_one(first) {
                // a name behind which something is said to be unexplained, or one of several, is not a confident one
                Outcome::Wrong if diagnosis.verdict == Verdict::Unexplained => Outcome::Unexplained,
                Outcome::Wrong if members(first).count() > 1 => Outcome::Group,
                outcome => outcome,
            },
        }
    }

    /// By name alone.
    fn named(&self, fault: &Fault, named: &NamedEffect) -> Option<Outcome> {
        let first = self.matches(fault, &named.effect);
        let in_group = members(named).any(|effect| self.matches(fault, effect));
        match (first, in_group, members(named).count()) {
            (true, _, 0 | 1) => Some(Outcome::Right),
            (true, ..) | (_, true, _) => Some(Outcome::Group),
            _ => None,
        }
    }

    /// The first name where there is but one fault.
    fn of_one(&self, first: &NamedEffect) -> Outcome {
        let (number, size) = self.sized[0];
        let fault = &self.setting.aircraft.faults[number];
        self.named(fault, first).unwrap_or_else(|| {
            let truth = (fault, size);
            let alike = oracle::is_alias(
                self.setting,
                self.recordings,
                truth,
                &first.effect,
                &first.parameters,
            );
            if alike {
                Outcome::Alias
            } else {
                Outcome::Wrong
            }
        })
    }

    fn of_pair(&self, diagnosis: &Diagnosis) -> Outcome {
        let effects = &diagnosis.effects;
        let is_found = |fault: &&Fault| {
            effects
                .iter()
                .any(|named| self.named(fault, named).is_some())
        };
        let first_is_one = self
            .faults()
            .any(|fault| self.named(fault, &effects[0]).is_some());
        match self.faults().filter(is_found).count() {
            2 => Outcome::Right,
            _ if effects.len() <= 2
                && oracle::explains(self.setting, self.recordings, &diagnosis.model, 2) =>
            {
                Outcome::Alias
            }
            1 if first_is_one => Outcome::Half,
            _ => Outcome::Wrong,
        }
    }

    /// Whether an answer to what is in no catalogue points to where it is: by the equation of the unmodelled force, or by
    /// name in what else is said. Of the force itself only the equation counts: its sentence names what it depends on, too.
    pub(crate) fn points(&self, diagnosis: &Diagnosis) -> bool {
        let force = diagnosis.unmodelled.as_ref();
        let of_force = force.map_or("", |force| force.sentence.as_str());
        let sentence = match of_force {
            "" => diagnosis.sentence.clone(),
            told => diagnosis.sentence.replace(told, ""),
        };
        let said = diagnosis.remarks.iter().chain([&sentence]);
        let said = said.chain(force.map(|force| &force.equation));
        let said: Vec<String> = said.map(|text| self.setting.own(text)).collect();
        let is_part = |c: char| c.is_alphanumeric() || c == '_';
        let words: Vec<&str> = said
            .iter()
            .flat_map(|text| text.split(|c| !is_part(c)))
            .collect();
        self.is_shown_in(|place| words.contains(&place))
    }

    /// Whether the unmodelled force acts where the truth is; `None` where none is shown.
    pub(crate) fn force_points(&self, diagnosis: &Diagnosis) -> Option<bool> {
        let force = diagnosis.unmodelled.as_ref()?;
        let equation = self.setting.own(&force.equation);
        Some(self.is_shown_in(|place| place == equation))
    }

    fn is_shown_in(&self, says: impl Fn(&str) -> bool) -> bool {
        self.faults()
            .any(|fault| fault.shows_in.iter().any(|place| says(place)))
    }

    /// Why the truth itself was refused, if it was.
    pub(crate) fn refusal(&self, diagnosis: &Diagnosis) -> Option<String> {
        let is_truth = |effect: &Effect| self.faults().any(|fault| self.matches(fault, effect));
        let refused = diagnosis
            .refused
            .iter()
            .find(|refused| is_truth(&refused.effect))?;
        Some(refused.sentence.clone())
    }
}

fn members(named: &NamedEffect) -> impl Iterator<Item = &Effect> {
    let likely = named.group.iter().filter(|member| member.weight > UNLIKELY);
    likely.map(|member| &member.effect)
}
