//! The frequency response of one segment, and its derivatives by the columns.
//!
//! With w = [x; u] and [A B]' the derivative of [A B] by a parameter, x' = (iω - A)⁻¹ ([A B]' w + B u'), and
//! y' = [C D]' w + C x' + D u'. A lag or delay multiplies a transform; see `path`.

use num_complex::Complex64;

use super::columns::Columns;
use super::linear::Linear;
use super::path::{Passed, passed};
use super::spectra::{Spectra, Target};
use crate::estimate::problem::Problem;
use crate::model::{Element, PathElement};
use crate::spectral::invert;

/// The sizes of the elements of all paths, and their derivatives.
pub(super) struct Sizes {
    values: Vec<f64>,
    /// (place of the element, parameter, ∂ψ/∂θ)
    slopes: Vec<(usize, usize, f64)>,
}

/// Room for the numbers of one frequency.
pub(super) struct Room {
    /// (iω - A)⁻¹
    inverse: Vec<Complex64>,
    /// C (iω - A)⁻¹
    through: Vec<Complex64>,
    /// [x; u]
    signals: Vec<Complex64>,
    /// By element of an input: ∂u/∂ψ.
    input_slopes: Vec<Complex64>,
    /// By element of an output: its factor, and the derivative of the product of all factors of its output by ψ.
    output_slopes: Vec<Complex64>,
    /// By output: the product of its factors.
    factors: Vec<Complex64>,
    pub residuals: Vec<Complex64>,
    /// By output, before its path.
    before: Vec<Complex64>,
    pub rows: Vec<Complex64>,
}

impl Sizes {
    pub(super) fn at(problem: &Problem, parameters: &[f64], columns: Option<&Columns>) -> Self {
        let paths = &problem.model.paths;
        let mut sizes = Self {
            values: paths.at(parameters),
            slopes: Vec::new(),
        };
        let Some(columns) = columns.filter(|_| !paths.is_empty()) else {
            return sizes;
        };
        let entries = paths.derivatives(parameters).into_iter();
        sizes.slopes = entries
            .filter(|entry| columns.of[entry.1].is_some())
            .collect();
        sizes
    }
}

/// All that the response of one segment is made from.
pub(super) struct Response<'a> {
    pub problem: &'a Problem,
    pub spectra: &'a Spectra,
    pub linear: &'a Linear,
    pub sizes: &'a Sizes,
    /// By term of the spectra.
    pub ends: &'a [f64],
    pub columns: Option<&'a Columns>,
}

