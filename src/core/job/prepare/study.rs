//! What a derivative study asks for beyond an estimation.

use super::bounds::JOB_TOO_LARGE;
use crate::estimate::study;
use crate::estimate::{Derivatives, Problem};
use crate::flight::Fault;

/// A study simulates very often: only what simulates fast is let in.
pub(super) fn check(problem: &Problem) -> Result<(), Vec<Fault>> {
    let central = Derivatives::CentralDifference { step: 1e-6 };
    let operations = study::operations(problem, &central);
    if operations <= study::MOST_OPERATIONS {
        return Ok(());
    }
    let message = format!(
        "a gradient by central differences takes {operations:e} operations here, at most {:e} are allowed for a study; choose \"rows\", or fix parameters",
        study::MOST_OPERATIONS
    );
    Err(vec![Fault::new("/kind", JOB_TOO_LARGE, message)])
}
