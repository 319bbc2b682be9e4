//! A trajectory in intervals, each with an initial state of its own: an edit of the model makes initial states
//! parameters and end states outputs, so that an interval is simulated like any segment.

use nalgebra::{DMatrix, DVector};

use crate::estimate::likelihood::sums::ResidualSums;
use crate::estimate::problem::Problem;
use crate::model::{Model, ModelDocument, Output, Parameter, Per, Start};
use crate::simulate::{Block, Columns, Segment, Sensitivities, simulate};
use crate::stop;

/// States at the beginnings of intervals: by segment, then interval.
pub(super) type Nodes = Vec<Vec<DVector<f64>>>;

/// Most numbers in the normal equations of all intervals.
const MOST_ENTRIES: usize = 20_000_000;

/// Some consecutive samples, with the first of the next interval as the last of the segment.
pub(super) struct Interval {
    segment: Segment,
    /// Samples whose residuals count here.
    samples: usize,
    /// Time from the start of the segment that it was cut from, s.
    elapsed: f64,
    /// Sample of that segment at which it begins.
    pub first: usize,
}

/// A problem cut into intervals.
pub(super) struct Cut<'p> {
    pub problem: &'p Problem,
    model: Model,
    columns: Columns,
    /// By segment.
    pub intervals: Vec<Vec<Interval>>,
}

/// Residuals and states at the ends of intervals.
pub(super) struct Simulated {
    pub residuals: ResidualSums,
    /// By segment and interval.
    pub ends: Nodes,
}

/// An interval linearised, in columns [own initial state, θ].
pub(super) struct Piece {
    /// Σ rowᵀ R⁻¹ row and Σ rowᵀ R⁻¹ e
    pub information: DMatrix<f64>,
    pub descent: DVector<f64>,
    /// The state at the end, and its derivative.
    pub end: DVector<f64>,
    pub slopes: DMatrix<f64>,
}

impl<'p> Cut<'p> {
    /// Intervals of `length` seconds, longer where there would be too many.
    /// `None` where the edited model is too large.
    pub(super) fn new(problem: &'p Problem, length: f64) -> Option<Self> {
        let model = Model::compile(&edited(&problem.model.document)).ok()?;
        let own = problem.model.parameters.len();
        let free = |parameter: &usize| {
            let is_free = |unknown: &crate::estimate::problem::unknowns::Unknown| {
                unknown.parameter == *parameter && !unknown.fixed
            };
            *parameter >= own || problem.unknowns.all.iter().any(is_free)
        };
        let nodes = own + problem.model.states.len();
        let columns = Columns::new(&model, &(0..nodes).filter(free).collect::<Vec<_>>());
        let width = problem.model.states.len() + problem.unknowns.len();
        let most = (MOST_ENTRIES / (width * width).max(1)).max(problem.segments.len());
        let total: f64 = problem
            .segments
            .iter()
            .filter_map(|s| s.elapsed().last().copied())
            .sum();
        let length = length.max(total / most as f64);
        let intervals = problem
            .segments
            .iter()
            .map(|segment| cut(segment, length))
            .collect();
        Some(Self {
            problem,
            model,
            columns,
            intervals,
        })
    }

    /// Parameters of the edited model for an interval.
    fn parameters(
        &self,
        segment: usize,
        interval: &Interval,
        theta: &[f64],
        node: &DVector<f64>,
        to: &mut Vec<f64>,
    ) {
        self.problem.unknowns.parameters(segment, theta, to);
        to.extend(node.iter());
        to.push(interval.elapsed);
    }

