//! The state matrix ∂f/∂x of a model at a point, and its derivatives by θ.

use nalgebra::DMatrix;
use nalgebra::linalg::balancing::balance_parlett_reinsch;

use crate::estimate::evaluation::linearised::{at_start, slopes_at_start};
use crate::estimate::problem::Problem;
use crate::flight::{Dimension, Unit};
use crate::model::Model;

/// Entries beyond this count as not finite: their squares would leave the range.
const LARGEST: f64 = 1e100;

/// A over the chosen states, and dA/dθ.
pub(crate) struct StateMatrix {
    pub value: DMatrix<f64>,
    /// By place of θ.
    pub by_place: Vec<DMatrix<f64>>,
    /// The same for all states, inputs and segments?
    pub is_everywhere: bool,
}

/// Whether the motion is recorded rather than computed from forces: an input is an acceleration, or all inputs
/// are angular rates. Eigenvalues of such a model say nothing of the aircraft.
pub(crate) fn is_kinematic(model: &Model) -> bool {
    let rate = Dimension::NONE.over(Dimension::SECOND);
    let acceleration = Unit::parse("m/s^2").map(|unit| unit.dimension);
    let mut inputs = model.inputs.iter().map(|input| input.unit.dimension);
    inputs.clone().any(|input| Ok(input) == acceleration)
        || !model.inputs.is_empty() && inputs.all(|input| input == rate)
}

/// The states that take part in the motion: those from which some other of them feeds back. A heading or an
/// altitude that only sums up would add an eigenvalue of zero.
pub(crate) fn feeding_back(model: &Model) -> Vec<usize> {
    let entries = &model.dynamics_jacobian.by_state;
    let mut kept: Vec<usize> = (0..model.states.len()).collect();
    loop {
        let before = kept.len();
        let feeds = |state: usize, kept: &[usize]| {
            (entries.iter()).any(|&(row, column)| column == state && kept.contains(&row))
        };
        let still: Vec<usize> = (kept.iter().copied())
            .filter(|&state| feeds(state, &kept))
            .collect();
        kept = still;
        if kept.len() == before {
            return kept;
        }
    }
}

impl StateMatrix {
    /// At the start of a segment; none where an entry is not finite.
    pub(crate) fn at(
        problem: &Problem,
        segment: usize,
        theta: &[f64],
        states: &[usize],
    ) -> Option<Self> {
        let model = &problem.model;
        let data = &problem.segments[segment];
        let jacobian = &model.dynamics_jacobian;
        let mut parameters = Vec::new();
        problem.unknowns.parameters(segment, theta, &mut parameters);
        let n = states.len();
        let filled = |entries: &[f64]| {
            let mut matrix = DMatrix::zeros(n, n);
            for (&(row, column), &entry) in jacobian.by_state.iter().zip(entries) {
                let place = |state: usize| states.iter().position(|&s| s == state);
                if let (Some(row), Some(column)) = (place(row), place(column)) {
                    matrix[(row, column)] = entry;
                }
            }
            matrix
        };
        let [value] = at_start(model, [jacobian], data, &parameters);
        let value = filled(&value);
        let mut by_place = vec![DMatrix::zeros(n, n); theta.len()];
        let mut own = false;
        for parameter in 0..parameters.len() {
            let Some(place) = problem.unknowns.place(segment, parameter) else {
                continue;
            };
            let [by] = slopes_at_start(model, [jacobian], data, &parameters, parameter);
            by_place[place] = filled(&by);
            own |= problem.unknowns.at(place).segment.is_some()
                && by_place[place].iter().any(|&entry| entry != 0.0);
        }
        let in_range = |matrix: &DMatrix<f64>| matrix.iter().all(|entry| entry.abs() < LARGEST);
        if n == 0 || !in_range(&value) || !by_place.iter().all(in_range) {
            return None;
        }
        let varies = (0..jacobian.by_state.len()).any(|i| jacobian.program.varies(i));
        // values that are held differ from maneuver to maneuver, too
        let mut is_same = || {
            problem.segments.iter().enumerate().all(|(index, data)| {
                (problem.unknowns).parameters(index, theta, &mut parameters);
                let [other] = at_start(model, [jacobian], data, &parameters);
                filled(&other) == value
            })
        };
        Some(Self {
            is_everywhere: !own && !varies && is_same(),
            value,
            by_place,
        })
    }

    /// Scales the states so that rows and columns are of like size: eigenvalues stay, eigenvectors are told better.
    pub(crate) fn balance(&mut self) {
        let scale = balance_parlett_reinsch(&mut self.value);
        for matrix in &mut self.by_place {
            for (i, row) in scale.iter().enumerate() {
                for (j, column) in scale.iter().enumerate() {
                    matrix[(i, j)] *= column / row;
                }
            }
        }
    }
}
