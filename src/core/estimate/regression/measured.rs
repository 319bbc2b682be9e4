//! Which outputs measure a state, and the state as such an output has it.

use crate::model::{Model, expression};
use crate::simulate::Segment;

/// An output whose equation is a state itself, possibly with bias, scale and drift: y = a(θ) x + b(t, θ).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct MeasuredState {
    pub state: usize,
    pub output: usize,
    /// Where ∂y/∂x stands among the results of the observation Jacobian.
    slope: usize,
}

/// The outputs that measure states, at most one for each state, in the order of the states.
///
/// The output has the state's dimension (a rate does not measure an angle), needs no input and no other state, and is
/// linear in it. Where several do, the one with the slope nearest to 1 is taken.
pub(crate) fn measured_states(model: &Model, parameters: &[f64]) -> Vec<MeasuredState> {
    let jacobian = &model.observation_jacobian;
    let mut workspace = jacobian.program.workspace();
    jacobian.program.set_parameters(&mut workspace, parameters);
    jacobian.program.run(&mut workspace);
    let candidate = |output: usize, state: usize| {
        let mut entries = jacobian.by_state.iter().enumerate();
        let (slope, _) = entries.find(|&(_, &entry)| entry == (output, state))?;
        let alone = jacobian
            .by_state
            .iter()
            .filter(|entry| entry.0 == output)
            .count()
            == 1;
        let same = model.outputs[output].unit.dimension == model.states[state].unit.dimension;
        let value = jacobian.program.result(&workspace, slope);
        let usable = alone
            && same
            && !jacobian.program.varies(slope)
            && value.is_finite()
            && value != 0.0
            && is_plain(model, output);
        let found = MeasuredState {
            state,
            output,
            slope,
        };
        usable.then_some((found, (value - 1.0).abs()))
    };
    let best = |state: usize| {
        let all = (0..model.outputs.len()).filter_map(|output| candidate(output, state));
        all.min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(found, _)| found)
    };
    (0..model.states.len()).filter_map(best).collect()
}

/// Whether the equation of an output names nothing but states, parameters, constants and the time.
fn is_plain(model: &Model, output: usize) -> bool {
    let document = &model.document;
    let Some((_, output)) = document.outputs.get_index(output) else {
        return false;
    };
    expression::parse(&output.equation).is_ok_and(|equation| {
        equation.names().iter().all(|&(name, _)| {
            !document.inputs.contains_key(name) && !document.definitions.contains_key(name)
        })
    })
}

impl MeasuredState {
    /// a in y = a x + b, with `parameters` for θ.
    pub(crate) fn slope(&self, model: &Model, parameters: &[f64]) -> f64 {
        let jacobian = &model.observation_jacobian.program;
        let mut slopes = jacobian.workspace();
        jacobian.set_parameters(&mut slopes, parameters);
        jacobian.run(&mut slopes);
        jacobian.result(&slopes, self.slope)
    }

    /// The state at each sample of a segment, (z - b)/a, with bias and scale as `parameters` have them.
    pub(crate) fn read(&self, model: &Model, segment: &Segment, parameters: &[f64]) -> Vec<f64> {
        let slope = self.slope(model, parameters);
        let program = &model.observation;
        let mut workspace = program.workspace();
        program.set_parameters(&mut workspace, parameters);
        let mut elapsed = 0.0;
        let measured = segment.measured[self.output].iter().enumerate();
        let state = measured.map(|(k, z)| {
            // the workspace's states are zero: what is left of the output is b
            *program.time(&mut workspace) = elapsed;
            program.run(&mut workspace);
            if k + 1 < segment.len() {
                elapsed += segment.steps.length(k);
            }
            (z - program.result(&workspace, self.output)) / slope
        });
        state.collect()
    }
}
