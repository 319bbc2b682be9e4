//! The flight that maneuvers are designed for: the model at its a priori values, ready to be looked at with any inputs.

use std::convert::Infallible;

use nalgebra::DMatrix;

use super::spec::DesignSpec;
use crate::estimate::{Evaluator, Noise, NormalEquations, Options, Problem, Unknowns, Unusable};
use crate::flight::{Fault, Faults, Unit, escape};
use crate::model::Model;
use crate::simulate::{NoiseColour, Outputs, Planned, Scenario, ScenarioError, Segment, Steps};

/// What is the same for all maneuvers of a plan.
pub(super) struct Flight {
    pub scenario: Scenario,
    pub problem: Problem,
    /// SI, all of the model.
    pub parameters: Vec<f64>,
    /// By input: the unit of the scenario.
    pub input_units: Vec<Unit>,
    /// By input: the deflection of the steady flight, SI.
    pub trim: Vec<f64>,
    /// By input: SI per second; infinite where there is none.
    pub rate_limits: Vec<f64>,
    /// By output: SI; infinite where there is none.
    pub response_limits: Vec<f64>,
}

/// A maneuver's inputs, and what comes of them.
pub(super) struct Flown {
    /// F of the free unknowns, by place.
    pub information: DMatrix<f64>,
    /// By output, then sample, SI.
    pub outputs: Vec<Vec<f64>>,
}

impl Flight {
    pub(super) fn of(spec: &DesignSpec, model: Model) -> Result<Self, Faults> {
        let mut faults = Vec::new();
        let scenario = spec.scenario.clone();
        check(&scenario, &mut faults);
        let unfit =
            |error: ScenarioError| Fault::new("/scenario", "bad_scenario", error.to_string());
        let planned = scenario.planned(&model).map_err(unfit)?;
        let noise = scenario.noise(&model).map_err(unfit)?;
        for (output, deviation) in model.outputs.iter().zip(&noise) {
            if !(*deviation > 0.0 && deviation.is_finite()) {
                let pointer = format!("/scenario/outputs/{}/noise", escape(&output.name));
                let message =
                    "the noise that is expected must be above 0: the bounds follow from it";
                faults.push(Fault::new(pointer, "bad_noise", message));
            }
        }
        let units = |planned: &Planned| -> Vec<Unit> {
            let units = planned.units.iter();
            units
                .map(|unit| Unit::parse(unit).unwrap_or(Unit::NONE))
                .collect()
        };
        let input_units = units(&planned);
        let names: Vec<&str> = model
            .inputs
            .iter()
            .map(|input| input.name.as_str())
            .collect();
        let rate_limits = limits(
            "rate_limits",
            &spec.rate_limits,
            &names,
            &input_units,
            &mut faults,
        );
        let outputs: Vec<&str> = model
            .outputs
            .iter()
            .map(|output| output.name.as_str())
            .collect();
        let recorded = |name: &&str| {
            let unit = scenario
                .outputs
                .get(*name)
                .map_or("", |output| output.unit.as_str());
            Unit::parse(unit).unwrap_or(Unit::NONE)
        };
        let output_units: Vec<Unit> = outputs.iter().map(recorded).collect();
        let response_limits = limits(
            "response_limits",
            &spec.response_limits,
            &outputs,
            &output_units,
            &mut faults,
        );
        if model.parameters.iter().all(|info| info.document.fixed) {
            let message = "the model has no free parameter: there is nothing to tell";
            faults.push(Fault::new("/scenario/model", "no_free_parameter", message));
        }
        if !faults.is_empty() {
            return Err(faults.into());
        }
        Ok(Self {
            trim: trims(&scenario, &model, &input_units, &planned),
            parameters: planned.parameters.clone(),
            problem: problem(model, planned, noise),
            scenario,
            input_units,
            rate_limits,
            response_limits,
        })
    }

    pub(super) fn model(&self) -> &Model {
        &self.problem.model
    }

    pub(super) fn input(&self, name: &str) -> Option<usize> {
        self.model()
            .inputs
            .iter()
            .position(|input| input.name == name)
    }

    /// Samples of all inputs where some are designed and the others do what the scenario says, SI, within their limits of rate.
    pub(super) fn inputs(&self, scenario: &Scenario) -> Result<Vec<Vec<f64>>, Fault> {
        let planned = scenario.planned(self.model());
        let planned = planned.map_err(|error| Fault::new("", "bad_design", error.to_string()))?;
        let step = self.scenario.step;
        let limits = self.trim.iter().zip(&self.rate_limits);
        let limited = |(samples, (trim, limit)): (Vec<f64>, (&f64, &f64))| {
            rate_limited(samples, *trim, limit * step)
        };
        Ok(planned
            .inputs
            .into_iter()
            .zip(limits)
            .map(limited)
            .collect())
    }

    /// Simulates the maneuver with sensitivities.
    pub(super) fn fly(&mut self, inputs: Vec<Vec<f64>>) -> Result<Flown, Unusable> {
        let outputs = self.respond(inputs)?;
        let theta = self.problem.unknowns.start();
        let equations = NormalEquations::at(&mut Evaluator::new(&self.problem), &theta)?;
        Ok(Flown {
            information: equations.information,
            outputs,
        })
    }

