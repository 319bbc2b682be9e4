//! A job's model with its estimates as source code.

use super::plan::Plan;
use super::trajectories::{NoTrajectory, check_parameters};
use crate::estimate::{Estimate, Estimated};
use crate::model::SourceLanguage;

/// Why there is no source code.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum NoSourceCode {
    /// The job is not what it was.
    #[error("{0}")]
    Estimate(#[from] NoTrajectory),
    /// No segment of this label.
    #[error("segment: there is no '{name}'; there is {known}")]
    Segment {
        /// As it was asked for.
        name: String,
        /// Those there are.
        known: String,
    },
}

/// The functions of the model as it was estimated, with what belongs to a maneuver as it is in the segment of this label, or
/// in the first.
///
/// # Errors
/// The estimate is none of this plan; there is no such segment.
pub fn source_code(
    plan: &Plan,
    estimate: &Estimate,
    segment: Option<&str>,
    language: SourceLanguage,
) -> Result<String, NoSourceCode> {
    check_parameters(plan, estimate)?;
    let problem = &plan.problem;
    let labels = || {
        problem
            .segments
            .iter()
            .map(|segment| segment.label.as_str())
    };
    let index = match segment {
        None => 0,
        Some(name) => {
            labels()
                .position(|label| label == name)
                .ok_or_else(|| NoSourceCode::Segment {
                    name: name.to_string(),
                    known: labels().collect::<Vec<_>>().join(", "),
                })?
        }
    };
    let estimated = Estimated::of(problem, estimate);
    let mut parameters = Vec::new();
    (estimated.unknowns).parameters(index, &estimated.theta, &mut parameters);
    let of = format!(
        "{}, segment {}",
        problem.model.document.name, problem.segments[index].label
    );
    Ok(problem.model.source_code(language, &parameters, &of))
}
