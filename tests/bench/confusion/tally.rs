//! Answers counted.

use std::collections::BTreeMap;

use trimtab_core::diagnose::{Diagnosis, Effect};

use crate::aircraft::Aircraft;
use crate::reached::Reached;

/// Validation error at most this share above the true model's.
const AS_GOOD: f64 = 1.05;

/// What one diagnosis answered.
pub(crate) struct Answer {
    aircraft: &'static str,
    colour: String,
    strength: String,
    truth: Option<Effect>,
    size: f64,
    seed: u64,
    /// The effect named first.
    first: Option<String>,
    /// The truth is the first, or a member of its group.
    right: bool,
    single: bool,
    /// What was named behind the first.
    more: Vec<String>,
    verdict: String,
    /// Why the truth was refused.
    why: String,
    reached: Reached,
}

impl Answer {
    pub(crate) fn of(
        aircraft: &Aircraft,
        colour: &str,
        strength: &str,
        sized: Option<(&Effect, f64, Reached)>,
        diagnosis: Option<&Diagnosis>,
        seed: u64,
    ) -> Self {
        let (truth, size, reached) = match sized {
            Some((truth, size, reached)) => (Some(truth), size, reached),
            None => (None, 0.0, Reached::default()),
        };
        let first = diagnosis.and_then(|d| d.effects.first());
        let is_truth = |effect: &Effect| truth.is_some_and(|truth| effect == truth);
        Self {
            aircraft: aircraft.name,
            colour: colour.to_string(),
            strength: strength.to_string(),
            truth: truth.cloned(),
            size,
            seed,
            reached,
            right: first
                .is_some_and(|first| first.group.iter().any(|member| is_truth(&member.effect))),
            single: first.is_some_and(|first| is_truth(&first.effect)),
            first: first.map(|first| first.effect.name()),
            more: diagnosis
                .iter()
                .flat_map(|d| d.effects.iter().skip(1))
                .map(|e| e.effect.name())
                .collect(),
            why: (diagnosis.iter().flat_map(|d| &d.refused))
                .find(|refused| is_truth(&refused.effect))
                .map_or(String::new(), |refused| refused.sentence.clone()),
            verdict: diagnosis.map_or("failed".to_string(), |d| d.verdict.name().to_string()),
        }
    }
}

/// What a diagnosis answered to two effects at once.
pub(crate) struct Both {
    pub aircraft: &'static str,
    pub truths: [Effect; 2],
    pub named: Vec<String>,
    pub found: usize,
}

impl Both {
    pub(crate) fn of(
        aircraft: &Aircraft,
        truths: [Effect; 2],
        diagnosis: Option<&Diagnosis>,
    ) -> Self {
        let effects = diagnosis.map(|d| d.effects.as_slice()).unwrap_or_default();
        let is_found = |truth: &&Effect| {
            effects
                .iter()
                .any(|effect| effect.group.iter().any(|member| member.effect == **truth))
        };
        Self {
            aircraft: aircraft.name,
            found: truths.iter().filter(is_found).count(),
            named: effects.iter().map(|effect| effect.effect.name()).collect(),
            truths,
        }
    }

    pub(crate) fn print(all: &[Self]) {
        let mut names: Vec<&str> = all.iter().map(|both| both.aircraft).collect();
        names.dedup();
        for both in all.iter().filter(|both| both.found < 2) {
            println!(
                "  {} and {}: {}",
                both.truths[0].name(),
                both.truths[1].name(),
                both.named.join(", ")
            );
        }
        for name in names {
            let of: Vec<&Self> = all.iter().filter(|both| both.aircraft == name).collect();
            let share = |least: usize| {
                100.0 * of.iter().filter(|both| both.found >= least).count() as f64
                    / of.len() as f64
            };
            println!(
                "{name:13} two at once {:6}  both named {:.1} %, at least one {:.1} %",
                of.len(),
                share(2),
                share(1)
            );
        }
    }
}

/// Of the answers that name the truth and nothing else.
fn unbiased(answers: &[&Answer]) -> String {
    let single = answers
        .iter()
        .filter(|a| a.right && a.single && a.verdict == "named");
    let (count, whole) = single.fold((0, 0), |(count, whole), answer| {
        let one = usize::from(answer.reached.biased.is_empty());
        (count + one, whole + 1)
    });
    format!("{count} of {whole}")
}

#[derive(Default)]
pub(crate) struct Tally(Vec<Answer>);

