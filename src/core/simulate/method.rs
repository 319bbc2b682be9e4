//! How time is stepped: the integrator and what inputs do between samples.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Explicit methods of fixed steps.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// First order. For comparison only: Góes, Hemerly, Maciel found it unfit for reconstruction.
    Euler,
    /// Heun's method, second order: the mean of the slopes at both ends of the step.
    Rk2,
    /// The classical Runge-Kutta method, fourth order.
    #[default]
    Rk4,
}

/// What an input does between two samples.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum InputInterpolation {
    /// A straight line: at half a step the mean of both samples.
    #[default]
    Linear,
    /// The value of the earlier sample, held.
    Hold,
}

/// The stages of an explicit Runge-Kutta method in which each stage builds on the one before it:
/// X_s = x + h advance_s K_(s-1), K_s = f(X_s, u(t + h node_s)), x' = x + h Σ weight_s K_s.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Stage {
    pub advance: f64,
    pub node: f64,
    pub weight: f64,
}

const fn stage(advance: f64, weight: f64) -> Stage {
    Stage {
        advance,
        node: advance,
        weight,
    }
}

const EULER: [Stage; 1] = [stage(0.0, 1.0)];
const RK2: [Stage; 2] = [stage(0.0, 0.5), stage(1.0, 0.5)];
const RK4: [Stage; 4] = [
    stage(0.0, 1.0 / 6.0),
    stage(0.5, 1.0 / 3.0),
    stage(0.5, 1.0 / 3.0),
    stage(1.0, 1.0 / 6.0),
];

impl Integrator {
    /// Evaluations of f in a step; for these methods also its order, the terms of the Taylor series that a step
    /// of a linear system has.
    pub fn stage_count(self) -> usize {
        self.stages().len()
    }

    pub(crate) fn stages(self) -> &'static [Stage] {
        match self {
            Self::Euler => &EULER,
            Self::Rk2 => &RK2,
            Self::Rk4 => &RK4,
        }
    }
}

impl InputInterpolation {
    /// The share of the later sample at the fraction `node` of a step.
    pub fn share_of_next(self, node: f64) -> f64 {
        match self {
            Self::Linear => node,
            Self::Hold => 0.0,
        }
    }
}
