//! One look at the data for a θ: residuals, rows of ∂y/∂θ and the sums of both. The numbers do not depend on how many
//! threads look.

pub mod derivatives;
pub(super) mod evaluate;
pub(super) mod evaluator;
pub(super) mod linearised;
mod local_sums;
mod missing;
pub(super) mod normal_equations;
mod strand;