    /// Simulates one interval; the answer is the state at its end.
    pub(super) fn end(
        &self,
        segment: usize,
        index: usize,
        theta: &[f64],
        node: &DVector<f64>,
        mut residuals: Option<&mut ResidualSums>,
    ) -> DVector<f64> {
        let interval = &self.intervals[segment][index];
        let mut parameters = Vec::new();
        self.parameters(segment, interval, theta, node, &mut parameters);
        let options = &self.problem.options;
        let outputs = self.problem.model.outputs.len();
        let mut end = node.clone();
        let mut residual = DVector::zeros(outputs);
        simulate(
            &self.model,
            options.integrator,
            options.input_interpolation,
            &interval.segment,
            &parameters,
            |k, y: &[f64]| {
                if let Some(sums) = &mut residuals
                    && k < interval.samples
                {
                    for i in 0..outputs {
                        residual[i] = counted(interval.segment.measured[i][k] - y[i], y[i]);
                    }
                    sums.ger(1.0, &residual, &residual, 1.0);
                }
                end.copy_from_slice(&y[outputs..]);
            },
        );
        end
    }

    /// Simulates all intervals; `None` where one leaves the range of numbers.
    pub(super) fn simulate(&self, theta: &[f64], nodes: &Nodes) -> Option<Simulated> {
        let outputs = self.problem.model.outputs.len();
        let mut residuals = DMatrix::zeros(outputs, outputs);
        let mut ends = Vec::new();
        for (segment, nodes) in nodes.iter().enumerate() {
            let of_interval = |(index, node): (usize, &DVector<f64>)| {
                self.end(segment, index, theta, node, Some(&mut residuals))
            };
            ends.push(
                nodes
                    .iter()
                    .enumerate()
                    .map(of_interval)
                    .collect::<Vec<_>>(),
            );
        }
        let finite = residuals
            .iter()
            .chain(ends.iter().flatten().flatten())
            .all(|v| v.is_finite());
        finite.then_some(Simulated { residuals, ends })
    }

    /// Linearises all intervals; `weights` is R⁻¹. `None` where one leaves the range of numbers.
    pub(super) fn pieces(
        &self,
        theta: &[f64],
        nodes: &Nodes,
        weights: &DMatrix<f64>,
    ) -> Option<Vec<Vec<Piece>>> {
        let options = &self.problem.options;
        let mut machinery = Sensitivities::new(
            &self.model,
            &self.columns,
            options.integrator,
            options.input_interpolation,
        );
        let mut parameters = Vec::new();
        let mut all = Vec::new();
        for (segment, nodes) in nodes.iter().enumerate() {
            let mut pieces = Vec::new();
            let places = self.places(segment);
            for (interval, node) in self.intervals[segment].iter().zip(nodes) {
                self.parameters(segment, interval, theta, node, &mut parameters);
                let mut piece = Piece::new(node.len(), theta.len());
                machinery
                    .run(&interval.segment, &parameters, |block| {
                        piece.add(block, interval, &places, weights);
                    })
                    .ok()?;
                let sums = piece.information.iter().chain(piece.slopes.iter());
                if !sums.chain(piece.descent.iter()).all(|v| v.is_finite()) {
                    return None;
                }
                pieces.push(piece);
            }
            all.push(pieces);
        }
        Some(all)
    }

    /// By output of the edited model, then column of its sensitivities: column of a [`Piece`].
    fn places(&self, segment: usize) -> Vec<Vec<Option<usize>>> {
        let own = self.problem.model.parameters.len();
        let states = self.problem.model.states.len();
        let place = |&parameter: &usize| match parameter.checked_sub(own) {
            Some(state) => Some(state),
            None => self
                .problem
                .unknowns
                .place(segment, parameter)
                .map(|place| states + place),
        };
        (0..self.model.outputs.len())
            .map(|output| self.columns.of_output(output).iter().map(place).collect())
            .collect()
    }
}

/// A residual that counts: nothing where nothing was measured, but no number where the model has none.
fn counted(residual: f64, model: f64) -> f64 {
    if residual.is_finite() || !model.is_finite() {
        residual
    } else {
        0.0
    }
}

impl Piece {
    fn new(states: usize, unknowns: usize) -> Self {
        let width = states + unknowns;
        Self {
            information: DMatrix::zeros(width, width),
            descent: DVector::zeros(width),
            end: DVector::zeros(states),
            slopes: DMatrix::zeros(states, width),
        }
    }

