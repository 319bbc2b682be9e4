//! The worth of an estimate: error bounds, the colour of residuals, identifiability, modes, the fit of each output. θ is
//! read, never moved.

pub(super) mod absorbed;
pub(super) mod autoregression;
pub(super) mod coloured_residuals;
pub(super) mod covariance;
pub(super) mod error_bounds;
pub(super) mod finer_steps;
pub(super) mod fit;
pub(super) mod halved_steps;
pub(super) mod identifiability;
mod mode_name;
pub(super) mod modes;
pub(super) mod prior_shares;
pub(super) mod state_matrix;
