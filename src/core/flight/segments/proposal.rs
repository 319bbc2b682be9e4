//! What is proposed.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Segments that a recording may be cut into.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Proposal {
    /// The inputs that were watched.
    #[schema(example = json!(["de"]))]
    pub inputs: Vec<String>,
    /// In the order of their times.
    pub segments: Vec<ProposedSegment>,
}

/// A part of a recording, as a job may use it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ProposedSegment {
    /// Which input moves, or what else it is, and its number.
    #[schema(example = "elevator 1")]
    pub name: String,
    /// What is flown in it.
    pub kind: SegmentKind,
    /// First and last second, on the recording's own time: `seconds` of a maneuver in a job.
    #[schema(example = json!([4.0, 17.5]))]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub seconds: [f64; 2],
    /// First and last row, from 1: `rows` of a maneuver in a job.
    #[schema(example = json!([101, 438]))]
    pub rows: [usize; 2],
    /// How far each input moves in it, the farthest first; those that do not are left out.
    pub moves: Vec<Moved>,
}

/// What is flown in a segment.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum SegmentKind {
    /// Inputs move, and the aircraft responds.
    Maneuver,
    /// An input wanders, too slowly for the aircraft to leave equilibrium.
    QuasiSteady,
    /// Nothing moves.
    Trim,
}

/// An input and how far it moves.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Moved {
    /// The input's channel.
    #[schema(example = "de")]
    pub channel: String,
    /// From its least value to its greatest, SI.
    #[schema(example = 0.07)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub excursion: f64,
}
