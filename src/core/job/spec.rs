//! What a client asks for.

use std::fmt;

use indexmap::IndexMap;
use serde::de::value::MapAccessDeserializer;
use serde::de::{self, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use utoipa::ToSchema;

use super::constant::ConstantValue;
use super::strict::Strict;
use crate::diagnose::Knowledge;
use crate::estimate::{Options, Role};
use crate::flight::Flown;
use crate::model::{Edit, ModelDocument, Prior, Start};
use crate::structure::StructureOptions;

/// A job: a kind, a model, maneuvers, and how the one meets the others.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct JobSpec {
    /// What is wanted of the model and the data.
    #[serde(default)]
    pub kind: JobKind,
    /// For people; not unique.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schema(example = "ATTAS elevator 3-2-1-1, run 1")]
    pub name: String,
    /// For people, to find jobs by.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(example = json!(["flight 12"]))]
    pub tags: Vec<String>,
    /// Jobs of a higher priority are taken first: -10 to 10, and not above what the key allows. Among equals each key is
    /// served in turn.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schema(minimum = -10, maximum = 10)]
    pub priority: i32,
    /// The declared model.
    pub model: ModelSource,
    /// Edits of the model, applied in order: an effect is an edit.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub edits: Vec<Edit>,
    /// One or more; fitted together.
    #[schema(min_items = 1)]
    pub maneuvers: Vec<ManeuverUse>,
    /// How model inputs and outputs are made from recorded channels, where not simply by name. Formulas have numbers with or
    /// without units (`9.80665[m/s^2]`), the functions of equations, and those of recordings: `first`, `mean`, `largest_rate`,
    /// `interpolated`, `held`, `fresh`, `unwrap`, `delayed`, `lowpass`, `smoothed`, `derivative`, `north`, `east`, `airspeed`.
    #[serde(
        default,
        deserialize_with = "crate::model::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    #[schema(example = json!({"da": "(da_right - da_left)/2"}))]
    pub channels: IndexMap<String, String>,
    /// Other start values, bounds or fixings than the document's.
    #[serde(
        default,
        deserialize_with = "crate::model::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    #[schema(example = json!({"q_bias": {"fixed": true, "start": 0.0}}))]
    pub parameters: IndexMap<String, ParameterOverride>,
    /// Other values of the model's constants (mass, wing area, lever arms): a number in the constant's own unit, or where it
    /// stands in what is said of each recording, as `recording.mass`.
    #[serde(
        default,
        deserialize_with = "crate::model::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    #[schema(example = json!({"m": 17600.0, "Iy": "recording.inertia.Iy"}))]
    pub constants: IndexMap<String, ConstantValue>,
    /// Of a diagnosis: effects of your own, tried beside those of the catalogue.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub candidates: Vec<Candidate>,
    /// Of a diagnosis: what is known before the data.
    #[serde(default, skip_serializing_if = "is_nothing")]
    pub knowledge: Knowledge,
    /// Of a structure determination: which output is explained by which terms.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub structure: Option<StructureOptions>,
    /// How to estimate; each option has a default.
    #[serde(default)]
    pub options: Options,
    /// Which warnings refuse the job, before it starts or when its fit has ended: `true` for all, or a list of codes. The
    /// table of findings has them.
    #[serde(default, skip_serializing_if = "Strict::is_default")]
    #[schema(example = json!(["held_channel", "not_converged"]))]
    pub strict: Strict,
}

impl JobSpec {
    /// A job on a model as it stands, with every option at its default.
    pub fn new(kind: JobKind, model: ModelSource, maneuvers: Vec<ManeuverUse>) -> Self {
        Self {
            kind,
            name: String::new(),
            tags: Vec::new(),
            priority: 0,
            model,
            edits: Vec::new(),
            maneuvers,
            channels: IndexMap::new(),
            parameters: IndexMap::new(),
            constants: IndexMap::new(),
            candidates: Vec::new(),
            structure: None,
            knowledge: Default::default(),
            options: Options::default(),
            strict: Strict::default(),
        }
    }
}

