//! Jobs prepared and run in the process, without a server.

use std::ops::ControlFlow;
use std::sync::Arc;

use indexmap::IndexMap;
use serde_json::{Value, json};
use trimtab_core::estimate::{Evaluator, NormalEquations, ParameterEstimate};
use trimtab_core::flight::{Channel, Maneuver, Unit};
use trimtab_core::job::{self, Faults, JobResult, JobSpec, ModelSource, Plan};
use trimtab_core::model::catalog;

/// A recording of pure numbers, on the time axis `time`.
pub(crate) fn recording(time: Vec<f64>, channels: &[(&str, Vec<f64>)]) -> Arc<Maneuver> {
    let channel = |(name, values): &(&str, Vec<f64>)| {
        let channel = Channel::from_recorded("-", Unit::NONE, values.clone());
        (name.to_string(), channel)
    };
    let channels: IndexMap<String, Channel> = channels.iter().map(channel).collect();
    Arc::new(Maneuver::new(time, channels).expect("a maneuver"))
}

/// A plan for a model, by catalog name or as a document, with `changes` in the spec.
pub(crate) fn try_plan(
    model: Value,
    changes: Value,
    maneuvers: &[Arc<Maneuver>],
) -> Result<Plan, Faults> {
    let uses: Vec<Value> = maneuvers
        .iter()
        .map(|maneuver| json!({"id": maneuver.digest()}))
        .collect();
    let mut spec = json!({"model": model, "maneuvers": uses});
    for (key, value) in changes.as_object().expect("an object") {
        spec[key] = value.clone();
    }
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    let document = match &spec.model {
        ModelSource::Document(document) => (**document).clone(),
        ModelSource::Reference(name) => catalog::find(name).expect("a catalog model"),
    };
    job::prepare(&spec, &document, maneuvers)
}

pub(crate) fn plan(model: Value, changes: Value, maneuvers: &[Arc<Maneuver>]) -> Plan {
    try_plan(model, changes, maneuvers).unwrap_or_else(|faults| panic!("{faults:#?}"))
}

pub(crate) fn solve(model: Value, changes: Value, maneuvers: &[Arc<Maneuver>]) -> JobResult {
    job::run(&plan(model, changes, maneuvers), &mut |_| {
        ControlFlow::Continue(())
    })
    .unwrap_or_else(|faults| panic!("{faults:#?}"))
}

pub(crate) fn parameter<'r>(result: &'r JobResult, name: &str) -> &'r ParameterEstimate {
    let mut all = result.estimate.parameters.iter();
    all.find(|p| p.name == name).expect("the parameter")
}

/// By unknown: how far the gradient at the start is from central differences of -ln L at ± `step`, relative to the
/// gradient's largest component.
pub(crate) fn gradient_errors(plan: &Plan, step: f64) -> Vec<f64> {
    let mut evaluator = Evaluator::new(&plan.problem);
    let theta = plan.problem.unknowns.start();
    let mut at = |theta: &[f64]| NormalEquations::at(&mut evaluator, theta).expect("a cost");
    let descent = at(&theta).descent;
    let error = |place: usize| {
        let mut cost = |change: f64| {
            let mut moved = theta.clone();
            moved[place] += change;
            at(&moved).cost()
        };
        let difference = (cost(step) - cost(-step)) / (2.0 * step);
        (difference + descent[place]).abs() / descent.amax()
    };
    (0..theta.len()).map(error).collect()
}

/// Numbers from -0.5 to 0.5 without structure.
pub(crate) fn scatter(k: usize, seed: f64) -> f64 {
    ((k as f64 * 12.9898 + seed).sin() * 43_758.547).fract() / 2.0
}
