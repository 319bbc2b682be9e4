//! One edit as it is written: kind, target, term.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::error::EditError;
use crate::model::document::Input;
use crate::model::expression::{LONGEST, LONGEST_NAME};

/// Longest target, in bytes: the names of some outputs.
const LONGEST_TARGET: usize = 1024;

/// One edit. `kind` and `target` are the words of the effect catalogue.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Edit {
    /// What is changed, and how.
    pub kind: EditKind,
    /// A fixed parameter for `fixed_parameter`, an output for `sensor_*` (or an input that is measured, as the
    /// accelerometers of a reconstruction), an input for `input_*`, `actuator_*` and `backlash`, a state or definition (its equation) for the others. Several
    /// joined by `+` for `sensor_delay`, `stall_hysteresis` and `swapped_channels` (two outputs); `all` for the `missing_term` `qbar`.
    #[schema(example = "q")]
    pub target: String,
    /// What else the kind needs: the term of a `missing_term` (`alpha^2`, `de*abs(de)`, `alphadot`, `qbar`), the arm of a
    /// `sensor_position` (`x`, `y`, `z`), what else a `sensor_cross_axis` sees (`p`), the channel of an `unrecorded_input` (`dt` or `dt[rad]`), the angle of
    /// `unsteady_aero` and `stall_hysteresis` (`alpha`), the course of a `wind` (`constant`, `ramp`, `shear`), the label
    /// of the maneuver that meets a `gust` (absent: each meets one), the input that drives a `structural_mode`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "alpha^2")]
    pub term: Option<String>,
    /// Name of the (first) parameter that is added; absent: made from kind and target.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "Maa")]
    pub parameter: Option<String>,
    /// The unit of the channel of an `unrecorded_input`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "rad")]
    pub unit: Option<String>,
    /// Recorded channels that a `missing_term` may name though the model does not use them, and from which other effects
    /// take a speed or a rotational acceleration that the model does not have: as the model's inputs would be written.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schema(example = json!({"TAS": {"unit": "m/s", "quantity": "airspeed"}}))]
    pub channels: IndexMap<String, Input>,
    /// Names in a `missing_term` that are taken as differences, and from what: a number in the unit of the name, or an
    /// expression in parameters and constants.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schema(example = json!({"alpha": "alpha_eq"}))]
    pub about: IndexMap<String, Reference>,
}

/// From what a difference is taken.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub enum Reference {
    /// A number, in the unit of the name.
    Value(f64),
    /// An expression in parameters and constants.
    Expression(String),
}

/// The effects that equations express; y is an output, u an input, x a state, ψ a parameter that is added.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum EditKind {
    /// A parameter that the document holds fixed becomes free
    FixedParameter,
    /// y + b
    SensorBias,
    /// (1 + k) y
    SensorScale,
    /// y + d t, t from the start of the segment
    SensorDrift,
    /// y(t - τ)
    SensorDelay,
    /// T ẏ_m = y - y_m, y_m what is recorded
    SensorLag,
    /// y + k z, z what another sensor measures: the axes of an instrument are not those of the aircraft
    SensorCrossAxis,
    /// y1 + s (y2 - y1), y2 + s (y1 - y2): with s = 1 two channels have each other's name
    SwappedChannels,
    /// The lever arm of a vane or an accelerometer: α - x q/V + y p/V, β + x r/V - z p/V, a + ω̇ × r + ω × (ω × r)
    SensorPosition,
    /// u + b
    InputBias,
    /// (1 + k) u
    InputScale,
    /// u(t - τ)
    InputDelay,
    /// T δ̇ = u - δ
    ActuatorLag,
    /// δ goes to u, but abs(δ̇) ≤ r
    ActuatorRateLimit,
    /// δ stays where it is, but u - b ≤ δ ≤ u + b
    Backlash,
    /// ψ u2, a recorded channel that the model does not use
    UnrecordedInput,
    /// ψ term, added to an equation
    MissingTerm,
    /// ψ (α - w), T ẇ = α - w
    UnsteadyAero,
    /// τ1 Ẋ + X = ½ (1 - tanh a1 (α - τ2 α̇ - α*)), lift by ((1 + √X)/2)² α, moment + C (1 - X)
    StallHysteresis,
    /// α + A/2 (1 - cos 2π (t - t0)/L)
    Gust,
    /// W + c, W + d t or W + s (h - h0)
    Wind,
    /// x0 + dx0
    InitialState,
    /// y + η, η̈ = -ω² η - 2 ζ ω η̇ + ω² k (u - u0)
    StructuralMode,
}

