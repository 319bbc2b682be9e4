//! A problem in the frequency domain: made of one in the time domain, whose parameters it has, and behind them what is
//! estimated of the ends and trends of each segment.

use super::linear::{Linear, Linearisation, Point};
use super::path::passed;
use super::spectra::{Spectra, Target, Transform};
use crate::estimate::options::Options;
use crate::estimate::options::frequency::FrequencyOptions;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unknowns::Unknown;
use crate::estimate::regression::measured::MeasuredState;
use crate::flight::Unit;
use crate::model::{Element, Parameter, ParameterInfo, Per, Start};

/// A problem whose data are transforms.
pub(super) struct Transformed {
    /// Its counts are those of real and imaginary parts at independent frequencies.
    pub problem: Problem,
    /// By segment.
    pub spectra: Vec<Spectra>,
    /// By segment: about what the model is linearised.
    pub points: Vec<Point>,
    /// By place of its θ: the place in that of the problem that it was made of; none behind those.
    pub places: Vec<Option<usize>>,
}

/// Values of θ, beside the start, at which it is looked whether a parameter has any effect: by a share of each value.
const ELSEWHERE: [f64; 2] = [0.37, -0.61];

impl Transformed {
    /// Of a problem of whose outputs the first `derivatives` are those of measured states, which are its last inputs.
    pub(super) fn new(base: &Problem, options: &FrequencyOptions, derivatives: usize) -> Self {
        let model = &base.model;
        let delayed: Vec<bool> = (0..model.inputs.len())
            .map(|input| {
                let mut path = model.paths.of_inputs().iter();
                path.any(|at| at.signal == input && at.element == Element::Delay)
            })
            .collect();
        let transform = Transform {
            options,
            interpolation: base.options.input_interpolation,
            derivatives,
            measured: derivatives,
            states: model.states.len(),
            delayed: &delayed,
        };
        let spectra: Vec<Spectra> = (base.segments.iter())
            .map(|segment| transform.of(segment))
            .collect();
        let start = base.unknowns.start();
        let mut parameters = Vec::new();
        let points = base.segments.iter().enumerate().map(|(index, segment)| {
            base.unknowns.parameters(index, &start, &mut parameters);
            Point::start_of(segment, model, &parameters)
        });
        let points: Vec<Point> = points.collect();
        let seen = seen(base, &points);
        let targets = (spectra.first()).map_or(Vec::new(), |first| {
            first.terms.iter().map(|term| term.target).collect()
        });
        let independent: usize = spectra.iter().map(|spectra| spectra.independent).sum();
        let is_left_out = |unknown: &Unknown| !seen.get(unknown.parameter).copied().unwrap_or(true);
        let unknowns = base
            .unknowns
            .with_more(targets.len())
            .with_held(is_left_out);
        let places = (unknowns.free.iter())
            .map(|&own| {
                base.unknowns
                    .free
                    .iter()
                    .position(|&of_base| of_base == own)
            })
            .collect();
        let mut extended = model.clone();
        extended
            .parameters
            .extend(targets.iter().map(|target| match *target {
                Target::State(i) => nuisance(&model.states[i].name, model.states[i].unit),
                Target::Output(i) => nuisance(&model.outputs[i].name, model.outputs[i].unit),
            }));
        let problem = Problem {
            segments: base.segments.clone(),
            columns: base.columns.clone(),
            counts: vec![2 * independent; model.outputs.len()],
            options: Options {
                frequency: Some(*options),
                ..base.options.clone()
            },
            model: extended,
            unknowns,
        };
        Self {
            problem,
            spectra,
            points,
            places,
        }
    }

    /// Takes lag and delay of the outputs that measure states off the transforms of these states: with their sizes at the
    /// start values of `asked`, the problem that was regressed.
    pub(super) fn take_paths_off(&mut self, asked: &Problem, measured: &[MeasuredState]) {
        let paths = &asked.model.paths;
        let recorded = self.problem.model.inputs.len() - measured.len();
        let (start, mut parameters) = (asked.unknowns.start(), Vec::new());
        let first = paths.of_inputs().len();
        for (index, spectra) in self.spectra.iter_mut().enumerate() {
            asked.unknowns.parameters(index, &start, &mut parameters);
            let sizes = paths.at(&parameters);
            for (i, at) in measured.iter().enumerate() {
                let elements = paths.of_outputs().iter().zip(&sizes[first..]);
                for (element, &size) in elements.filter(|(path, _)| path.signal == at.output) {
                    for (k, &omega) in spectra.omega.iter().enumerate() {
                        let factor = passed(element.element, size, omega).factor;
                        spectra.outputs[i][k] /= factor;
                        spectra.inputs[recorded + i][k] /= factor;
                    }
                }
            }
        }
    }

    /// Unknowns that the problem it was made of has, too.
    pub(super) fn shared(&self) -> usize {
        self.places.iter().flatten().count()
    }

    /// The place, in its own θ, of an unknown of the problem it was made of.
    pub(super) fn place(&self, of_base: usize) -> Option<usize> {
        self.places.iter().position(|place| *place == Some(of_base))
    }
}

/// Something of the end or trend of a signal, to be estimated for each segment.
fn nuisance(signal: &str, unit: Unit) -> ParameterInfo {
    ParameterInfo {
        name: format!("end or trend of {signal}"),
        unit: Unit {
            offset: 0.0,
            scale: 1.0,
            ..unit
        },
        document: Parameter {
            unit: String::new(),
            start: Start::Value(0.0),
            lower: None,
            upper: None,
            fixed: false,
            per: Per::Maneuver,
            only_in: Vec::new(),
            prior: None,
            quantity: None,
            description: String::new(),
        },
    }
}

/// By parameter: whether the frequency response depends on it, at the start or elsewhere. Biases, trim values and initial
/// states of a linear model do not show in it.
fn seen(base: &Problem, points: &[Point]) -> Vec<bool> {
    let model = &base.model;
    let mut seen: Vec<bool> = (0..model.parameters.len())
        .map(|parameter| model.paths.depends_on(parameter))
        .collect();
    let mut linearisation = Linearisation::of(model);
    let (start, mut parameters) = (base.unknowns.start(), Vec::new());
    for (index, point) in points.iter().enumerate() {
        for share in std::iter::once(0.0).chain(ELSEWHERE) {
            base.unknowns.parameters(index, &start, &mut parameters);
            for (place, value) in parameters.iter_mut().enumerate() {
                // each by another share, so that nothing cancels
                *value += share * (value.abs() + 0.01) * (1.0 + 0.01 * place as f64);
            }
            let Linear {
                dynamics,
                observation,
            } = linearisation.at(point, &parameters);
            for slope in dynamics.slopes.iter().chain(&observation.slopes) {
                seen[slope.parameter] = true;
            }
        }
    }
    seen
}
