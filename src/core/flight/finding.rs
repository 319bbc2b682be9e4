//! A finding about recorded data: what is odd, where, and what can be done about it.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// How much a finding matters.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// Changes results unless something is done.
    Warning,
}

/// Something odd about recorded data, which does not prevent their use.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Finding {
    /// A stable word: `gap`, `uneven_sampling`, `missing_values`, `repeated_values`, `repeated_rows`, `spikes`, `wrap`,
    /// `constant`, `implausible`.
    #[schema(example = "gap")]
    pub code: String,
    /// Whether it changes results.
    pub severity: Severity,
    /// The channel concerned; absent where it is the time axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = "alpha")]
    pub channel: Option<String>,
    /// Rows concerned, 1-based, at most the first 20.
    #[schema(example = json!([752]))]
    pub rows: Vec<usize>,
    /// How many rows are concerned in all.
    #[schema(example = 1)]
    pub count: usize,
    /// What was found.
    #[schema(example = "30.08 s between rows 751 and 752, where samples are 0.04 s apart")]
    pub message: String,
    /// What can be done about it.
    #[schema(
        example = "a job treats the parts as separate segments; say \"gaps\": \"join\" to run them as one"
    )]
    pub remedy: String,
}

impl Finding {
    /// The most rows that [`Self::rows`] lists.
    pub const ROWS_LISTED: usize = 20;
}
