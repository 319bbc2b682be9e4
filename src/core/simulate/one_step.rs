//! From one sample to the next in a model that is affine in states and inputs, as a constant matrix:
//! x(k+1) = M z(k) with z(k) = (x(k), u(k), u(k+1), 1).
//!
//! With K_s the matrix of stage s, K_s = A Y_s + (0, (1 - σ_s) B, σ_s B, c), where Y_s = X + h a_s K_(s-1), X is
//! the matrix of the state before the step and σ_s is the share of the later input; a step makes X + h Σ w_s K_s of it.
//! It begins with E, which picks x out of z, and is M behind the last of the steps that lie between two samples: their
//! number costs nothing along the samples. The derivative by a parameter follows by the product rule.

use super::method::{InputInterpolation, Stage};
use crate::model::{Affine, Coefficient, Factor, Model, Workspace};

/// Models with more states are left to the general way, which makes use of zeros.
pub(super) const MOST_STATES: usize = 6;
/// And those whose z is longer than this.
const MOST_FACTORS: usize = 32;

type Term = (Coefficient, f64);

/// The way from one sample to the next.
#[derive(Clone, Copy)]
pub(super) struct Stride {
    /// s
    pub length: f64,
    /// Integration steps.
    pub count: usize,
    pub stages: &'static [Stage],
    pub interpolation: InputInterpolation,
}

impl Stride {
    fn step(&self) -> f64 {
        self.length / self.count as f64
    }

    /// The share of the later sample at a stage of one of the steps.
    fn share(&self, part: usize, stage: &Stage) -> f64 {
        let node = (part as f64 + stage.node) / self.count as f64;
        self.interpolation.share_of_next(node)
    }
}

/// The matrix M for one θ, one distance of samples and one number of steps between them.
pub(super) struct OneStep<'m> {
    affine: &'m Affine,
    workspace: Workspace<f64>,
    states: usize,
    inputs: usize,
    /// M, row by row.
    matrix: Vec<f64>,
    /// Y_s, step by step and stage by stage.
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

    /// Works out M for θ.
    pub(super) fn set(&mut self, parameters: &[f64], stride: &Stride) {
        self.affine
            .program
            .set_parameters(&mut self.workspace, parameters);
        self.own = self.terms(None);
        self.matrix = self.unit();
        self.at.clear();
        let mut slope = vec![0.0; self.matrix.len()];
        let h = stride.step();
        for part in 0..stride.count {
            let before = self.matrix.clone();
            for stage in stride.stages {
                let mut at = before.clone();
                add(h * stage.advance, &slope, &mut at);
                slope.fill(0.0);
                self.apply(&self.own, stride.share(part, stage), &at, &mut slope);
                add(h * stage.weight, &slope, &mut self.matrix);
                self.at.push(at);
            }
        }
    }

    /// ∂M/∂θ_p, row by row, for the θ that is set and the same stride.
    pub(super) fn derivative(&self, parameter: usize, stride: &Stride) -> Vec<f64> {
        let terms = self.terms(Some(parameter));
        let size = self.states * self.factors();
        let (mut slope, mut sum) = (vec![0.0; size], vec![0.0; size]);
        let h = stride.step();
        let mut at = self.at.iter();
        for part in 0..stride.count {
            let before = sum.clone();
            for (stage, at) in stride.stages.iter().zip(&mut at) {
                let mut change = before.clone();
                add(h * stage.advance, &slope, &mut change);
                slope.fill(0.0);
                self.apply(&terms, stride.share(part, stage), at, &mut slope);
                self.apply_states(&change, &mut slope);
                add(h * stage.weight, &slope, &mut sum);
            }
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
