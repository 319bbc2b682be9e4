//! Jobs run here and now, on maneuvers at hand.

use std::ops::ControlFlow;
use std::sync::Arc;

use serde_json::{Value, json};
use trimtab_core::flight::Maneuver;
use trimtab_core::job::{self, JobResult, JobSpec};
use trimtab_core::model::{Model, catalog};
use trimtab_core::simulate::Scenario;

use super::repository;

/// A scenario of `tests/numbers/catalog`.
pub(crate) fn scenario(name: &str) -> Scenario {
    let file = repository::path(&format!("tests/numbers/catalog/{name}.toml"));
    let text = std::fs::read_to_string(&file).expect("a scenario");
    toml::from_str(&text).unwrap_or_else(|error| panic!("{name}: {error}"))
}

pub(crate) fn compiled(name: &str) -> Model {
    let document = catalog::find(name).expect("a catalog model");
    Model::compile(&document).expect("a model")
}

pub(crate) fn fly(scenario: &Scenario) -> Arc<Maneuver> {
    let made = scenario.fly(&compiled(&scenario.model));
    Arc::new(made.unwrap_or_else(|error| panic!("{}: {error}", scenario.model)))
}

/// A job on a catalog model with `changes` in its spec.
pub(crate) fn solve(model: &str, maneuver: &Arc<Maneuver>, changes: &Value) -> JobResult {
    let mut spec =
        json!({"model": model, "maneuvers": [{"id": maneuver.digest(), "gaps": "join"}]});
    for (key, value) in changes.as_object().expect("an object") {
        spec[key] = value.clone();
    }
    solve_all(model, std::slice::from_ref(maneuver), &spec)
}

pub(crate) fn solve_all(model: &str, maneuvers: &[Arc<Maneuver>], spec: &Value) -> JobResult {
    let spec: JobSpec = serde_json::from_value(spec.clone()).expect("a spec");
    let document = catalog::find(model).expect("a catalog model");
    let plan = job::prepare(&spec, &document, maneuvers).unwrap_or_else(|f| panic!("{f:#?}"));
    job::run(&plan, &mut |_| ControlFlow::Continue(())).unwrap_or_else(|f| panic!("{f:#?}"))
}