    fn add(
        &mut self,
        block: &Block<'_>,
        interval: &Interval,
        places: &[Vec<Option<usize>>],
        weights: &DMatrix<f64>,
    ) {
        let outputs = weights.nrows();
        let width = self.descent.len();
        let samples = block.len.min(interval.samples.saturating_sub(block.first));
        let mut rows = Vec::with_capacity(outputs);
        let mut errors = Vec::with_capacity(outputs);
        for (output, places) in places[..outputs].iter().enumerate() {
            let mut own = DMatrix::zeros(samples, width);
            let mut error = DVector::zeros(samples);
            for k in 0..samples {
                let y = block.output(output)[k];
                let z = interval.segment.measured[output][block.first + k];
                if !z.is_finite() {
                    continue;
                }
                error[k] = z - y;
                for (&value, place) in block.row(output, k).iter().zip(places) {
                    if let Some(place) = *place {
                        own[(k, place)] = value;
                    }
                }
            }
            rows.push(own);
            errors.push(error);
        }
        for i in 0..outputs {
            stop::check();
            for j in (0..outputs).filter(|&j| weights[(i, j)] != 0.0) {
                self.information
                    .gemm_tr(weights[(i, j)], &rows[i], &rows[j], 1.0);
                self.descent
                    .gemv_tr(weights[(i, j)], &rows[i], &errors[j], 1.0);
            }
        }
        let last = interval.segment.len() - 1;
        if (block.first..block.first + block.len).contains(&last) {
            let k = last - block.first;
            for state in 0..self.end.len() {
                self.end[state] = block.output(outputs + state)[k];
                let row = block.row(outputs + state, k);
                for (&value, place) in row.iter().zip(&places[outputs + state]) {
                    if let Some(place) = *place {
                        self.slopes[(state, place)] = value;
                    }
                }
            }
        }
    }
}

/// The document with a parameter for each initial state, an output for each state, and time going on from a parameter.
fn edited(document: &ModelDocument) -> ModelDocument {
    let mut edited = document.clone();
    let taken = |name: &str| {
        document.outputs.contains_key(name)
            || document.parameters.contains_key(name)
            || document.constants.contains_key(name)
            || document.inputs.contains_key(name)
            || document.definitions.contains_key(name)
            || document.states.contains_key(name)
    };
    // short names: a name has at most 64 characters
    let unused = |stem: String| {
        let mut name = stem;
        while taken(&name) {
            name.push('_');
        }
        name
    };
    let parameter = |unit: &str| Parameter {
        unit: unit.to_string(),
        start: Start::Value(0.0),
        lower: None,
        upper: None,
        fixed: false,
        per: Per::Job,
        only_in: Vec::new(),
        prior: None,
        quantity: None,
        description: String::new(),
    };
    for (index, (name, state)) in document.states.iter().enumerate() {
        let node = unused(format!("node_{index}"));
        edited
            .parameters
            .insert(node.clone(), parameter(&state.unit));
        edited.states[name].initial = node;
        let output = Output {
            unit: state.unit.clone(),
            equation: name.clone(),
            ..Default::default()
        };
        edited
            .outputs
            .insert(unused(format!("state_{index}")), output);
    }
    let elapsed = unused("node_t".to_string());
    edited.substitute("t", &format!("(t + {elapsed})"));
    edited.parameters.insert(elapsed, parameter("s"));
    edited
}

fn cut(segment: &Segment, length: f64) -> Vec<Interval> {
    let time = segment.elapsed();
    let mut firsts = vec![0];
    let mut begun = 0.0;
    for (k, &t) in time.iter().enumerate().skip(1) {
        // half a step early, so that rounding does not decide
        let slack = 0.5 * (t - time[k - 1]);
        if t - begun > length - slack {
            firsts.push(k);
            begun = t;
        }
    }
    let next = firsts.iter().skip(1).map(|&next| (next, true));
    let ends = next.chain([(segment.len(), false)]);
    let interval = |(&first, (next, goes_on)): (&usize, (usize, bool))| Interval {
        segment: segment.part(first..if goes_on { next + 1 } else { next }),
        samples: next - first,
        elapsed: time[first],
        first,
    };
    firsts.iter().zip(ends).map(interval).collect()
}
