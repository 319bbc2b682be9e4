//! The answer of an estimation, and the news on its way: types alone, in the parameters' own units. Nothing is computed
//! here.

pub(super) mod collinear;
pub(super) mod estimate;
pub(super) mod filter;
pub(super) mod fit;
pub(super) mod frequency;
pub(super) mod history;
pub(super) mod identifiability;
pub(super) mod integration;
pub(super) mod intervals;
pub(super) mod iteration;
pub(super) mod mode;
pub(super) mod parameter;
pub(super) mod prediction;
pub(super) mod progress;
pub(super) mod start;
pub(super) mod study_step;
