//! An effect: a word of the catalogue, what it is aimed at, and what it changes.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::plausible::Plausible;
use crate::model::{Edit, EditError, EditKind, Edited, ModelDocument, Start};

/// What kind of effect. Most are edits of the model document; the others change how it is fitted.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub enum EffectKind {
    /// An edit of the model document.
    Edit(EditKind),
    /// Another way to fit.
    Treatment(Treatment),
}

/// Effects that no equation expresses.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Treatment {
    /// Turbulence: the states are disturbed, and the filter-error method is needed.
    ProcessNoise,
    /// Spikes, dropouts and stuck values: samples that do not count.
    SensorOutliers,
    /// Edits of the user's own.
    Own,
}

/// One candidate for what a model lacks.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Effect {
    /// The word of the catalogue.
    pub kind: EffectKind,
    /// An output, an input, a state or a named coefficient; the name of a candidate of the user's own.
    #[schema(example = "alpha")]
    pub target: String,
    /// What else the kind needs, as of an [`Edit`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "alpha^2")]
    pub term: Option<String>,
    /// The edits that make it; none of a treatment.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub edits: Vec<Edit>,
    /// The range in which its size, the first parameter that it frees or adds, is looked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plausible: Option<Plausible>,
}

impl Effect {
    /// Whether a size of zero is no effect; a rate limit or a stall is absent at the other end of its range.
    pub(super) fn vanishes_at_zero(&self) -> bool {
        use EditKind::{ActuatorRateLimit, StallHysteresis};
        !matches!(
            self.kind,
            EffectKind::Edit(ActuatorRateLimit | StallHysteresis)
        )
    }

    /// Whether another is no candidate any more once this one is in the model: itself, and of a flow that separates once
    /// another separation.
    pub(super) fn rules_out(&self, other: &Self) -> bool {
        let stall = EffectKind::Edit(EditKind::StallHysteresis);
        self == other || (self.kind == stall && other.kind == stall)
    }

    /// Effects that stand at one place in time repeat in no other part.
    pub(super) fn is_local_in_time(&self) -> bool {
        use EditKind::{Gust, InitialState};
        matches!(self.kind, EffectKind::Edit(Gust | InitialState))
    }

    /// A single edit of the document.
    pub fn edit(kind: EditKind, target: impl Into<String>, term: Option<&str>) -> Self {
        Self::of(Edit {
            term: term.map(ToString::to_string),
            ..Edit::new(kind, target)
        })
    }

    /// The effect that is one edit.
    pub fn of(edit: Edit) -> Self {
        Self {
            kind: EffectKind::Edit(edit.kind),
            target: edit.target.clone(),
            term: edit.term.clone(),
            edits: vec![edit],
            plausible: None,
        }
    }

    /// An effect that no equation expresses.
    pub fn treatment(kind: Treatment, target: impl Into<String>) -> Self {
        Self {
            kind: EffectKind::Treatment(kind),
            target: target.into(),
            term: None,
            edits: Vec::new(),
            plausible: None,
        }
    }

    /// A candidate of the user's own.
    pub fn own(name: impl Into<String>, edits: Vec<Edit>) -> Self {
        Self {
            edits,
            ..Self::treatment(Treatment::Own, name)
        }
    }

    /// The document with the effect in it, and what all its edits added.
    ///
    /// # Errors
    /// An edit does not fit the document.
    pub fn apply(&self, document: &ModelDocument) -> Result<Edited, EditError> {
        let mut whole = Edited {
            document: document.clone(),
            added: Vec::new(),
            inputs: Vec::new(),
        };
        for edit in &self.edits {
            let edited = edit.apply(&whole.document)?;
            whole.document = edited.document;
            whole.added.extend(edited.added);
            whole.inputs.extend(edited.inputs);
        }
        let size = whole.added.first();
        let size = size.and_then(|added| whole.document.parameters.get_mut(&added.name));
        if let (Some(plausible), Some(size)) = (&self.plausible, size) {
            let is_held = self.kind == EffectKind::Edit(EditKind::FixedParameter);
            let none = match size.start {
                Start::Value(value) if is_held => value,
                _ => 0.0,
            };
            plausible.bound(size, none);
        }
        Ok(whole)
    }

    /// Process noise: what no model document expresses, and what ends a diagnosis.
    pub fn is_noise(&self) -> bool {
        self.kind == EffectKind::Treatment(Treatment::ProcessNoise)
    }

    /// The word of the catalogue.
    pub fn word(&self) -> String {
        let word = serde_json::to_value(self.kind).ok();
        word.and_then(|word| word.as_str().map(ToString::to_string))
            .unwrap_or_default()
    }

    /// `sensor_scale of q`, `missing_term alpha^2 in q`.
    pub fn name(&self) -> String {
        let word = self.word();
        match (&self.term, self.kind) {
            (Some(term), EffectKind::Edit(EditKind::MissingTerm)) => {
                format!("{word} {term} in {}", self.target)
            }
            (Some(term), _) => format!("{word} of {} ({term})", self.target),
            (None, EffectKind::Treatment(Treatment::Own)) => self.target.clone(),
            (None, _) => format!("{word} of {}", self.target),
        }
    }

    /// Whether it is the same but for the numbers in it.
    pub fn is(&self, kind: EffectKind, target: &str) -> bool {
        self.kind == kind && self.target == target
    }
}
