//! R, cost, gradient and information matrix from sums over the data; the data themselves are not looked at.

pub(super) mod constants;
pub(super) mod priors;
pub(super) mod sums;
pub(super) mod weighting;