impl JobSpec {
    /// Whether a constant stands in what is said of a recording.
    pub fn refers_to_recordings(&self) -> bool {
        let of_maneuvers = self
            .maneuvers
            .iter()
            .flat_map(|usage| usage.constants.values());
        let mut all = self.constants.values().chain(of_maneuvers);
        all.any(|value| value.number().is_none())
    }

    /// How the model's quantity `name` is made from the channels of a maneuver: as the maneuver says, or the job, or by
    /// name.
    pub(super) fn formula<'s>(&'s self, maneuver: usize, name: &'s str) -> &'s str {
        let own = self.maneuvers[maneuver].channels.get(name);
        own.or_else(|| self.channels.get(name))
            .map_or(name, String::as_str)
    }

    /// What a maneuver is called in tables.
    pub(super) fn label(&self, maneuver: usize) -> String {
        let label = self.maneuvers[maneuver].label.clone();
        label.unwrap_or_else(|| (maneuver + 1).to_string())
    }
}

/// The highest priority that there is; the lowest is its negative.
pub const HIGHEST_PRIORITY: i32 = 10;

fn is_nothing(knowledge: &Knowledge) -> bool {
    *knowledge == Knowledge::default()
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks so")]
fn is_zero(priority: &i32) -> bool {
    *priority == 0
}

/// An effect that a model may lack, as edits of it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Candidate {
    /// What the effect is called in the diagnosis.
    #[schema(example = "spoiler on the yawing moment")]
    pub name: String,
    /// Applied in order; the parameters that they add are the size of the effect.
    pub edits: Vec<Edit>,
}

/// What a job does.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum JobKind {
    /// Estimation of parameters, by `options.estimator`.
    #[default]
    Estimate,
    /// Output-error estimation, and then all derivative techniques compared on the same problem: errors, costs,
    /// iterations. The result has a `derivative-study` beside the estimate.
    DerivativeStudy,
    /// Output-error estimation, and then what the model lacks: the residual is traced to effects of the catalogue,
    /// which are added one by one. The result has a `diagnosis`; its estimate is that of the model with the effects.
    Diagnose,
    /// Which terms the equation of an output needs, by stepwise regression or orthogonal functions, over the terms in
    /// `structure`; and then the estimation of their parameters. The result has a `structure`; its model has the equation.
    Structure,
}

impl JobKind {
    /// All kinds, in the order of the help.
    pub const ALL: [Self; 4] = [
        Self::Estimate,
        Self::Diagnose,
        Self::Structure,
        Self::DerivativeStudy,
    ];

    /// As it is written in a job.
    pub fn name(self) -> &'static str {
        match self {
            Self::Estimate => "estimate",
            Self::DerivativeStudy => "derivative_study",
            Self::Diagnose => "diagnose",
            Self::Structure => "structure",
        }
    }
}

/// A model by name or id, or written out.
#[derive(Clone, PartialEq, Debug, Serialize, ToSchema)]
#[serde(untagged)]
pub enum ModelSource {
    /// A catalog name such as `short-period`, or the id of a stored model.
    Reference(String),
    /// A model document.
    Document(Box<ModelDocument>),
}

impl<'de> Deserialize<'de> for ModelSource {
    /// By hand: serde's own way with untagged enums would answer a fault anywhere in a document with
    /// "did not match any variant", without its place.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameOrDocument;

        impl<'de> Visitor<'de> for NameOrDocument {
            type Value = ModelSource;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "the name or id of a model, or a model document")
            }

            fn visit_str<E: de::Error>(self, name: &str) -> Result<ModelSource, E> {
                Ok(ModelSource::Reference(name.to_string()))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ModelSource, A::Error> {
                let document = ModelDocument::deserialize(MapAccessDeserializer::new(map))?;
                Ok(ModelSource::Document(Box::new(document)))
            }
        }

        deserializer.deserialize_any(NameOrDocument)
    }
}

impl ModelSource {
    /// The name by which it goes.
    pub fn name(&self) -> &str {
        match self {
            Self::Reference(name) => name,
            Self::Document(document) => &document.name,
        }
    }

