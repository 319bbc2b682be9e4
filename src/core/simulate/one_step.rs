//! One integration step of a model that is affine in states and inputs, as a constant matrix:
//! x(k+1) = M z(k) with z(k) = (x(k), u(k), u(k+1), 1).
//!
//! With K_s the matrix of stage s, K_s = A Y_s + (0, (1 - σ_s) B, σ_s B, c), where Y_s = E + h a_s K_(s-1), E
//! picks x out of z and σ_s is the share of the later input; M = E + h Σ w_s K_s. The derivative by a
//! parameter follows by the product rule.

use super::method::{InputInterpolation, Stage};
use crate::model::{Affine, Coefficient, Factor, Model, Workspace};

/// Models with more states are left to the general way, which makes use of zeros.
pub(super) const MOST_STATES: usize = 6;
/// And those whose z is longer than this.
const MOST_FACTORS: usize = 32;

type Term = (Coefficient, f64);

/// The matrix M for one θ and one length of step.
pub(super) struct OneStep<'m> {
    affine: &'m Affine,
    workspace: Workspace<f64>,
    states: usize,
    inputs: usize,
    /// M, row by row.
    matrix: Vec<f64>,
    /// Y_s, stage by stage.
    at: Vec<Vec<f64>>,
    /// The coefficients of A, B and c.
    own: Vec<Term>,
}

impl<'m> OneStep<'m> {
    /// `None` for a model that is not affine, or too large for dense matrices to pay.
    pub(super) fn of(model: &'m Model) -> Option<Self> {
        let (states, inputs) = (model.states.len(), model.driven_inputs());
        let pays = (1..=MOST_STATES).contains(&states) && states + 2 * inputs < MOST_FACTORS;
        let affine = model.affine_dynamics.as_ref().filter(|_| pays)?;
        Some(Self {
            affine,
            workspace: affine.program.workspace(),
            states,
            inputs,
            matrix: Vec::new(),
            at: Vec::new(),
            own: Vec::new(),
        })
    }

    /// The length of z.
    pub(super) fn factors(&self) -> usize {
        self.states + 2 * self.inputs + 1
    }

    /// M, row by row.
    pub(super) fn matrix(&self) -> &[f64] {
        &self.matrix
    }

    /// Works out M for θ and the step `h`.
    pub(super) fn set(
        &mut self,
        parameters: &[f64],
        h: f64,
        stages: &[Stage],
        interpolation: InputInterpolation,
    ) {
        self.affine
            .program
            .set_parameters(&mut self.workspace, parameters);
        self.own = self.terms(None);
        let unit = self.unit();
        self.matrix.clone_from(&unit);
        self.at.clear();
        let mut slope = vec![0.0; unit.len()];
        for stage in stages {
            let mut at = unit.clone();
            add(h * stage.advance, &slope, &mut at);
            slope.fill(0.0);
            let share = interpolation.share_of_next(stage.node);
            self.apply(&self.own, share, &at, &mut slope);
            add(h * stage.weight, &slope, &mut self.matrix);
            self.at.push(at);
        }
    }

    /// ∂M/∂θ_p, row by row, for the θ and the step that are set.
    pub(super) fn derivative(
        &self,
        parameter: usize,
        h: f64,
        stages: &[Stage],
        interpolation: InputInterpolation,
    ) -> Vec<f64> {
        let terms = self.terms(Some(parameter));
        let size = self.states * self.factors();
        let (mut slope, mut sum) = (vec![0.0; size], vec![0.0; size]);
        for (stage, at) in stages.iter().zip(&self.at) {
            let mut change = vec![0.0; size];
            add(h * stage.advance, &slope, &mut change);
            slope.fill(0.0);
            let share = interpolation.share_of_next(stage.node);
            self.apply(&terms, share, at, &mut slope);
            self.apply_states(&change, &mut slope);
            add(h * stage.weight, &slope, &mut sum);
        }
        sum
    }

    fn terms(&self, parameter: Option<usize>) -> Vec<Term> {
        let entries = self.affine.entries.iter().enumerate();
        entries
            .filter(|(_, entry)| entry.parameter == parameter)
            .map(|(i, &entry)| (entry, self.affine.program.result(&self.workspace, i)))
            .collect()
    }

    /// E, row by row.
    fn unit(&self) -> Vec<f64> {
        let factors = self.factors();
        let mut unit = vec![0.0; self.states * factors];
        unit.iter_mut()
            .step_by(factors + 1)
            .for_each(|one| *one = 1.0);
        unit
    }

    /// to += A at + (0, (1 - share) B, share B, c), for the A, B and c that `terms` tell of.
    fn apply(&self, terms: &[Term], share: f64, at: &[f64], to: &mut [f64]) {
        let factors = self.factors();
        for &(Coefficient { row, factor, .. }, value) in terms {
            let row = &mut to[row * factors..(row + 1) * factors];
            match factor {
                Factor::State(i) => add(value, &at[i * factors..(i + 1) * factors], row),
                Factor::Input(i) => {
                    row[self.states + i] += value * (1.0 - share);
                    row[self.states + self.inputs + i] += value * share;
                }
                Factor::One => row[factors - 1] += value,
            }
        }
    }

    /// to += A at
    fn apply_states(&self, at: &[f64], to: &mut [f64]) {
        let factors = self.factors();
        for &(Coefficient { row, factor, .. }, value) in &self.own {
            if let Factor::State(i) = factor {
                let row = &mut to[row * factors..(row + 1) * factors];
                add(value, &at[i * factors..(i + 1) * factors], row);
            }
        }
    }
}

/// to += share * from
fn add(share: f64, from: &[f64], to: &mut [f64]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to += share * from;
    }
}
