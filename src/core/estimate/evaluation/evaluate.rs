//! What a descent asks of the data at a θ, in whatever domain they are compared with the model.

use crate::estimate::likelihood::sums::{ResidualSums, Sums};
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;

/// Looks at the data of a problem for a θ.
pub(crate) trait Evaluate<'p> {
    /// The problem whose data are looked at.
    fn problem(&self) -> &'p Problem;

    /// Residuals alone.
    ///
    /// # Errors
    /// The θ gives no residuals that are numbers.
    fn residuals(&mut self, theta: &[f64]) -> Result<ResidualSums, Unusable>;

    /// Residuals and the sums of their sensitivities.
    ///
    /// # Errors
    /// As [`Self::residuals`].
    fn sums(&mut self, theta: &[f64]) -> Result<Sums, Unusable>;
}
