//! One input and one output of a linear system: poles, zeros, gain, and the response at a frequency.
//!
//! States that the input does not move, or the output does not see, are left out first, by the structure of A, B and C: their
//! poles are zeros as well. Zeros are the eigenvalues of the motion that an input makes which holds the output at zero: with
//! the first Markov parameter h = C A^(r−1) B that is not zero, those of A − B C Aʳ/h over the states with C x = ... =
//! C A^(r−1) x = 0 (Isidori, Nonlinear Control Systems, sec. 4.3, for linear systems).

use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{DMatrix, DVector, Schur};
use num_complex::Complex64;

use super::linearisation::{Linearisation, Numbers};
use super::root::{Entries, FoundRoot, Pencil, entries, form};
use super::signal::Signal;

/// A Markov parameter below this share of what its factors could make is none.
const NOTHING: f64 = 1e-12;

/// From one input to one output.
pub(super) struct Channel<'l> {
    pub linear: &'l Linearisation<'l>,
    pub input: &'l Signal,
    pub output: &'l Signal,
    pencil: Pencil,
    /// The coefficient of the numerator's highest power.
    pub gain: f64,
    /// By place of θ.
    pub gain_derivatives: Vec<f64>,
    pub poles: Vec<FoundRoot>,
    pub zeros: Vec<FoundRoot>,
}

/// ln H at a frequency: real part ln |H|, imaginary part the phase in radians, continuous over all frequencies.
#[derive(Clone, Debug)]
pub(super) struct Response {
    pub value: Complex64,
    /// By place of θ.
    pub derivatives: Vec<Complex64>,
}

impl<'l> Channel<'l> {
    /// None where the output does not depend on the input.
    pub(super) fn of(linear: &'l Linearisation<'l>, input: usize, output: usize) -> Option<Self> {
        let mut pencil = reduced(linear, input, output);
        balance(&mut pencil);
        let degree = relative_degree(&pencil)?;
        let gain = leading(&pencil.matrix, degree);
        const STEP: f64 = 1e-40;
        let gain_derivatives = (pencil.by_place.iter())
            .map(|by| {
                let mut moved = pencil.matrix.map(Complex64::from);
                by.iter()
                    .for_each(|&(i, j, slope)| moved[(i, j)].im = STEP * slope);
                leading(&moved, degree).im / STEP
            })
            .collect();
        let states = pencil.of_states();
        let poles = states.roots(&eigenvalues(states.matrix.clone())?);
        let zeros = pencil.roots(&zeros(&pencil.matrix, degree, gain)?);
        Some(Self {
            linear,
            input: &linear.inputs[input],
            output: &linear.outputs[output],
            gain,
            gain_derivatives,
            poles,
            zeros,
            pencil,
        })
    }

    /// H(jω), delays and lags of both signals included.
    pub(super) fn response(&self, omega: f64) -> Option<Response> {
        let (core, left, right) = self.without_paths(omega)?;
        let by_matrix = (self.pencil.by_place.iter()).map(|by| form(&left, by, &right) / core);
        let sizes = &self.linear.at.paths;
        let (input, output) = (
            self.input.path_response(sizes, omega),
            self.output.path_response(sizes, omega),
        );
        let paths = || input.1.iter().chain(&output.1);
        let by_paths = |numbers: &Numbers| -> Complex64 {
            paths()
                .map(|&(place, slope)| slope * numbers.paths[place])
                .sum()
        };
        let derivatives = (by_matrix.zip(&self.linear.by_place))
            .map(|(by, numbers)| by + by_paths(numbers))
            .collect();
        let phase = continuous(core.arg(), self.phase_by_roots(omega));
        let value = Complex64::new(core.norm().ln(), phase) + input.0 + output.0;
        (value.re.is_finite() && value.im.is_finite()).then_some(Response { value, derivatives })
    }

    /// H(0) and its derivatives by place, where it is finite.
    pub(super) fn static_response(&self) -> Option<(f64, Vec<f64>)> {
        const NO_INTEGRATOR: f64 = 1e-9;
        let slowest = (self.poles.iter())
            .map(|pole| pole.value.norm())
            .fold(f64::INFINITY, f64::min);
        let fastest = (self.poles.iter())
            .map(|pole| pole.value.norm())
            .fold(0.0, f64::max);
        if slowest < NO_INTEGRATOR * fastest {
            return None;
        }
        let (value, left, right) = self.without_paths(0.0)?;
        let slopes = (self.pencil.by_place.iter())
            .map(|by| form(&left, by, &right).re)
            .collect();
        Some((value.re, slopes))
    }

