//! What a diagnosis answers of a force that the model does not have.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::estimate::Role;

/// What an equation with an unmodelled force gives, and so what the force is.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum ForceIn {
    /// The derivative of a state: an acceleration.
    State,
    /// A named coefficient: an increment of it.
    Coefficient,
    /// An output: an error of the instrument, or of the equation that says what it measures.
    Output,
}

/// Which model leaves a residual.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum LeftBy {
    /// The model with all effects that were named in it.
    #[default]
    WithEffects,
    /// The declared model: the force explains as much as the effects that were named, whose names are in doubt.
    Declared,
}

/// What is left of the residual as a force in one equation: an acceleration, the increment of a coefficient or an error
/// of an output. All numbers are SI.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Unmodelled {
    /// Which model leaves it.
    #[serde(default)]
    pub left_by: LeftBy,
    /// The state, definition or output in whose equation the force explains the residual best.
    #[schema(example = "q")]
    pub equation: String,
    /// What that equation gives.
    pub force_in: ForceIn,
    /// Of the force.
    #[schema(example = "rad/s^2")]
    pub unit: String,
    /// Twice the gain of the marginal log-likelihood over noise alone, each with the colour that suits it.
    #[schema(example = 143.2)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub likelihood_ratio: f64,
    /// What white noise alone exceeds once in a thousand diagnoses. Beyond 40 no noise that is usual in flight does, coloured or
    /// not; in between it is shown where something is missing for another reason, and says nothing by itself.
    #[schema(example = 16.6)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub threshold: f64,
    /// Independent numbers that the force is worth.
    #[schema(example = 41.0)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub freedom: f64,
    /// The other equations, the best first.
    pub elsewhere: Vec<ForceElsewhere>,
    /// Root mean square, over the flights that were fitted.
    #[schema(example = 0.031)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub rms: f64,
    /// Largest size in those.
    #[schema(example = 0.12)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub largest: f64,
    /// The force over time.
    pub flights: Vec<ForceHistory>,
    /// What it depends on, the largest share first.
    pub depends_on: Vec<ForceDependence>,
    /// Terms that would make such a force, as effects are named.
    #[schema(example = json!(["missing_term alpha^3 in q"]))]
    pub proposals: Vec<String>,
    /// Of the flights that were fitted.
    pub spectrum: ForceSpectrum,
    /// The shortest time that holds half of a flight's energy of the force, in the flight where it is strongest.
    pub strongest: ForceInterval,
    /// All that in words, and what would decide.
    pub sentence: String,
}

/// A likelihood ratio that no usual noise makes: slow noise of an instrument comes to 20 and more.
const CLEARLY: f64 = 40.0;

impl Unmodelled {
    /// Whether it says by itself that something is missing.
    pub(in crate::diagnose) fn is_clear(&self) -> bool {
        self.likelihood_ratio > self.threshold.max(CLEARLY)
    }
}

/// How well a force in another equation explains the residual.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ForceElsewhere {
    /// A state, definition or output.
    #[schema(example = "alpha")]
    pub equation: String,
    /// What that equation gives.
    pub force_in: ForceIn,
    /// As of [`Unmodelled`].
    #[schema(example = 96.1)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub likelihood_ratio: f64,
    /// As of [`Unmodelled`].
    #[schema(example = 38.0)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub freedom: f64,
}

/// A force along one flight, with a band of 95 %. What the declared model imitates is not known: there the band is wide. In a
/// flight that was not fitted the parameters are taken as the fit has them, and the band is that of noise alone.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ForceHistory {
    /// The flight's label.
    #[schema(example = "doublet")]
    pub segment: String,
    /// Whether it was fitted, or held out to validate the fit.
    pub role: Role,
    /// Recorded time, s; at most 300 samples.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub time: Vec<f64>,
    /// The force at those times.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub value: Vec<f64>,
    /// The band's lower edge.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub lower: Vec<f64>,
    /// The band's upper edge.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub upper: Vec<f64>,
}

/// How a force depends on one quantity.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ForceDependence {
    /// A state, input, definition or recorded channel, the rate of a state (`alphadot`), or a product of two, each about its
    /// mean.
    #[schema(example = "alpha")]
    pub quantity: String,
    /// Of the quantity, SI.
    #[schema(example = "rad")]
    pub unit: String,
    /// Of what the force does to the outputs, in flights (or parts of one) that the curve was not fitted to: 1 all of it, 0
    /// nothing, negative where the curve misleads.
    #[schema(example = 0.71)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub share: f64,
    /// The force over the quantity, with a band of 95 %, without what the declared parameters imitate of it (a straight line,
    /// where they have one). Of the best few alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<ForceCurve>,
}

/// A smooth curve with a band of 95 %.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
pub struct ForceCurve {
    /// Values of the quantity.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub x: Vec<f64>,
    /// The force there.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub y: Vec<f64>,
    /// The band's lower edge.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub lower: Vec<f64>,
    /// The band's upper edge.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub upper: Vec<f64>,
}

/// Where the power of a force lies, Hz.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
pub struct ForceSpectrum {
    /// Where the density is largest.
    #[schema(example = 0.45)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub peak: f64,
    /// A tenth of the power lies below.
    #[schema(example = 0.2)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub lower: f64,
    /// A tenth of the power lies above.
    #[schema(example = 1.1)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub upper: f64,
}

/// A part of a flight.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
pub struct ForceInterval {
    /// The flight's label.
    #[schema(example = "doublet")]
    pub segment: String,
    /// Recorded time, s.
    #[schema(example = 12.3)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub from: f64,
    /// Recorded time, s.
    #[schema(example = 14.1)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub to: f64,
}
