//! Where the unknowns of a filter-error problem stand: the parameters' θ first, then the free intensities.

use crate::estimate::problem::Problem;

/// An unknown, as one segment sees it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Column {
    /// A parameter of the model.
    Parameter(usize),
    /// The intensity of a state's process noise.
    Intensity(usize),
}

/// The unknowns ξ = (θ, f), SI.
pub(super) struct Layout {
    /// States whose intensity is free, in the order of their places.
    pub free: Vec<usize>,
    /// By state: the start value, and the value of those that are held.
    pub start: Vec<f64>,
    /// Number of θ.
    pub parameters: usize,
}

/// An intensity below this share of its start value cannot be told from none.
const NEGLIGIBLE: f64 = 1e-4;

impl Layout {
    /// `automatic` gives the start value of each state that the user gave none.
    pub(super) fn new(problem: &Problem, automatic: &[f64]) -> Self {
        let mut free = Vec::new();
        let mut start = Vec::new();
        for (i, state) in problem.model.states.iter().enumerate() {
            let asked = problem.options.process_noise.get(&state.name);
            let given = asked.and_then(|noise| noise.start);
            start.push(given.map_or(automatic[i], |value| value * state.unit.scale));
            if !asked.is_some_and(|noise| noise.fixed) {
                free.push(i);
            }
        }
        Self {
            free,
            start,
            parameters: problem.unknowns.len(),
        }
    }

    /// Number of unknowns.
    pub(super) fn len(&self) -> usize {
        self.parameters + self.free.len()
    }

    /// The place of a state's intensity.
    pub(super) fn place(&self, state: usize) -> Option<usize> {
        let index = self.free.iter().position(|&free| free == state)?;
        Some(self.parameters + index)
    }

    pub(super) fn start(&self, problem: &Problem) -> Vec<f64> {
        let mut xi = problem.unknowns.start();
        xi.extend(self.free.iter().map(|&state| self.start[state]));
        xi
    }

    /// Intensities by state.
    pub(super) fn intensities(&self, xi: &[f64]) -> Vec<f64> {
        let mut all = self.start.clone();
        for (&state, &value) in self.free.iter().zip(&xi[self.parameters..]) {
            all[state] = value;
        }
        all
    }

    /// Lower and upper bound of a place.
    pub(super) fn limits(&self, problem: &Problem, place: usize) -> (f64, f64) {
        if place < self.parameters {
            let unknown = problem.unknowns.at(place);
            (unknown.lower, unknown.upper)
        } else {
            let state = self.free[place - self.parameters];
            (NEGLIGIBLE * self.start[state], f64::INFINITY)
        }
    }

    /// The columns of a segment and their places.
    pub(super) fn columns(&self, problem: &Problem, segment: usize) -> (Vec<Column>, Vec<usize>) {
        let parameters = (0..problem.model.parameters.len()).filter_map(|parameter| {
            let place = problem.unknowns.place(segment, parameter)?;
            Some((Column::Parameter(parameter), place))
        });
        let intensities = (self.free.iter().enumerate())
            .map(|(index, &state)| (Column::Intensity(state), self.parameters + index));
        parameters.chain(intensities).unzip()
    }

    /// The name of an unknown, and the SI value of its unit.
    pub(super) fn name(&self, problem: &Problem, place: usize) -> (String, f64) {
        if place < self.parameters {
            (problem.name(place), problem.unit(place).scale)
        } else {
            let state = &problem.model.states[self.free[place - self.parameters]];
            (process_noise_name(&state.name), state.unit.scale)
        }
    }
}

/// The name of a state's process noise among the unknowns.
pub(super) fn process_noise_name(state: &str) -> String {
    format!("process_noise.{state}")
}
