//! The equations linearised at the start of a segment: x0(θ), the first sample of the inputs, t = 0.

use num_complex::Complex64;

use crate::model::{Jacobian, Model, Scalar};
use crate::simulate::{Segment, initial_state};

/// Beside numbers near one this loses nothing, and its square is zero.
const COMPLEX_STEP: f64 = 1e-40;

/// The entries of some Jacobians by the states, each in its own order, for any kind of number.
pub(crate) fn at_start<T: Scalar, const N: usize>(
    model: &Model,
    jacobians: [&Jacobian; N],
    segment: &Segment,
    parameters: &[T],
) -> [Vec<T>; N] {
    let state = initial_state(model, parameters);
    jacobians.map(|jacobian| {
        let program = &jacobian.program;
        let mut workspace = program.workspace();
        program.set_parameters(&mut workspace, parameters);
        program.states(&mut workspace).copy_from_slice(&state);
        for (to, samples) in (program.inputs(&mut workspace).iter_mut()).zip(&segment.inputs) {
            *to = T::from_f64(samples[0]);
        }
        *program.time(&mut workspace) = T::from_f64(0.0);
        program.run(&mut workspace);
        (0..jacobian.by_state.len())
            .map(|entry| program.result(&workspace, entry))
            .collect()
    })
}

/// Their derivatives by one parameter, the initial state's part in it included: by a complex step, exact but for
/// rounding.
pub(crate) fn slopes_at_start<const N: usize>(
    model: &Model,
    jacobians: [&Jacobian; N],
    segment: &Segment,
    parameters: &[f64],
    parameter: usize,
) -> [Vec<f64>; N] {
    let mut parameters: Vec<Complex64> = parameters.iter().map(|&p| p.into()).collect();
    parameters[parameter].im = COMPLEX_STEP;
    let slopes = |entries: Vec<Complex64>| -> Vec<f64> {
        entries
            .iter()
            .map(|entry| entry.im / COMPLEX_STEP)
            .collect()
    };
    at_start(model, jacobians, segment, &parameters).map(slopes)
}
