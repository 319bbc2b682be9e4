//! What a diagnosis answers.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::candidates::TakenFor;
use super::effect::Effect;
use super::residual::ResidualAnalysis;
use super::unmodelled::Unmodelled;
use crate::estimate::{Estimate, OutputFit, Role};
use crate::model::ModelDocument;

/// What a diagnosis concludes.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// No effect passes, and the residual carries no signal that is coherent with an input.
    NothingMissing,
    /// Every effect found is named singly.
    Named,
    /// Found, but the data cannot tell the members of a group apart.
    NamedGroup,
    /// Something is missing, and nothing in the catalogue is it.
    Unexplained,
    /// The data cannot decide.
    NotTestable,
}

impl Verdict {
    /// As it is written in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::NothingMissing => "nothing_missing",
            Self::Named => "named",
            Self::NamedGroup => "named_group",
            Self::Unexplained => "unexplained",
            Self::NotTestable => "not_testable",
        }
    }
}

/// How sentences of verdicts begin.
pub(super) const NOTHING: &str =
    "no effect of the catalogue is missing, and what is left follows no input";
pub(super) const UNEXPLAINED: &str =
    "something is missing that no effect of the catalogue explains";
pub(super) const UNDECIDED: &str = "the data cannot decide";

/// The answer of a diagnosis.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Diagnosis {
    /// What is concluded.
    pub verdict: Verdict,
    /// The verdict in a sentence.
    #[schema(
        example = "alpha is recorded 62.1 ± 1.5 ms late (alpha_delay). RMS error of the prediction: alpha 0.31 to 0.11 deg"
    )]
    pub sentence: String,
    /// What is left unexplained, or to be done, as the sentence says it; absent where there is nothing of the kind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left_over: Option<String>,
    /// What the model lacked, in the order in which it was found.
    pub effects: Vec<NamedEffect>,
    /// All other candidates, with the reason.
    pub refused: Vec<RefusedEffect>,
    /// What the quantities of the model, and recorded channels beside it, were taken for.
    pub quantities: Vec<TakenFor>,
    /// Fit of each output, with the declared model and with the effects added.
    pub fits: Vec<FitChange>,
    /// Declared parameters, with the declared model and with the effects added.
    pub parameters: Vec<ParameterChange>,
    /// The declared model's estimate.
    pub before: Estimate,
    /// The declared model with the effects in it, estimates as start values.
    pub model: ModelDocument,
    /// What the effects changed in the document.
    pub diff: Vec<DocumentChange>,
    /// Of the residuals that are left.
    pub residuals: Vec<ResidualAnalysis>,
    /// Of the verdict `unexplained`: what is left, or where names are in doubt what the declared model leaves, as a force that
    /// the model does not have; absent where noise alone could leave as much.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unmodelled: Option<Unmodelled>,
    /// What the reader should know of how it was decided.
    pub remarks: Vec<String>,
}

impl Diagnosis {
    /// The verdict in a line: the effects with their sizes, or that there are none.
    pub fn headline(&self) -> String {
        let named: Vec<&str> = self.effects.iter().map(|e| e.sentence.as_str()).collect();
        let named = named.join("; ");
        match self.verdict {
            Verdict::Named | Verdict::NamedGroup => named,
            Verdict::NothingMissing => NOTHING.to_string(),
            Verdict::Unexplained if named.is_empty() => UNEXPLAINED.to_string(),
            Verdict::Unexplained => format!("{named}; more is missing"),
            Verdict::NotTestable => UNDECIDED.to_string(),
        }
    }
}

/// An effect that was accepted.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct NamedEffect {
    /// The likeliest of its group.
    #[serde(flatten)]
    pub effect: Effect,
    /// What it added, as estimated in the final model.
    pub parameters: Vec<EffectParameter>,
    /// Candidates that the data cannot tell from it, itself included, the likeliest first.
    pub group: Vec<Member>,
    /// Why it was accepted.
    pub evidence: Evidence,
    /// The effect with its size, in words.
    #[schema(example = "alpha is recorded 62.1 ± 1.5 ms late (alpha_delay)")]
    pub sentence: String,
}

/// A parameter that an effect added.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct EffectParameter {
    /// The parameter's name in the edited document.
    #[schema(example = "alpha_delay")]
    pub name: String,
    /// SI
    #[schema(example = "s")]
    pub unit: String,
    /// Which segment a per-maneuver parameter belongs to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub segment: Option<String>,
    /// In `unit`.
    #[schema(example = 0.0621)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub estimate: f64,
    /// Corrected for coloured residuals.
    pub standard_error: Option<f64>,
}

/// A member of an alias group.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Member {
    /// The candidate.
    #[serde(flatten)]
    pub effect: Effect,
    /// Share of the group's likelihood; the weights of a group add up to 1.
    #[schema(example = 0.83)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub weight: f64,
}

