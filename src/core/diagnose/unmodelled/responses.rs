//! How the outputs respond to a force of each shape in one equation.
//!
//! The model is compiled once more with a sum of shapes as recorded inputs, which a parameter lets into each equation.
//! What it is differentiated by are the sizes of the shapes, at zero: the exact response of the model along its own
//! trajectory, delays included.

use nalgebra::DMatrix;

use super::equations::Equation;
use super::flown::Flown;
use super::report::ForceIn;
use super::shapes::Shapes;
use crate::diagnose::case::compile;
use crate::diagnose::stack::sensitivities;
use crate::estimate::{Problem, Unknowns};
use crate::flight::{Dimension, Unit};
use crate::model::limits::MOST_INPUTS;
use crate::model::{Definition, Input, Model, ModelDocument, Parameter, Per, Start};
use crate::simulate::Segment;

/// Shapes that are simulated at once.
const AT_ONCE: usize = 24;

const FORCE: &str = "unmodelled_force";

fn shape(index: usize) -> String {
    format!("unmodelled_shape_{index}")
}

fn size(index: usize) -> String {
    format!("unmodelled_size_{index}")
}

fn into(equation: &str) -> String {
    format!("unmodelled_into_{equation}")
}

/// ∂y/∂c of one segment: rows are some of the column's, columns the segment's shapes.
#[derive(Clone, Debug)]
pub(super) struct Response {
    pub rows: std::ops::Range<usize>,
    pub columns: DMatrix<f64>,
}

/// The model with a force that may act in each of some equations.
pub(super) struct Responses<'f> {
    flown: &'f Flown,
    shapes: &'f [Shapes],
    /// `None` where there is no equation but the outputs'.
    forced: Option<Model>,
    at_once: usize,
}

impl<'f> Responses<'f> {
    /// `shapes` by segment. `None` where the model has no room for a force.
    pub(super) fn new(
        flown: &'f Flown,
        shapes: &'f [Shapes],
        equations: &[Equation],
    ) -> Option<Self> {
        let document = &flown.problem.model.document;
        let at_once = AT_ONCE.min(MOST_INPUTS.saturating_sub(document.inputs.len()));
        let inner = || (equations.iter()).filter(|equation| equation.force_in != ForceIn::Output);
        let forced = if inner().next().is_none() {
            None
        } else if at_once == 0 {
            return None;
        } else {
            Some(compile(&forced(document, inner(), at_once)).ok()?)
        };
        Some(Self {
            flown,
            shapes,
            forced,
            at_once,
        })
    }

    /// By segment, the response to a force in an equation. `None` where the simulation leaves the range of numbers.
    pub(super) fn to(&self, equation: &Equation) -> Option<Vec<Response>> {
        match equation.force_in {
            ForceIn::Output => self.of_output(&equation.name),
            ForceIn::State | ForceIn::Coefficient => self.of_motion(&equation.name),
        }
    }

    /// What is added to an output is seen as it is.
    fn of_output(&self, name: &str) -> Option<Vec<Response>> {
        let outputs = &self.flown.problem.model.outputs;
        let output = outputs.iter().position(|output| output.name == name)?;
        let of = |(segment, shapes): (usize, &Shapes)| {
            let series = &self.flown.samples.layout.series;
            let series = series
                .iter()
                .find(|s| s.segment == segment && s.output == output)?;
            let columns: Vec<Vec<f64>> = (0..shapes.count).map(|j| shapes.shape(j)).collect();
            Some(Response {
                rows: series.range.clone(),
                columns: DMatrix::from_fn(series.range.len(), shapes.count, |row, j| {
                    columns[j][row]
                }),
            })
        };
        self.shapes.iter().enumerate().map(of).collect()
    }

