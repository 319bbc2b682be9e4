//! Something that is so and that the declared model does not say, in a size that is to be chosen.

use crate::plant::Plant;
use crate::random::Random;

/// What a diagnosis may call it: a word of the catalogue, a target and, where the kind has one, a term.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Answer {
    pub kind: &'static str,
    /// `*` is any.
    pub target: String,
    /// Absent: any.
    pub term: Option<String>,
}

impl Answer {
    pub(crate) fn new(kind: &'static str, target: &str, term: Option<&str>) -> Self {
        Self {
            kind,
            target: target.to_string(),
            term: term.map(ToString::to_string),
        }
    }

    /// Whether kind, targets (in any order) and term are these; terms without blanks, and their factors in any order.
    pub(crate) fn is(&self, kind: &str, target: &str, term: Option<&str>) -> bool {
        let targets = |text: &str| {
            let mut all: Vec<String> = text.split('+').map(|t| t.trim().to_string()).collect();
            all.sort();
            all
        };
        let plain = |text: &str| {
            let mut factors: Vec<String> = text
                .split('*')
                .map(|factor| factor.split_whitespace().collect())
                .collect();
            factors.sort();
            factors
        };
        let same_term = match (&self.term, term) {
            (Some(own), Some(term)) => plain(own) == plain(term),
            (None, _) => true,
            (Some(_), None) => false,
        };
        let same_target = self.target == "*" || targets(&self.target) == targets(target);
        self.kind == kind && same_target && same_term
    }
}

/// Size, number of the flight, what is to be changed, random numbers of the case and flight.
pub(crate) type Install = Box<dyn Fn(f64, usize, &mut Plant, &mut Random)>;

/// How sizes are found for a strength.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Sizing {
    /// By the likelihood ratio of a noise-free flight, from a guess; larger than `most` no aircraft has it.
    Worth { guess: f64, most: f64 },
    /// By the filter's likelihood of noisy flights: what disturbs the states has no noise-free flight.
    Disturbance { guess: f64, most: f64 },
    /// Given for weak, moderate and clear.
    Given([f64; 3]),
}

pub(crate) struct Fault {
    /// In the catalogue of effects.
    pub known: bool,
    /// The word of the catalogue, or the judge's own for what is in no catalogue.
    pub kind: &'static str,
    /// The kind and where it is, for people and `--only`.
    pub name: String,
    /// Names that are right. Of what is in no catalogue: names that are tolerated.
    pub answers: Vec<Answer>,
    /// Of what is in no catalogue: equations or outputs that an honest answer points to.
    pub shows_in: Vec<String>,
    pub sizing: Sizing,
    /// It may have either sign.
    pub signed: bool,
    pub install: Install,
}

impl Fault {
    pub(crate) fn new(
        answer: Answer,
        sizing: Sizing,
        install: impl Fn(f64, usize, &mut Plant, &mut Random) + 'static,
    ) -> Self {
        let of = match &answer.term {
            Some(term) => format!("{} {term} in {}", answer.kind, answer.target),
            None => format!("{} {}", answer.kind, answer.target),
        };
        Self {
            known: true,
            kind: answer.kind,
            name: of,
            answers: vec![answer],
            shows_in: Vec::new(),
            sizing,
            signed: true,
            install: Box::new(install),
        }
    }

    /// What has a size above zero only.
    pub(crate) fn positive(self) -> Self {
        Self {
            signed: false,
            ..self
        }
    }

    /// Another name that is as right.
    pub(crate) fn or(mut self, kind: &'static str, target: &str, term: Option<&str>) -> Self {
        self.answers.push(Answer::new(kind, target, term));
        self
    }
}
