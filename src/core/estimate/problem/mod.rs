//! An estimation problem: a model, its data, its unknowns, and how to go about it. Built once, then only read.

pub(super) mod missing;
pub(crate) mod substeps;
pub(super) mod unknowns;
pub(super) mod unusable;

use crate::estimate::options::Options;
use crate::flight::Unit;
use crate::model::{Model, ParameterInfo};
use crate::simulate::{Columns, Segment, path_out_of_bounds};
use missing::counts;
use substeps::TooStiff;
use unknowns::Unknowns;
use unusable::Unusable;

/// Everything an estimation needs; built once, then only read.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The compiled model.
    pub model: Model,
    /// The recordings that the model is fitted to, one simulation each.
    pub segments: Vec<Segment>,
    /// Its parameters, shared by all segments or one for each.
    pub unknowns: Unknowns,
    /// How to estimate.
    pub options: Options,
    pub(crate) columns: Columns,
    /// By output: samples that have a value, over all segments.
    pub(crate) counts: Vec<usize>,
}

impl Problem {
    /// Lays out which parameters each output is differentiated by, and how many integration steps lie between samples.
    /// Unknowns must be laid out over these segments.
    pub fn new(
        model: Model,
        mut segments: Vec<Segment>,
        unknowns: Unknowns,
        options: Options,
    ) -> Self {
        let (theta, mut parameters) = (unknowns.start(), Vec::new());
        for (index, segment) in segments.iter_mut().enumerate() {
            unknowns.parameters(index, &theta, &mut parameters);
            segment.substeps = substeps::chosen(&model, segment, &parameters, &options);
        }
        let is_free = |parameter: &usize| {
            unknowns
                .all
                .iter()
                .any(|u| u.parameter == *parameter && !u.fixed)
        };
        let free: Vec<usize> = (0..model.parameters.len()).filter(is_free).collect();
        let columns = Columns::new(&model, &free);
        let counts = counts(model.outputs.len(), &segments);
        Self {
            model,
            segments,
            unknowns,
            options,
            columns,
            counts,
        }
    }

    /// What is too fast, at the start values, for the integration steps that are left to us to choose.
    pub fn too_stiff(&self) -> Option<TooStiff> {
        substeps::too_stiff(&self.model, &self.segments, &self.unknowns, &self.options)
    }

    /// Samples over all segments.
    pub fn samples(&self) -> usize {
        self.segments.iter().map(Segment::len).sum()
    }

    /// The name of an unknown: the parameter's, with the segment where each has its own.
    pub fn name(&self, place: usize) -> String {
        let unknown = self.unknowns.at(place);
        let name = &self.model.parameters[unknown.parameter].name;
        match unknown.segment {
            Some(segment) if self.segments.len() > 1 => {
                format!("{name}[{}]", self.segments[segment].label)
            }
            _ => name.clone(),
        }
    }

    /// As [`Self::name`], with the SI value of the unknown's unit.
    pub(crate) fn name_and_scale(&self, place: usize) -> (String, f64) {
        (self.name(place), self.unit(place).scale)
    }

    /// The parameter of the model at a place of θ.
    pub fn parameter(&self, place: usize) -> &ParameterInfo {
        &self.model.parameters[self.unknowns.at(place).parameter]
    }

    /// The unit of the unknown at a place of θ.
    pub fn unit(&self, place: usize) -> Unit {
        self.parameter(place).unit
    }

    /// θ in the parameters' own units.
    pub fn in_own_units(&self, theta: &[f64]) -> Vec<f64> {
        theta
            .iter()
            .enumerate()
            .map(|(place, &value)| self.unit(place).from_si(value))
            .collect()
    }
}

/// All parameters of the model for a segment, SI.
///
/// # Errors
/// An element of a path has a size that it cannot have.
pub(crate) fn set_parameters(
    problem: &Problem,
    segment: usize,
    theta: &[f64],
    parameters: &mut Vec<f64>,
) -> Result<(), Unusable> {
    (problem.unknowns).parameters(segment, theta, parameters);
    match path_out_of_bounds(&problem.model, &problem.segments[segment], parameters) {
        Some(place) => Err(Unusable::Path { segment, place }),
        None => Ok(()),
    }
}