impl Response<'_> {
    pub(super) fn room(&self) -> Room {
        let model = &self.problem.model;
        let (states, inputs) = (model.states.len(), model.inputs.len());
        let outputs = model.outputs.len();
        let zeros = |count: usize| vec![Complex64::ZERO; count];
        let width = self.columns.map_or(0, |columns| columns.places.len());
        Room {
            inverse: zeros(states * states),
            through: zeros(outputs * states),
            signals: zeros(states + inputs),
            input_slopes: zeros(model.paths.of_inputs().len()),
            output_slopes: zeros(model.paths.of_outputs().len()),
            factors: zeros(outputs),
            residuals: zeros(outputs),
            before: zeros(outputs),
            rows: zeros(outputs * width),
        }
    }

    /// `None` where the response is not finite.
    pub(super) fn at(&self, k: usize, room: &mut Room) -> Option<()> {
        let model = &self.problem.model;
        let (states, inputs) = (model.states.len(), model.inputs.len());
        let width = states + inputs;
        let omega = self.spectra.omega[k];
        for i in 0..states {
            for j in 0..states {
                let own = if i == j { omega } else { 0.0 };
                room.inverse[i * states + j] =
                    Complex64::new(-self.linear.dynamics.values[i * width + j], own);
            }
        }
        invert(&mut room.inverse, states)?;
        self.pass_inputs(k, room);
        self.solve_states(k, room);
        self.pass_outputs(omega, room);
        self.compare(k, room);
        if let Some(columns) = self.columns {
            self.differentiate(k, columns, room);
        }
        let finite = room.residuals.iter().chain(&room.rows);
        finite.copied().all(Complex64::is_finite).then_some(())
    }

    /// The inputs as the equations see them.
    fn pass_inputs(&self, k: usize, room: &mut Room) {
        let model = &self.problem.model;
        let states = model.states.len();
        for (input, transform) in self.spectra.inputs.iter().enumerate() {
            room.signals[states + input] = transform[k];
        }
        let omega = self.spectra.omega[k];
        let elements = model.paths.of_inputs().iter().enumerate();
        // factors may come in any order: delays first, which look at the recording itself
        for (place, at) in elements.clone() {
            let size = self.sizes.values[place];
            let signal = &mut room.signals[states + at.signal];
            if let (Element::Delay, Some(window)) = (at.element, &self.spectra.windows[at.signal]) {
                let delayed = window.delayed(*signal, size, omega, self.spectra.scale);
                (*signal, room.input_slopes[place]) = (delayed.factor, delayed.slope);
            }
        }
        for (place, at) in elements
            .clone()
            .filter(|(_, at)| at.element == Element::Lag)
        {
            let Passed { factor, slope } = passed(at.element, self.sizes.values[place], omega);
            for (other, _) in elements
                .clone()
                .filter(|(_, other)| other.signal == at.signal)
            {
                room.input_slopes[other] *= factor;
            }
            let signal = &mut room.signals[states + at.signal];
            room.input_slopes[place] = *signal * slope;
            *signal *= factor;
        }
    }

    /// x = (iω - A)⁻¹ (B u + what the ends add), and C (iω - A)⁻¹.
    fn solve_states(&self, k: usize, room: &mut Room) {
        let model = &self.problem.model;
        let (states, inputs) = (model.states.len(), model.inputs.len());
        let width = states + inputs;
        let mut forcing = [Complex64::ZERO; 64];
        for (state, forcing) in forcing.iter_mut().take(states).enumerate() {
            for input in states..width {
                let entry = self.linear.dynamics.values[state * width + input];
                *forcing += room.signals[input] * entry;
            }
        }
        for (term, size) in self.spectra.terms.iter().zip(self.ends) {
            if let Target::State(state) = term.target {
                forcing[state] += term.transform[k] * size;
            }
        }
        for state in 0..states {
            let row = &room.inverse[state * states..(state + 1) * states];
            room.signals[state] = row.iter().zip(&forcing).map(|(g, f)| g * f).sum();
        }
        for output in 0..model.outputs.len() {
            let row = &self.linear.observation.values[output * width..output * width + states];
            for state in 0..states {
                room.through[output * states + state] = (0..states)
                    .map(|via| room.inverse[via * states + state] * row[via])
                    .sum();
            }
        }
    }

    /// What the paths of outputs multiply them with.
    fn pass_outputs(&self, omega: f64, room: &mut Room) {
        let paths = &self.problem.model.paths;
        room.factors.fill(Complex64::ONE);
        let first = paths.of_inputs().len();
        let elements: &[PathElement] = paths.of_outputs();
        for (place, at) in elements.iter().enumerate() {
            let Passed { factor, slope } =
                passed(at.element, self.sizes.values[first + place], omega);
            for (before, other) in elements[..place].iter().enumerate() {
                if other.signal == at.signal {
                    room.output_slopes[before] *= factor;
                }
            }
            room.output_slopes[place] = room.factors[at.signal] * slope;
            room.factors[at.signal] *= factor;
        }
    }

    /// What is modelled, and what is left of the measured.
    fn compare(&self, k: usize, room: &mut Room) {
        let width = room.signals.len();
        for output in 0..room.residuals.len() {
            let row = &self.linear.observation.values[output * width..(output + 1) * width];
            let before: Complex64 = row.iter().zip(&room.signals).map(|(c, w)| w * c).sum();
            room.before[output] = before;
            room.residuals[output] =
                self.spectra.outputs[output][k] - before * room.factors[output];
        }
        for (term, size) in self.spectra.terms.iter().zip(self.ends) {
            if let Target::Output(output) = term.target {
                room.residuals[output] -= term.transform[k] * size;
            }
        }
    }

    /// The derivatives of what is modelled, by the columns.
    fn differentiate(&self, k: usize, columns: &Columns, room: &mut Room) {
        let width = columns.places.len();
        room.rows.fill(Complex64::ZERO);
        self.by_equations(columns, room);
        self.by_input_paths(columns, room);
        for (rows, factor) in room.rows.chunks_exact_mut(width.max(1)).zip(&room.factors) {
            rows.iter_mut().for_each(|entry| *entry *= factor);
        }
        self.by_output_paths(columns, room);
        self.by_terms(k, columns, room);
    }

    /// [A B]' and [C D]'
    fn by_equations(&self, columns: &Columns, room: &mut Room) {
        let (states, width) = (self.problem.model.states.len(), columns.places.len());
        for slope in &self.linear.dynamics.slopes {
            let Some(column) = columns.of[slope.parameter] else {
                continue;
            };
            let forcing = room.signals[slope.column] * slope.value;
            let through = room.through.iter().skip(slope.row).step_by(states);
            for (output, through) in through.enumerate() {
                room.rows[output * width + column] += through * forcing;
            }
        }
        for slope in &self.linear.observation.slopes {
            if let Some(column) = columns.of[slope.parameter] {
                let change = room.signals[slope.column] * slope.value;
                room.rows[slope.row * width + column] += change;
            }
        }
    }

    /// u' of lags and delays of inputs.
    fn by_input_paths(&self, columns: &Columns, room: &mut Room) {
        let (states, width) = (self.problem.model.states.len(), columns.places.len());
        let elements = self.problem.model.paths.of_inputs();
        for &(place, parameter, by) in &self.sizes.slopes {
            let (Some(column), Some(at)) = (columns.of[parameter], elements.get(place)) else {
                continue;
            };
            let change = room.input_slopes[place] * by;
            let entry = states + at.signal;
            for output in 0..room.before.len() {
                let whole = self.transfer(output, entry, room);
                room.rows[output * width + column] += whole * change;
            }
        }
    }

    /// C (iω - A)⁻¹ B + D, from an input to an output.
    fn transfer(&self, output: usize, entry: usize, room: &Room) -> Complex64 {
        let states = self.problem.model.states.len();
        let width = room.signals.len();
        let through = &room.through[output * states..(output + 1) * states];
        let via = through.iter().enumerate();
        let via: Complex64 = via
            .map(|(state, through)| through * self.linear.dynamics.values[state * width + entry])
            .sum();
        via + self.linear.observation.values[output * width + entry]
    }

    /// What lags and delays of outputs do to their own factors.
    fn by_output_paths(&self, columns: &Columns, room: &mut Room) {
        let paths = &self.problem.model.paths;
        let width = columns.places.len();
        for &(place, parameter, by) in &self.sizes.slopes {
            let place = place.checked_sub(paths.of_inputs().len());
            let (Some(place), Some(column)) = (place, columns.of[parameter]) else {
                continue;
            };
            let output = paths.of_outputs()[place].signal;
            let change = room.output_slopes[place] * room.before[output] * by;
            room.rows[output * width + column] += change;
        }
    }

    /// What is estimated of ends and trends is linear in the outputs.
    fn by_terms(&self, k: usize, columns: &Columns, room: &mut Room) {
        let model = &self.problem.model;
        let (states, width) = (model.states.len(), columns.places.len());
        let own = model.document.parameters.len();
        for (number, term) in self.spectra.terms.iter().enumerate() {
            let Some(column) = columns.of[own + number] else {
                continue;
            };
            let added = term.transform[k];
            match term.target {
                Target::Output(output) => room.rows[output * width + column] += added,
                Target::State(state) => {
                    for (output, factor) in room.factors.iter().enumerate() {
                        let through = room.through[output * states + state];
                        room.rows[output * width + column] += through * added * factor;
                    }
                }
            }
        }
    }
}
