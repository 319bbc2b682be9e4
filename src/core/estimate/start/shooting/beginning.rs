//! Where a segment begins by the model, against where its first node stands.

use nalgebra::{DMatrix, DVector};

use crate::estimate::problem::Problem;

/// A segment's initial state by the model, less that of its first node, and its derivative by θ.
pub(super) struct Beginning {
    pub jump: DVector<f64>,
    pub slopes: DMatrix<f64>,
}

/// x0(θ) of a segment less its first node, and the derivative. `None` where it is not finite.
pub(super) fn beginning(
    problem: &Problem,
    segment: usize,
    theta: &[f64],
    node: &DVector<f64>,
) -> Option<Beginning> {
    let model = &problem.model;
    let mut parameters = Vec::new();
    problem.unknowns.parameters(segment, theta, &mut parameters);
    let mut workspace = model.initial.workspace();
    model.initial.set_parameters(&mut workspace, &parameters);
    model.initial.run(&mut workspace);
    let initial = DVector::from_fn(node.len(), |i, _| model.initial.result(&workspace, i));
    let jacobian = &model.initial_jacobian;
    let mut workspace = jacobian.program.workspace();
    jacobian.program.set_parameters(&mut workspace, &parameters);
    jacobian.program.run(&mut workspace);
    let mut slopes = DMatrix::zeros(node.len(), theta.len());
    for (i, &(state, parameter)) in jacobian.by_parameter.iter().enumerate() {
        if let Some(place) = problem.unknowns.place(segment, parameter) {
            let entry = jacobian.by_state.len() + i;
            slopes[(state, place)] = jacobian.program.result(&workspace, entry);
        }
    }
    let jump = initial - node;
    let finite = jump.iter().chain(slopes.iter()).all(|v| v.is_finite());
    finite.then_some(Beginning { jump, slopes })
}
