//! The equations linearised about a point: dx/dt = A x + B u, y = C x + D u, and the derivatives of A, B, C and D by θ.
//!
//! Of a linear model these are its matrices, whatever the point. Of another they are those of small motions about it; the
//! point itself does not move with θ.
//!
//! One direction of states and inputs at a time is taken with a complex step (exact but for rounding) through the equations
//! and their Jacobians: ∂f/∂u from f, ∂²f/∂θ∂x and ∂²f/∂θ∂u from ∂f/∂θ.

use num_complex::Complex64;

use crate::model::{Jacobian, Model, Program, Workspace};
use crate::simulate::{Segment, initial_state};

/// Beside numbers near one this loses nothing, and its square is zero.
const COMPLEX_STEP: f64 = 1e-40;

/// Where a model is linearised: x and u, SI, at t = 0.
pub(super) struct Point {
    states: Vec<f64>,
    inputs: Vec<f64>,
}

impl Point {
    /// The start of a segment: x0(θ), and the first sample of each input.
    pub(super) fn start_of(segment: &Segment, model: &Model, parameters: &[f64]) -> Self {
        Self {
            states: initial_state(model, parameters),
            inputs: segment.inputs.iter().map(|input| input[0]).collect(),
        }
    }
}

/// One entry of a derivative of [A B] or [C D].
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Slope {
    pub parameter: usize,
    pub row: usize,
    pub column: usize,
    pub value: f64,
}

/// Some rows over states and inputs, row by row, and what they change by with θ.
#[derive(Clone, Default, Debug)]
pub(super) struct Rows {
    pub values: Vec<f64>,
    pub slopes: Vec<Slope>,
}

/// [A B] and [C D].
#[derive(Clone, Default, Debug)]
pub(super) struct Linear {
    pub dynamics: Rows,
    pub observation: Rows,
}

impl Linear {
    /// Whether all entries are finite.
    pub(super) fn is_finite(&self) -> bool {
        let rows = [&self.dynamics, &self.observation];
        rows.iter().all(|rows| {
            rows.values.iter().all(|value| value.is_finite())
                && rows.slopes.iter().all(|slope| slope.value.is_finite())
        })
    }
}

/// Equations and their Jacobian, ready to be looked at in any direction.
struct Equations<'m> {
    program: &'m Program,
    jacobian: &'m Jacobian,
    values: Workspace<Complex64>,
    slopes: Workspace<Complex64>,
}

/// Linearises a model for any θ.
pub(super) struct Linearisation<'m> {
    states: usize,
    inputs: usize,
    parameters: usize,
    dynamics: Equations<'m>,
    observation: Equations<'m>,
}

impl<'m> Linearisation<'m> {
    pub(super) fn of(model: &'m Model) -> Self {
        Self {
            states: model.states.len(),
            inputs: model.inputs.len(),
            parameters: model.document.parameters.len(),
            dynamics: Equations::new(&model.dynamics, &model.dynamics_jacobian),
            observation: Equations::new(&model.observation, &model.observation_jacobian),
        }
    }

    /// About a point; `parameters` are all of the model's, SI, and perhaps others behind them.
    pub(super) fn at(&mut self, point: &Point, parameters: &[f64]) -> Linear {
        let parameters = &parameters[..self.parameters];
        let parameters: Vec<Complex64> = parameters.iter().map(|&p| p.into()).collect();
        let width = self.states + self.inputs;
        let along = |equations: &mut Equations<'_>| {
            equations.place(point, &parameters);
            equations.rows(self.states, width)
        };
        Linear {
            dynamics: along(&mut self.dynamics),
            observation: along(&mut self.observation),
        }
    }
}

impl<'m> Equations<'m> {
    fn new(program: &'m Program, jacobian: &'m Jacobian) -> Self {
        Self {
            program,
            jacobian,
            values: program.workspace(),
            slopes: jacobian.program.workspace(),
        }
    }

    fn place(&mut self, point: &Point, parameters: &[Complex64]) {
        let both = [
            (self.program, &mut self.values),
            (&self.jacobian.program, &mut self.slopes),
        ];
        for (program, workspace) in both {
            program.set_parameters(workspace, parameters);
            let states = program.states(workspace).iter_mut().zip(&point.states);
            states.for_each(|(to, &value)| *to = value.into());
            // what is behind the inputs belongs to their paths, which are left out here
            program.inputs(workspace).fill(Complex64::ZERO);
            let inputs = program.inputs(workspace).iter_mut().zip(&point.inputs);
            inputs.for_each(|(to, &value)| *to = value.into());
            *program.time(workspace) = Complex64::ZERO;
        }
    }

    /// Entry by entry of the columns, which are states and inputs.
    fn rows(&mut self, states: usize, width: usize) -> Rows {
        let count = self.program.len();
        let mut rows = Rows {
            values: vec![0.0; count * width],
            slopes: Vec::new(),
        };
        for column in 0..width {
            self.step(column, states, COMPLEX_STEP);
            self.program.run(&mut self.values);
            self.jacobian.program.run(&mut self.slopes);
            for row in 0..count {
                let value = self.program.result(&self.values, row);
                rows.values[row * width + column] = value.im / COMPLEX_STEP;
            }
            let first = self.jacobian.by_state.len();
            for (entry, &(row, parameter)) in self.jacobian.by_parameter.iter().enumerate() {
                let slope = self.jacobian.program.result(&self.slopes, first + entry);
                if slope.im != 0.0 {
                    rows.slopes.push(Slope {
                        parameter,
                        row,
                        column,
                        value: slope.im / COMPLEX_STEP,
                    });
                }
            }
            self.step(column, states, 0.0);
        }
        rows
    }

    fn step(&mut self, column: usize, states: usize, step: f64) {
        let both = [
            (self.program, &mut self.values),
            (&self.jacobian.program, &mut self.slopes),
        ];
        for (program, workspace) in both {
            let at = match column.checked_sub(states) {
                Some(input) => &mut program.inputs(workspace)[input],
                None => &mut program.states(workspace)[column],
            };
            at.im = step;
        }
    }
}