    /// Simulates the maneuver without sensitivities: outputs, SI.
    pub(super) fn respond(&mut self, inputs: Vec<Vec<f64>>) -> Result<Vec<Vec<f64>>, Unusable> {
        self.problem.segments[0].inputs = inputs;
        let (problem, options) = (&self.problem, &self.problem.options);
        let mut machine = Outputs::new(
            &problem.model,
            options.integrator,
            options.input_interpolation,
        );
        let mut outputs = vec![Vec::new(); problem.model.outputs.len()];
        let run = machine.run(&problem.segments[0], &self.parameters, |_, y| {
            let series = outputs.iter_mut().zip(y);
            series.for_each(|(series, y)| series.extend_from_slice(y));
        });
        match run {
            Ok(()) if outputs.iter().flatten().all(|y| y.is_finite()) => Ok(outputs),
            _ => Err(Unusable::NotFinite),
        }
    }

    /// By how much a response is larger than is allowed: 1 or less is within.
    pub(super) fn excess(&self, outputs: &[Vec<f64>]) -> f64 {
        let departures = outputs.iter().zip(&self.response_limits);
        departures
            .map(|(series, limit)| departure(series) / limit)
            .fold(0.0, f64::max)
    }
}

/// The largest distance from the first value.
pub(super) fn departure(series: &[f64]) -> f64 {
    let first = series.first().copied().unwrap_or_default();
    series.iter().map(|y| (y - first).abs()).fold(0.0, f64::max)
}

/// Follows the samples by no more than `most` from one to the next; one step before the first they are at trim.
fn rate_limited(mut samples: Vec<f64>, trim: f64, most: f64) -> Vec<f64> {
    if most.is_finite() {
        let mut before = trim;
        for sample in &mut samples {
            *sample = before + (*sample - before).clamp(-most, most);
            before = *sample;
        }
    }
    samples
}

/// What bounds of white noise leave no place for.
fn check(scenario: &Scenario, faults: &mut Vec<Fault>) {
    let mut refuse = |part: &str, message: &str| {
        faults.push(Fault::new(
            format!("/scenario/{part}"),
            "not_in_a_design",
            message,
        ));
    };
    if !scenario.effects.is_empty() {
        refuse(
            "effects",
            "a maneuver is designed for the model as it is: leave effects out, or edit the model",
        );
    }
    if !scenario.process_noise.is_empty() {
        refuse(
            "process_noise",
            "bounds are predicted for calm air: leave process noise out",
        );
    }
    if scenario
        .outputs
        .values()
        .any(|output| output.colour != NoiseColour::White)
    {
        refuse(
            "outputs",
            "bounds are predicted for white noise: leave \"colour\" out",
        );
    }
}

/// SI by place; a name that is none of them is a fault.
fn limits(
    field: &str,
    given: &indexmap::IndexMap<String, f64>,
    names: &[&str],
    units: &[Unit],
    faults: &mut Vec<Fault>,
) -> Vec<f64> {
    let mut limits = vec![f64::INFINITY; names.len()];
    for (name, limit) in given {
        let pointer = format!("/{field}/{}", escape(name));
        let Some(place) = names.iter().position(|known| known == name) else {
            let message = format!(
                "the model has no '{name}' here; it has {}",
                names.join(", ")
            );
            faults.push(Fault::new(pointer, "unknown_symbol", message));
            continue;
        };
        if limit.is_nan() || *limit <= 0.0 {
            faults.push(Fault::new(pointer, "bad_value", "a limit is above 0"));
        }
        limits[place] = limit * units[place].scale;
    }
    limits
}

fn trims(scenario: &Scenario, model: &Model, units: &[Unit], planned: &Planned) -> Vec<f64> {
    let inputs = model.inputs.iter().zip(units).zip(&planned.inputs);
    inputs
        .map(
            |((input, unit), samples)| match scenario.inputs.get(&input.name) {
                Some(designed) => unit.to_si(designed.trim),
                None => samples.first().copied().unwrap_or_default(),
            },
        )
        .collect()
}

/// Output error with the noise that is expected, and without priors: bounds are of what maneuvers tell, and a prior would count once in each.
fn problem(mut model: Model, planned: Planned, noise: Vec<f64>) -> Problem {
    for info in &mut model.parameters {
        info.document.prior = None;
    }
    let start = |parameter: usize, _| Ok::<f64, Infallible>(planned.parameters[parameter]);
    let Ok(layout) = Unknowns::new(&model, 1, start);
    let samples = planned.time.len();
    let step = match planned.time.as_slice() {
        [first, second, ..] => second - first,
        _ => 1.0,
    };
    let segment = Segment {
        label: "plan".to_string(),
        time: planned.time,
        steps: Steps::Even(step),
        substeps: Default::default(),
        inputs: planned.inputs,
        measured: vec![vec![0.0; samples]; model.outputs.len()],
    };
    let variance = noise
        .iter()
        .map(|deviation| deviation * deviation)
        .collect();
    let options = Options {
        noise: Noise::Given { variance },
        ..Options::default()
    };
    Problem::new(model, vec![segment], layout, options)
}
