//! Writing an answer: its form, its caching, and no more rows than are wanted.

pub(super) mod campaign_table;
pub(super) mod comparison_table;
pub(super) mod decimate;
pub(super) mod format;
pub(super) mod prediction_table;
pub(super) mod response_table;
mod series_table;
pub(super) mod trajectory_table;
