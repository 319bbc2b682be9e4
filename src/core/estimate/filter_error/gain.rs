//! The steady Kalman gain of one segment, and how it changes with the unknowns.
//!
//! A P + P Aᵀ - P Cᵀ R⁻¹ C P / Δt + F Fᵀ = 0, K = P Cᵀ R⁻¹: the natural formulation (Maine and Iliff 1981;
//! Jategaonkar 2015, ch. 5), in which R is the covariance of the innovations. A = ∂f/∂x and C = ∂g/∂x are those at the
//! segment's initial state and first inputs; the equation is that of a step Δt that is short against the motion.

use nalgebra::{DMatrix, DVector};

use super::layout::Column;
use super::riccati::SteadyCovariance;
use crate::estimate::evaluation::linearised::{at_start, slopes_at_start};
use crate::model::{Jacobian, Model};
use crate::simulate::Segment;
use crate::stop;

/// The place at which a gain is computed: one segment, all its parameters (SI), the intensities by state, and R⁻¹.
#[derive(Clone, Copy)]
pub(super) struct Setting<'a> {
    pub model: &'a Model,
    pub segment: &'a Segment,
    pub parameters: &'a [f64],
    pub intensities: &'a [f64],
    pub weight: &'a DMatrix<f64>,
}

pub(super) struct Gain {
    /// K, states by outputs.
    pub k: DMatrix<f64>,
    pub a: DMatrix<f64>,
    pub c: DMatrix<f64>,
    /// None where no noise drives any state: the filter then only simulates.
    steady: Option<SteadyCovariance>,
}

/// The derivative of a gain by one unknown.
#[derive(Clone)]
pub(super) struct Change {
    pub k: DMatrix<f64>,
    /// Of the diagonal of K C.
    pub share: DVector<f64>,
}

impl Gain {
    /// `None` where there is no steady gain.
    pub(super) fn steady(setting: &Setting<'_>) -> Option<Self> {
        let (model, segment) = (setting.model, setting.segment);
        let [dynamics, observation] =
            at_start(model, jacobians(model), segment, setting.parameters);
        let (states, outputs) = (model.states.len(), model.outputs.len());
        let a = by_state(&model.dynamics_jacobian, &dynamics, states, states);
        let c = by_state(&model.observation_jacobian, &observation, outputs, states);
        if setting.intensities.iter().all(|&f| f == 0.0) {
            let k = DMatrix::zeros(states, outputs);
            return Some(Self {
                k,
                a,
                c,
                steady: None,
            });
        }
        if !a.iter().chain(&c).all(|value| value.is_finite()) {
            return None;
        }
        let g = c.transpose() * setting.weight * &c / segment.steps.length(0);
        let intensities = DVector::from_column_slice(setting.intensities);
        let q = DMatrix::from_diagonal(&intensities.map(|f| f * f));
        let steady = SteadyCovariance::new(&a, &g, &q)?;
        let k = &steady.p * c.transpose() * setting.weight;
        let finite = k.iter().all(|value| value.is_finite());
        finite.then_some(Self {
            k,
            a,
            c,
            steady: Some(steady),
        })
    }

    /// The diagonal of K C: the share of a state's prediction error that a sample takes away. Above 1 the innovations
    /// would vary less than the prediction errors that they are made of.
    pub(super) fn shares(&self) -> DVector<f64> {
        (&self.k * &self.c).diagonal()
    }

    /// ∂K by each of the columns.
    pub(super) fn changes(&self, setting: &Setting<'_>, columns: &[Column]) -> Vec<Change> {
        columns
            .iter()
            .map(|column| self.change(setting, *column))
            .collect()
    }

    fn change(&self, setting: &Setting<'_>, column: Column) -> Change {
        stop::check();
        let (states, outputs) = (self.k.nrows(), self.k.ncols());
        let Some(steady) = &self.steady else {
            return Change {
                k: DMatrix::zeros(states, outputs),
                share: DVector::zeros(states),
            };
        };
        let weight = setting.weight;
        match column {
            Column::Intensity(state) => {
                let mut forcing = DMatrix::zeros(states, states);
                forcing[(state, state)] = 2.0 * setting.intensities[state];
                let k = steady.change(&forcing) * self.c.transpose() * weight;
                let share = (&k * &self.c).diagonal();
                Change { k, share }
            }
            Column::Parameter(parameter) => {
                let (da, dc) = self.linearised_change(setting, parameter);
                let cross = dc.transpose() * weight * &self.c;
                let dg = (&cross + cross.transpose()) / setting.segment.steps.length(0);
                let flow = &da * &steady.p;
                let forcing = &flow + flow.transpose() - &steady.p * dg * &steady.p;
                let dp = steady.change(&forcing);
                let k = (dp * self.c.transpose() + &steady.p * dc.transpose()) * weight;
                let share = (&k * &self.c + &self.k * dc).diagonal();
                Change { k, share }
            }
        }
    }

    /// ∂A/∂θ and ∂C/∂θ for one parameter, the initial state's part in it included.
    fn linearised_change(
        &self,
        setting: &Setting<'_>,
        parameter: usize,
    ) -> (DMatrix<f64>, DMatrix<f64>) {
        let model = setting.model;
        let (segment, parameters) = (setting.segment, setting.parameters);
        let [dynamics, observation] =
            slopes_at_start(model, jacobians(model), segment, parameters, parameter);
        let (states, outputs) = (self.k.nrows(), self.k.ncols());
        (
            by_state(&model.dynamics_jacobian, &dynamics, states, states),
            by_state(&model.observation_jacobian, &observation, outputs, states),
        )
    }
}

/// Those of ∂f/∂x and ∂g/∂x.
fn jacobians(model: &Model) -> [&Jacobian; 2] {
    [&model.dynamics_jacobian, &model.observation_jacobian]
}

/// ∂h/∂x as a matrix.
fn by_state(jacobian: &Jacobian, entries: &[f64], rows: usize, states: usize) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(rows, states);
    for (&place, &entry) in jacobian.by_state.iter().zip(entries) {
        matrix[place] = entry;
    }
    matrix
}
