//! Jobs: submitting them, following them, and what they come to.

pub(super) mod bulk;
pub(super) mod coefficients;
pub(super) mod corrected;
pub(crate) mod dynamics;
pub(super) mod events;
pub(super) mod findings;
pub(super) mod histories;
pub(super) mod iterations;
pub(crate) mod job;
pub(crate) mod kept;
pub(super) mod predictions;
pub(super) mod rerun;
pub(super) mod residual_analysis;
pub(crate) mod results;
pub(super) mod simulator_model;
pub(super) mod source_code;
pub(super) mod submit;
pub(super) mod trajectories;