    /// The sum of all delays, s.
    pub(super) fn delay(&self) -> f64 {
        self.delay_by(&self.linear.at)
    }

    /// Of the numbers or of their derivatives.
    pub(super) fn delay_by(&self, numbers: &Numbers) -> f64 {
        let places = [self.input, self.output].map(|s| s.place_of(crate::model::Element::Delay));
        places
            .into_iter()
            .flatten()
            .map(|place| numbers.paths[place])
            .sum()
    }

    /// H without the signals' paths, and the vectors with dH = leftᵀ dM right.
    fn without_paths(
        &self,
        omega: f64,
    ) -> Option<(Complex64, DVector<Complex64>, DVector<Complex64>)> {
        let n = self.pencil.states;
        let matrix = self.pencil.matrix.map(Complex64::from);
        let mut right = DVector::from_element(n + 1, Complex64::ONE);
        let mut left = right.clone();
        if n > 0 {
            let a = matrix.view((0, 0), (n, n));
            let s = DMatrix::from_diagonal_element(n, n, Complex64::new(0.0, omega));
            let equations = s - a;
            let b: DVector<Complex64> = matrix.view((0, n), (n, 1)).column(0).into_owned();
            let c: DVector<Complex64> = matrix.view((n, 0), (1, n)).row(0).transpose();
            let across = equations.transpose().lu().solve(&c)?;
            right.rows_mut(0, n).copy_from(&equations.lu().solve(&b)?);
            left.rows_mut(0, n).copy_from(&across);
        }
        let value = (matrix.row(n) * &right)[(0, 0)];
        (value.norm() > 0.0).then_some((value, left, right))
    }

    /// The phase that gain, poles and zeros make, continuous in ω: zero or half a turn at ω = 0, without integrators.
    fn phase_by_roots(&self, omega: f64) -> f64 {
        let of = |roots: &[FoundRoot]| -> f64 { roots.iter().map(|r| angle(r.value, omega)).sum() };
        let gain = if self.gain < 0.0 {
            std::f64::consts::PI
        } else {
            0.0
        };
        gain + of(&self.zeros) - of(&self.poles)
    }
}

/// arg(jω − root), continuous in ω from ω = 0; of two conjugates that are right of the axis without the whole turn that both
/// together have at ω = 0.
fn angle(root: Complex64, omega: f64) -> f64 {
    let (opposite, adjacent) = (omega - root.im, -root.re);
    let angle = opposite.atan2(adjacent);
    match root.re > 0.0 {
        true if root.im == 0.0 => angle,
        true => angle.rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI,
        false => angle,
    }
}

/// The phase that is `phase` but for whole turns, next to another.
fn continuous(phase: f64, near: f64) -> f64 {
    const TURN: f64 = std::f64::consts::TAU;
    phase + TURN * ((near - phase) / TURN).round()
}

/// The pencil of one input and one output over the states between them.
fn reduced(linear: &Linearisation<'_>, input: usize, output: usize) -> Pencil {
    let n = linear.states();
    let (column, row) = (n + input, n + output);
    let is_there = |i: usize, j: usize| {
        let all = std::iter::once(&linear.at).chain(&linear.by_place);
        { all }.any(|numbers| numbers.matrix[(i, j)] != 0.0)
    };
    let moved = spread(n, |i| is_there(i, column), |from, to| is_there(to, from));
    let seen = spread(n, |i| is_there(row, i), is_there);
    let kept: Vec<usize> = (0..n).filter(|&i| moved[i] && seen[i]).collect();
    let with = |last: usize| kept.iter().copied().chain([last]).collect::<Vec<usize>>();
    let (rows, columns) = (with(row), with(column));
    let part = |numbers: &Numbers| numbers.matrix.select_rows(&rows).select_columns(&columns);
    Pencil {
        matrix: part(&linear.at),
        states: kept.len(),
        by_place: (linear.by_place.iter())
            .map(|numbers| entries(&part(numbers)))
            .collect(),
    }
}

/// Which states are reached from those that begin, over arrows.
fn spread(
    states: usize,
    begins: impl Fn(usize) -> bool,
    leads: impl Fn(usize, usize) -> bool,
) -> Vec<bool> {
    let mut reached: Vec<bool> = (0..states).map(begins).collect();
    let mut pending: Vec<usize> = (0..states).filter(|&i| reached[i]).collect();
    while let Some(from) = pending.pop() {
        let beyond: Vec<usize> = (0..states)
            .filter(|&to| !reached[to] && leads(from, to))
            .collect();
        for to in beyond {
            reached[to] = true;
            pending.push(to);
        }
    }
    reached
}

