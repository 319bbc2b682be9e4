//! The model that is followed, with its parameters.

use crate::estimate::Problem;
use crate::flight::{Fault, Faults, escape};
use crate::model::{Model, Start};
use crate::simulate::{InputInterpolation, Integrator};

/// A model and what its parameters begin with.
#[derive(Clone, Debug)]
pub struct Setup {
    /// Compiled.
    pub model: Model,
    /// By parameter of the model: start value, or the value of one that is held, SI.
    pub start: Vec<f64>,
    /// By parameter: whether it is to be estimated.
    pub free: Vec<bool>,
    /// By parameter: whether its start is to be read off data that are not there yet.
    pub(super) unread: Vec<bool>,
    /// What inputs do between samples.
    pub input_interpolation: InputInterpolation,
    /// How an `ekf` steps.
    pub integrator: Integrator,
}

impl Setup {
    /// The first segment of a problem: its model, start values and what is free in it. `None` where there is no segment.
    pub fn of_problem(problem: &Problem) -> Option<Self> {
        problem.segments.first()?;
        let (model, unknowns) = (problem.model.clone(), &problem.unknowns);
        let mut start = Vec::new();
        unknowns.parameters(0, &unknowns.start(), &mut start);
        let free = (0..start.len()).map(|parameter| unknowns.place(0, parameter).is_some());
        Some(Self {
            free: free.collect(),
            unread: vec![false; start.len()],
            start,
            input_interpolation: problem.options.input_interpolation,
            integrator: problem.options.integrator,
            model,
        })
    }

    /// A model without data: start values that are read off a recording are not there.
    pub fn of_model(model: Model) -> Self {
        let number = |start: &Start| match start {
            Start::Value(value) => Some(*value),
            Start::FromData(_) => None,
        };
        let all = model.parameters.iter();
        let starts = all.map(|p| number(&p.document.start).map(|value| p.unit.to_si(value)));
        let starts: Vec<Option<f64>> = starts.collect();
        Self {
            start: starts.iter().map(|start| start.unwrap_or(0.0)).collect(),
            free: (model.parameters.iter())
                .map(|p| !p.document.fixed)
                .collect(),
            unread: starts.iter().map(Option::is_none).collect(),
            input_interpolation: InputInterpolation::default(),
            integrator: Integrator::default(),
            model,
        }
    }

    /// Refuses what no tracker can follow.
    pub(super) fn check(&self) -> Result<(), Faults> {
        let model = &self.model;
        let first = model.paths.elements().first();
        if let Some(at) = first {
            let (kind, names) = match model.paths.is_of_input(0) {
                true => ("inputs", &model.inputs),
                false => ("outputs", &model.outputs),
            };
            let (name, element) = (&names[at.signal].name, at.element.words());
            let message = format!(
                "{name} has a {element}, which a tracker cannot follow; take it out of the model"
            );
            let pointer = format!("/model/{kind}/{}/{}", escape(name), at.element.field());
            return Err(Fault::new(pointer, "not_trackable", message).into());
        }
        Ok(())
    }

    /// A parameter whose start is needed and not there.
    pub(super) fn no_start(&self, parameter: usize) -> Fault {
        let name = &self.model.parameters[parameter].name;
        let message = format!(
            "{name} starts from a value that is read off a recording, and there is none yet; give it a number"
        );
        Fault::new(
            format!("/parameters/{}/start", escape(name)),
            "no_start_value",
            message,
        )
    }
}
