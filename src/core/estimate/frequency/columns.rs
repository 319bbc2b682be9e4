//! Which unknowns the response of a segment is differentiated by.

use crate::estimate::problem::Problem;

/// The columns of a segment: parameters that are unknown in it, and where they stand in θ.
pub(super) struct Columns {
    /// By parameter: its column.
    pub of: Vec<Option<usize>>,
    /// By column: its place in θ.
    pub places: Vec<usize>,
}

impl Columns {
    pub(super) fn of(problem: &Problem, segment: usize) -> Self {
        let (mut of, mut places) = (Vec::new(), Vec::new());
        for parameter in 0..problem.model.parameters.len() {
            let place = problem.unknowns.place(segment, parameter);
            of.push(place.map(|_| places.len()));
            places.extend(place);
        }
        Self { of, places }
    }
}