impl Tally {
    pub(crate) fn extend(&mut self, answers: Vec<Answer>) {
        self.0.extend(answers);
    }

    pub(crate) fn print(&self) {
        println!("truth and what was named first, where that was wrong:");
        let mut wrong: BTreeMap<(String, String, String, String), usize> = BTreeMap::new();
        for answer in self.0.iter().filter(|a| {
            if a.truth.is_some() {
                !a.right
            } else {
                a.first.is_some()
            }
        }) {
            let truth = answer
                .truth
                .as_ref()
                .map_or("nothing".to_string(), Effect::name);
            let named = answer
                .first
                .clone()
                .unwrap_or_else(|| format!("nothing ({})", answer.verdict));
            *wrong
                .entry((truth, answer.strength.clone(), answer.colour.clone(), named))
                .or_default() += 1;
        }
        for ((truth, strength, colour, named), count) in &wrong {
            println!("  {count:3} {truth} ({strength}, {colour}): {named}");
        }
        for answer in self
            .0
            .iter()
            .filter(|a| a.truth.is_some() && !a.right && !a.why.is_empty())
        {
            let truth = answer.truth.as_ref().map_or(String::new(), Effect::name);
            println!(
                "  refused {truth} = {:.4} (seed {}, {}, {}): {}",
                answer.size, answer.seed, answer.strength, answer.colour, answer.why
            );
        }
        println!("\nnamed behind the right one:");
        for answer in self.0.iter().filter(|a| a.right && !a.more.is_empty()) {
            let truth = answer.truth.as_ref().map_or(String::new(), Effect::name);
            println!(
                "  {truth} ({}, {}): {}",
                answer.strength,
                answer.colour,
                answer.more.join(", ")
            );
        }
        println!(
            "\nright, but predicted worse than 5 % above the true model, or a declared parameter still biased:"
        );
        for answer in self.0.iter().filter(|a| a.right) {
            let truth = answer.truth.as_ref().map_or(String::new(), Effect::name);
            let ratio = answer.reached.error_ratio.unwrap_or(1.0);
            if ratio > AS_GOOD || !answer.reached.biased.is_empty() {
                let biased: Vec<String> = (answer.reached.biased.iter())
                    .map(|(name, off)| format!("{name} {off:.1}"))
                    .collect();
                let named = answer.first.as_deref().unwrap_or_default();
                println!(
                    "  {truth} ({}, {}; named {named}): error ratio {ratio:.3}, biased {}",
                    answer.strength,
                    answer.colour,
                    biased.join(", ")
                );
            }
        }
        println!(
            "\naircraft      noise     strength   cases  right  named first  further effects  predicts as the true model  unbiased  unbiased where named singly"
        );
        let mut cells: BTreeMap<(&str, &str, &str), Vec<&Answer>> = BTreeMap::new();
        for answer in &self.0 {
            cells
                .entry((answer.aircraft, &answer.colour, &answer.strength))
                .or_default()
                .push(answer);
        }
        for ((aircraft, colour, strength), answers) in &cells {
            let n = answers.len();
            let share = |count: usize| format!("{:5.1} %", 100.0 * count as f64 / n as f64);
            let right = answers.iter().filter(|a| a.right).count();
            let of_right = |is: &dyn Fn(&Reached) -> bool| {
                let found = answers.iter().filter(|a| a.right && is(&a.reached)).count();
                format!("{:5.1} %", 100.0 * found as f64 / right.max(1) as f64)
            };
            let single = answers.iter().filter(|a| a.single).count();
            let more = answers.iter().filter(|a| !a.more.is_empty()).count();
            if *strength == "empty" {
                let false_alarms = answers.iter().filter(|a| a.first.is_some()).count();
                let odd = answers
                    .iter()
                    .filter(|a| a.verdict != "nothing_missing")
                    .count();
                println!(
                    "{aircraft:13} {colour:9} {strength:9} {n:6}  false alarms {} , verdict not nothing_missing {}",
                    share(false_alarms),
                    share(odd)
                );
            } else {
                println!(
                    "{aircraft:13} {colour:9} {strength:9} {n:6}  {}  {}  {}  {}  {}  {}",
                    share(right),
                    share(single),
                    share(more),
                    of_right(&|reached| reached.error_ratio.is_none_or(|ratio| ratio < AS_GOOD)),
                    of_right(&|reached| reached.biased.is_empty()),
                    unbiased(answers),
                );
            }
        }
    }
}