/// Scales the states so that rows and columns of A are of like size.
fn balance(pencil: &mut Pencil) {
    let n = pencil.states;
    if n == 0 {
        return;
    }
    let mut a = pencil.matrix.view((0, 0), (n, n)).into_owned();
    let scale = balance_parlett_reinsch(&mut a);
    let by = |i: usize| if i < n { scale[i] } else { 1.0 };
    for i in 0..=n {
        for j in 0..=n {
            pencil.matrix[(i, j)] *= by(j) / by(i);
        }
    }
    let scaled = |entries: &mut Entries| {
        entries
            .iter_mut()
            .for_each(|(i, j, value)| *value *= by(*j) / by(*i));
    };
    pencil.by_place.iter_mut().for_each(scaled);
}

/// The index of the first Markov parameter D, C B, C A B, ... that is not zero; none where all are.
fn relative_degree(pencil: &Pencil) -> Option<usize> {
    let (matrix, n) = (&pencil.matrix, pencil.states);
    let b = matrix.view((0, n), (n, 1)).norm();
    let c = matrix.view((n, 0), (1, n)).norm();
    let a = matrix.view((0, 0), (n, n)).norm();
    (0..=n).find(|&degree| {
        let most = match degree {
            0 => 0.0,
            _ => c * b * a.powi(degree as i32 - 1),
        };
        leading(matrix, degree).abs() > NOTHING * most
    })
}

/// D, or C A^(degree − 1) B.
fn leading<T: nalgebra::ComplexField>(matrix: &DMatrix<T>, degree: usize) -> T {
    let n = matrix.nrows() - 1;
    if degree == 0 {
        return matrix[(n, n)].clone();
    }
    let a = matrix.view((0, 0), (n, n));
    let mut state = matrix.view((0, n), (n, 1)).into_owned();
    for _ in 1..degree {
        state = &a * state;
    }
    (matrix.view((n, 0), (1, n)) * state)[(0, 0)].clone()
}

/// Zeros to some digits.
fn zeros(matrix: &DMatrix<f64>, degree: usize, gain: f64) -> Option<Vec<Complex64>> {
    let n = matrix.nrows() - 1;
    let a = matrix.view((0, 0), (n, n)).into_owned();
    let b = matrix.view((0, n), (n, 1));
    let mut rows = vec![matrix.view((n, 0), (1, n)).into_owned()];
    for _ in 0..degree {
        let last = rows.last()?;
        rows.push(last * &a);
    }
    // of all rows the last makes the input that holds the output, those before it the states where it can
    let last = rows.pop()?;
    let held = &a - b * last / gain;
    let basis = null_space(&rows, n);
    eigenvalues(basis.transpose() * held * &basis)
}

/// An orthonormal basis of the states that some rows do not see, as columns.
fn null_space(rows: &[DMatrix<f64>], n: usize) -> DMatrix<f64> {
    let mut directions: Vec<DVector<f64>> = Vec::new();
    let without = |mut vector: DVector<f64>, directions: &[DVector<f64>]| {
        // twice is enough
        for _ in 0..2 {
            for direction in directions {
                let along = direction.dot(&vector);
                vector.axpy(-along, direction, 1.0);
            }
        }
        vector
    };
    for row in rows {
        let row = row.row(0).transpose();
        let rest = without(row.normalize(), &directions);
        directions.push(rest.normalize());
    }
    while directions.len() < n {
        let unit = |k: usize| DVector::from_fn(n, |i, _| f64::from(u8::from(i == k)));
        let longest = (0..n)
            .map(|k| without(unit(k), &directions))
            .max_by(|a, b| a.norm().total_cmp(&b.norm()));
        let Some(longest) = longest else { break };
        directions.push(longest.normalize());
    }
    match &directions[rows.len().min(directions.len())..] {
        [] => DMatrix::zeros(n, 0),
        seen => DMatrix::from_columns(seen),
    }
}

fn eigenvalues(matrix: DMatrix<f64>) -> Option<Vec<Complex64>> {
    if matrix.is_empty() {
        return Some(Vec::new());
    }
    let schur = Schur::try_new(matrix, f64::EPSILON, 10_000)?;
    let values = schur.complex_eigenvalues();
    Some(values.iter().map(|z| Complex64::new(z.re, z.im)).collect())
}