impl EditKind {
    /// All of them, in the order of the catalogue.
    pub const ALL: [Self; 23] = [
        Self::FixedParameter,
        Self::SensorBias,
        Self::SensorScale,
        Self::SensorDrift,
        Self::SensorDelay,
        Self::SensorLag,
        Self::SensorCrossAxis,
        Self::SwappedChannels,
        Self::SensorPosition,
        Self::InputBias,
        Self::InputScale,
        Self::InputDelay,
        Self::ActuatorLag,
        Self::ActuatorRateLimit,
        Self::Backlash,
        Self::UnrecordedInput,
        Self::MissingTerm,
        Self::UnsteadyAero,
        Self::StallHysteresis,
        Self::Gust,
        Self::Wind,
        Self::InitialState,
        Self::StructuralMode,
    ];

    /// The word of the catalogue.
    pub fn name(self) -> &'static str {
        match self {
            Self::FixedParameter => "fixed_parameter",
            Self::SensorBias => "sensor_bias",
            Self::SensorScale => "sensor_scale",
            Self::SensorDrift => "sensor_drift",
            Self::SensorDelay => "sensor_delay",
            Self::SensorLag => "sensor_lag",
            Self::SensorCrossAxis => "sensor_cross_axis",
            Self::SwappedChannels => "swapped_channels",
            Self::SensorPosition => "sensor_position",
            Self::InputBias => "input_bias",
            Self::InputScale => "input_scale",
            Self::InputDelay => "input_delay",
            Self::ActuatorLag => "actuator_lag",
            Self::ActuatorRateLimit => "actuator_rate_limit",
            Self::Backlash => "backlash",
            Self::UnrecordedInput => "unrecorded_input",
            Self::MissingTerm => "missing_term",
            Self::UnsteadyAero => "unsteady_aero",
            Self::StallHysteresis => "stall_hysteresis",
            Self::Gust => "gust",
            Self::Wind => "wind",
            Self::InitialState => "initial_state",
            Self::StructuralMode => "structural_mode",
        }
    }

    /// The kind of this name.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

impl Edit {
    /// An edit of a kind and a target; parameters have their usual names.
    pub fn new(kind: EditKind, target: impl Into<String>) -> Self {
        Self {
            kind,
            target: target.into(),
            term: None,
            parameter: None,
            unit: None,
            channels: IndexMap::new(),
            about: IndexMap::new(),
        }
    }

    /// The same edit with a term.
    #[must_use]
    pub fn with_term(self, term: impl Into<String>) -> Self {
        Self {
            term: Some(term.into()),
            ..self
        }
    }

    /// What is written here comes back many times in the document.
    pub(super) fn check_lengths(&self) -> Result<(), EditError> {
        let term = self.term.as_deref().unwrap_or_default();
        let parameter = self.parameter.as_deref().unwrap_or_default();
        let unit = self.unit.as_deref().unwrap_or_default();
        let bounds = [
            ("target", self.target.as_str(), LONGEST_TARGET),
            ("term", term, LONGEST),
            ("parameter", parameter, LONGEST_NAME),
            ("unit", unit, LONGEST_NAME),
        ];
        let channels = (self.channels.keys()).map(|name| ("channels", name.as_str(), LONGEST_NAME));
        let about = (self.about.iter()).flat_map(|(name, from)| {
            let from = match from {
                Reference::Value(_) => "",
                Reference::Expression(text) => text,
            };
            [
                ("about", name.as_str(), LONGEST_NAME),
                ("about", from, LONGEST),
            ]
        });
        let mut bounds = bounds.into_iter().chain(channels).chain(about);
        match bounds.find(|(_, text, most)| text.len() > *most) {
            None => Ok(()),
            Some((field, text, most)) => Err(EditError::TooLong {
                field,
                length: text.len(),
                most,
            }),
        }
    }

    /// The term, or that it is needed.
    pub(super) fn needed_term(&self, wanted: &'static str) -> Result<&str, EditError> {
        self.term.as_deref().ok_or(EditError::NoTerm {
            kind: self.kind.name(),
            wanted,
        })
    }

    pub(super) fn bad_term(&self, message: impl Into<String>) -> EditError {
        EditError::BadTerm {
            term: self.term.clone().unwrap_or_default(),
            message: message.into(),
        }
    }
}