    fn of_motion(&self, name: &str) -> Option<Vec<Response>> {
        let model = self.forced.as_ref()?;
        let of_name =
            |name: &str| (model.parameters.iter()).position(|parameter| parameter.name == name);
        let unknowns = self.unknowns(model, of_name(&into(name))?);
        let sizes: Vec<usize> = (0..self.at_once)
            .map(|index| of_name(&size(index)))
            .collect::<Option<_>>()?;
        let mut responses: Vec<Response> = (self.shapes.iter().enumerate())
            .map(|(segment, shapes)| {
                let rows = self.flown.rows(segment);
                Response {
                    columns: DMatrix::zeros(rows.len(), shapes.count),
                    rows,
                }
            })
            .collect();
        let most = self.shapes.iter().map(|shapes| shapes.count).max()?;
        for first in (0..most).step_by(self.at_once) {
            let problem = Problem::new(
                model.clone(),
                self.segments(first),
                unknowns.clone(),
                self.flown.problem.options.clone(),
            );
            let theta = unknowns.start();
            let columns =
                sensitivities(&problem, &self.flown.samples.layout, &theta, &sizes).ok()?;
            for (index, column) in columns.iter().enumerate() {
                for (response, shapes) in responses.iter_mut().zip(self.shapes) {
                    if first + index < shapes.count {
                        let mut to = response.columns.column_mut(first + index);
                        to.copy_from_slice(&column[response.rows.clone()]);
                    }
                }
            }
        }
        Some(responses)
    }

    /// All of the model's parameters where they are, the force let into one equation.
    fn unknowns(&self, model: &Model, open: usize) -> Unknowns {
        let segments = self.flown.problem.segments.len();
        let known: Vec<Vec<f64>> = (0..segments)
            .map(|segment| self.flown.parameters(segment))
            .collect();
        let value = |parameter: usize, segment: usize| {
            let added = if parameter == open { 1.0 } else { 0.0 };
            let value = known[segment].get(parameter).copied().unwrap_or(added);
            Ok::<f64, std::convert::Infallible>(value)
        };
        match Unknowns::new(model, segments, value) {
            Ok(unknowns) => unknowns,
        }
    }

    /// The flights with the shapes from `first` on as inputs.
    fn segments(&self, first: usize) -> Vec<Segment> {
        let with = |(segment, shapes): (&Segment, &Shapes)| {
            let mut segment = segment.clone();
            segment
                .inputs
                .extend((first..first + self.at_once).map(|index| shapes.shape(index)));
            segment
        };
        let segments = self.flown.problem.segments.iter();
        segments.zip(self.shapes).map(with).collect()
    }
}

/// The document with a force in each of some equations, behind everything that it has.
fn forced<'e>(
    document: &ModelDocument,
    equations: impl Iterator<Item = &'e Equation>,
    shapes: usize,
) -> ModelDocument {
    let mut document = document.clone();
    let parameter = |unit: String, fixed: bool| Parameter {
        unit,
        start: Start::Value(0.0),
        lower: None,
        upper: None,
        fixed,
        per: Per::Job,
        only_in: Vec::new(),
        prior: None,
        quantity: None,
        description: String::new(),
    };
    let mut sum = Vec::new();
    for index in 0..shapes {
        document.inputs.insert(
            shape(index),
            Input {
                unit: "-".to_string(),
                ..Input::default()
            },
        );
        document
            .parameters
            .insert(size(index), parameter("-".to_string(), false));
        sum.push(format!("{}*{}", size(index), shape(index)));
    }
    document.definitions.insert(
        FORCE.to_string(),
        Definition {
            unit: "-".to_string(),
            equation: sum.join(" + "),
            quantity: None,
            description: String::new(),
        },
    );
    for Equation { name, .. } in equations {
        let into = into(name);
        let dimension = |unit: &str| Unit::parse(unit).map_or(Dimension::NONE, |u| u.dimension);
        let (law, unit) = if let Some(state) = document.states.get_mut(name) {
            let rate = dimension(&state.unit).over(Dimension::SECOND);
            (&mut state.derivative, rate)
        } else if let Some(definition) = document.definitions.get_mut(name) {
            (&mut definition.equation, dimension(&definition.unit))
        } else {
            continue;
        };
        *law = format!("{law} + {into}*{FORCE}");
        document
            .parameters
            .insert(into, parameter(unit.to_string(), true));
    }
    document
}
