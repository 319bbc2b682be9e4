//! The progress of an estimation, and who is told of it.

use std::ops::ControlFlow;

use super::iteration::Iteration;
use super::start::StartReport;
use super::study_step::StudyStep;

/// News of an estimation under way.
#[derive(Clone, Copy, Debug)]
pub enum Progress<'a> {
    /// The search for start values.
    Start(&'a StartReport),
    /// An iteration of the estimator.
    Iteration(&'a Iteration),
    /// Confidence intervals got on.
    Step(&'a StudyStep),
}

/// Told of all progress; may stop the estimation.
pub type Watcher<'o> = dyn FnMut(Progress<'_>) -> ControlFlow<()> + 'o;

/// Told of each iteration; may stop the solver.
pub type Observer<'o> = dyn FnMut(&Iteration) -> ControlFlow<()> + 'o;

/// For iterations that nobody follows.
pub(crate) fn unobserved(_: &Iteration) -> ControlFlow<()> {
    ControlFlow::Continue(())
}
