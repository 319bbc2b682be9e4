//! Which parameters to differentiate by, sorted so that rows of ∂y/∂θ have no structural zeros.

use crate::model::{Jacobian, Model};

/// Parameters that enter the state equations or the initial state come first: every output that sees a
/// state sees all of them. Each output adds the parameters that enter its own equation only.
#[derive(Clone, PartialEq, Debug)]
pub struct Columns {
    /// Parameters behind the sensitivities of the states.
    pub(super) dynamic: Vec<usize>,
    /// By output: the parameters of its row, the dynamic ones first where it sees the states.
    rows: Vec<Vec<usize>>,
}

impl Columns {
    /// For the parameters `free` of a model.
    pub fn new(model: &Model, free: &[usize]) -> Self {
        let enters = |jacobian: &Jacobian, p: usize| {
            jacobian.by_parameter.iter().any(|&(_, column)| column == p)
        };
        let (dynamic, other): (Vec<usize>, Vec<usize>) = (free.iter().copied()).partition(|&p| {
            enters(&model.dynamics_jacobian, p) || enters(&model.initial_jacobian, p)
        });
        let observation = &model.observation_jacobian;
        let row = |output: usize| -> Vec<usize> {
            let own = |p: &&usize| {
                observation.by_parameter.contains(&(output, **p))
                    || model.paths.output_depends_on(output, **p)
            };
            let sees_states = observation.by_state.iter().any(|&(row, _)| row == output);
            if sees_states {
                dynamic
                    .iter()
                    .chain(other.iter().filter(own))
                    .copied()
                    .collect()
            } else {
                // a dynamic parameter may also stand in an output that sees no state
                dynamic.iter().chain(&other).filter(own).copied().collect()
            }
        };
        let rows = (0..model.outputs.len()).map(row).collect();
        Self { dynamic, rows }
    }

    /// The parameters of the model that the columns of ∂y/∂θ of `output` belong to.
    pub fn of_output(&self, output: usize) -> &[usize] {
        &self.rows[output]
    }

    pub(super) fn outputs(&self) -> usize {
        self.rows.len()
    }
}