/// The numbers that an effect was accepted for.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Evidence {
    /// Twice the gain of the colour-aware log-likelihood on the estimation data.
    #[schema(example = 143.2)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub likelihood_ratio: f64,
    /// What it had to pass: the family of candidates errs at this once in a hundred diagnoses.
    #[schema(example = 15.1)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub threshold: f64,
    /// The score (Lagrange multiplier) statistic of the screen; absent of what has no derivative at zero.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub score: Option<f64>,
    /// How much of the effect the declared parameters cannot imitate, 0 to 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = 0.71)]
    pub visible_fraction: Option<f64>,
    /// The smallest effect that would have been seen with 80 % power, SI.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smallest_seen: Option<f64>,
    /// Twice the gain of the log-likelihood on flights that were not fitted; absent where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub held_out: Option<f64>,
    /// The same by output.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub held_out_by_output: Vec<OutputGain>,
}

/// The share of one output in a gain of the log-likelihood.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct OutputGain {
    /// The output's name.
    pub output: String,
    /// Negative: this output got worse.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub gain: f64,
}

/// A candidate that was not accepted.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct RefusedEffect {
    /// The candidate.
    #[serde(flatten)]
    pub effect: Effect,
    /// The first test that it failed.
    pub reason: Refusal,
    /// The reason in a sentence.
    pub sentence: String,
    /// Twice the gain of the colour-aware log-likelihood; absent of what was not tried.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub likelihood_ratio: Option<f64>,
    /// How much of the effect the declared parameters cannot imitate, 0 to 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub visible_fraction: Option<f64>,
    /// The smallest effect that would have been seen with 80 % power, SI.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smallest_seen: Option<f64>,
    /// Twice the gain of the log-likelihood on flights that were not fitted; absent where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub held_out: Option<f64>,
}

/// Why a candidate was not accepted.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Refusal {
    /// The declared parameters imitate it wholly: these data cannot show it, whether it is there or not.
    Invisible,
    /// What it would explain is no more than noise.
    NotSignificant,
    /// Another effect explains the data better.
    Outdone,
    /// Its estimate is at a bound of its physical range.
    OutOfRange,
    /// Sign or size differ from maneuver to maneuver.
    NotRepeatable,
    /// It does not help to predict the flights that were not fitted.
    NotPredictive,
    /// It was accepted, and others made it needless.
    Needless,
    /// The fit with it came to nothing.
    NotFitted,
}

/// The fit of one output, before and after.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct FitChange {
    /// Of the segments that it is about.
    pub role: Role,
    /// Absent: over all segments of the estimation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub segment: Option<String>,
    /// With the declared model.
    pub before: OutputFit,
    /// With the effects added.
    pub after: OutputFit,
}

/// A declared parameter, before and after.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ParameterChange {
    /// The parameter's name.
    pub name: String,
    /// The parameter's own unit.
    pub unit: String,
    /// Which segment a per-maneuver parameter belongs to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub segment: Option<String>,
    /// Its estimate with the declared model.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub before: f64,
    /// Its estimate with the effects added.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub after: f64,
    /// Of the estimate after, corrected for coloured residuals.
    pub standard_error: Option<f64>,
    /// How far it moved, in those standard errors: the bias that the missing effect made.
    pub shift: Option<f64>,
}

/// One place of the document that the effects changed.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct DocumentChange {
    /// RFC 6901, into the document.
    #[schema(example = "/outputs/alpha/delay")]
    pub pointer: String,
    /// The JSON value there before; absent: there was none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub before: Option<serde_json::Value>,
    /// The JSON value there now; absent: there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after: Option<serde_json::Value>,
}

/// What a diagnosis tells as it goes.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(tag = "step", rename_all = "snake_case")]
pub enum Step {
    /// A model was fitted: the declared one, or one with effects accepted.
    Fitted {
        /// Which round of the diagnosis, from 1; 0 is before the first.
        round: usize,
        /// -ln L at its estimate.
        #[serde(deserialize_with = "crate::flight::null_as_nan")]
        cost: f64,
        /// Iterations that the fit took.
        iterations: usize,
    },
    /// The catalogue was screened: how many candidates, and how many can be seen at all.
    Screened {
        /// Which round of the diagnosis, from 1.
        round: usize,
        /// Effects of the catalogue that make sense for the model, and the user's own.
        candidates: usize,
        /// Those that the declared parameters cannot imitate wholly.
        visible: usize,
        /// About how many of these are fitted: fewer where one explains much.
        #[serde(default)]
        promising: usize,
        /// How many rounds there are at most.
        #[serde(default)]
        rounds: usize,
    },
    /// A candidate was fitted.
    Tried {
        /// Which round of the diagnosis, from 1.
        round: usize,
        /// The candidate.
        name: String,
        /// Twice the gain of the colour-aware log-likelihood.
        #[serde(deserialize_with = "crate::flight::null_as_nan")]
        likelihood_ratio: f64,
    },
    /// A candidate failed a test.
    Refused {
        /// Which round of the diagnosis, from 1.
        round: usize,
        /// The candidate.
        name: String,
        /// Which test.
        reason: Refusal,
        /// The reason in a sentence.
        sentence: String,
    },
    /// A candidate passed all tests and is in the model now.
    Accepted {
        /// Which round of the diagnosis, from 1; 0 is before the first.
        round: usize,
        /// The effect.
        name: String,
        /// Twice the gain of the colour-aware log-likelihood.
        #[serde(deserialize_with = "crate::flight::null_as_nan")]
        likelihood_ratio: f64,
        /// The effect in words.
        sentence: String,
    },
}