    /// The name or id that finds it again; nothing finds a model that only the job holds.
    pub fn reference(&self) -> Option<&str> {
        match self {
            Self::Reference(name) => Some(name),
            Self::Document(_) => None,
        }
    }
}

/// One recording and the part of it to use.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ManeuverUse {
    /// The SHA-256 under which it was uploaded.
    #[schema(example = "3f0a1c0f6f5a7a0e8f3a0f0c8f7a1b2c3d4e5f60718293a4b5c6d7e8f9a0b1c2")]
    pub id: String,
    /// What its segments are called in tables; absent: its number in the job.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "elevator")]
    pub label: Option<String>,
    /// First and last row to use, 1-based, both included; absent: all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = json!([1, 751]))]
    pub rows: Option<[usize; 2]>,
    /// First and last second to use, on the recording's own time, both included; absent: all. Not together with `rows`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = json!([2.0, 32.5]))]
    pub seconds: Option<[f64; 2]>,
    /// Whether the model is fitted to it, or predicts it.
    #[serde(default)]
    pub role: Role,
    /// What to do where the recording has gaps.
    #[serde(default)]
    pub gaps: Gaps,
    /// What was flown, where constants refer to it. Absent: as it is said of the recording when the job is submitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flown: Option<Flown>,
    /// Values of the model's constants that hold for this maneuver alone (mass, centre of gravity, speed), each in the
    /// constant's own unit, or as `recording.mass`.
    #[serde(
        default,
        deserialize_with = "crate::model::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    #[schema(example = json!({"m": 17100.0}))]
    pub constants: IndexMap<String, ConstantValue>,
    /// How model inputs and outputs are made from the channels of this maneuver, where not as the job says.
    #[serde(
        default,
        deserialize_with = "crate::model::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    #[schema(example = json!({"da": "-da"}))]
    pub channels: IndexMap<String, String>,
    /// Start values of this maneuver's own parameters (those that are `per = "maneuver"` in the model).
    #[serde(
        default,
        deserialize_with = "crate::model::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    #[schema(example = json!({"alpha_0": "first(alpha)"}))]
    pub start: IndexMap<String, Start>,
}

impl ManeuverUse {
    /// Whether the model is fitted to it, not held against it.
    pub fn is_fitted(&self) -> bool {
        self.role == Role::Estimation
    }

    /// All of a recording, gaps splitting it.
    pub fn new(id: impl Into<String>, role: Role) -> Self {
        Self {
            id: id.into(),
            label: None,
            rows: None,
            seconds: None,
            role,
            gaps: Gaps::default(),
            flown: None,
            constants: IndexMap::new(),
            channels: IndexMap::new(),
            start: IndexMap::new(),
        }
    }
}

/// What becomes of a gap, a place where the recording stopped and started again.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Gaps {
    /// `through` where a gap is short against the motion (a sixth of the shortest period in the outputs), else `split`.
    #[default]
    Auto,
    /// The model is integrated on: inputs straight between the rows at both sides, outputs without values.
    Through,
    /// Each part is a segment of its own. One that begins in mid-motion has an initial state that is estimated.
    Split,
    /// Gaps are closed up: one continuous time history at the usual step.
    Join,
}

impl Gaps {
    /// All of them, in the order of the help.
    pub const ALL: [Self; 4] = [Self::Auto, Self::Through, Self::Split, Self::Join];

    /// As it is written in a job.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Through => "through",
            Self::Split => "split",
            Self::Join => "join",
        }
    }
}

/// What a job says of a parameter instead of the document; absent: as the document has it.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ParameterOverride {
    /// The start value, in the parameter's unit, or how it is read off the data.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<Start>,
    /// The lower bound, in the parameter's unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower: Option<f64>,
    /// The upper bound, in the parameter's unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper: Option<f64>,
    /// Whether it is held at its start value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fixed: Option<bool>,
    /// What is known of it before the data.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prior: Option<Prior>,
}
