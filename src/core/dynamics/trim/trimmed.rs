//! A trim before it is told: where the search ended, and how that moves with the parameters.

use nalgebra::{DMatrix, DVector};

use super::conditions::Conditions;
use super::equations::Equations;
use super::solver::{Solution, pseudo_inverse, solve};
use super::spec::TrimSpec;
use crate::flight::{Fault, Faults};
use crate::model::Model;

/// A trim that was found, or the nearest to one.
pub(super) struct Trimmed<'m> {
    pub model: &'m Model,
    pub equations: Equations,
    pub conditions: Conditions,
    parameters: Vec<f64>,
    pub solution: Solution,
}

impl<'m> Trimmed<'m> {
    pub(super) fn find(
        model: &'m Model,
        parameters: &[f64],
        spec: &TrimSpec,
    ) -> Result<Self, Faults> {
        let equations = Equations::of(model)?;
        let conditions = Conditions::of(spec, model, &equations, parameters)?;
        let solution = solve(&equations, &conditions, parameters);
        if !solution.residual.iter().all(|r| r.is_finite()) {
            let message = "the equations give no numbers where the search begins: say there \"start\" values of states, such as the velocity";
            return Err(vec![Fault::new("/start", "no_start", message)].into());
        }
        Ok(Self {
            model,
            equations,
            conditions,
            parameters: parameters.to_vec(),
            solution,
        })
    }

    /// By state, input and quantity, then parameter: how a trim moves with it; none where it was not reached.
    pub(super) fn slopes(&self) -> Option<DMatrix<f64>> {
        if !self.solution.is_reached {
            return None;
        }
        let at = self.equations.at(&self.solution.z, &self.parameters);
        let wanted = self.conditions.rows(&at);
        let free: Vec<usize> = self.solution.free();
        let jacobian = wanted.by_unknown.select_columns(&free);
        let inverse = pseudo_inverse(&jacobian)?;
        let moved = -(inverse * &wanted.by_parameter);
        let mut of_unknowns = DMatrix::zeros(self.solution.z.len(), self.parameters.len());
        for (row, &unknown) in free.iter().enumerate() {
            of_unknowns.set_row(unknown, &moved.row(row));
        }
        let of_quantities = &at.quantities.by_unknown * &of_unknowns + &at.quantities.by_parameter;
        let mut all = DMatrix::zeros(
            of_unknowns.nrows() + of_quantities.nrows(),
            self.parameters.len(),
        );
        all.rows_mut(0, of_unknowns.nrows()).copy_from(&of_unknowns);
        all.rows_mut(of_unknowns.nrows(), of_quantities.nrows())
            .copy_from(&of_quantities);
        Some(all)
    }

    /// Values of states, inputs, then quantities.
    pub(super) fn values(&self) -> DVector<f64> {
        let at = self.equations.at(&self.solution.z, &self.parameters);
        let all = (self.solution.z.iter()).chain(&at.quantities.values);
        DVector::from_iterator(
            self.solution.z.len() + at.quantities.values.len(),
            all.copied(),
        )
    }
}
