//! Simulated recordings of known truth, and jobs on them.

use std::sync::Arc;

use serde_json::{Value, json};
use trimtab::flight::Maneuver;
use trimtab::ingest::{self, Format, Limits};
use trimtab::model::{Model, catalog};
use trimtab::simulate::Scenario;

/// A recording as the service reads it.
pub fn maneuver(csv: &[u8]) -> Arc<Maneuver> {
    let read = ingest::read(csv, Format::Csv, &Limits::default());
    Arc::new(read.expect("a recording"))
}

/// The bundled elevator maneuver as CSV: 626 samples.
pub fn elevator() -> String {
    elevator_of(25.0, 20_261_121)
}

/// An elevator maneuver of that duration (25 samples a second) and noise.
pub fn elevator_of(duration: f64, seed: u64) -> String {
    let mut scenario: Scenario = toml::from_str(include_str!("../../data/elevator.toml")).unwrap();
    (scenario.duration, scenario.seed) = (duration, seed);
    let model = Model::compile(&catalog::find("short-period").unwrap()).unwrap();
    ingest::to_csv(&scenario.fly(&model).unwrap(), |_| true)
}

/// A short-period job.
pub fn job(maneuver: &str) -> Value {
    json!({"model": "short-period", "maneuvers": [{"id": maneuver}]})
}

/// A job that never converges by its tolerance, with a technique that takes its time: with a long maneuver it runs until
/// it is stopped.
pub fn endless_job(maneuver: &str) -> Value {
    json!({
        "model": "short-period",
        "maneuvers": [{"id": maneuver}],
        "options": {
            "tolerance": 1e-300,
            "max_iterations": 1000,
            "derivatives": {"technique": "complex_step"},
        },
    })
}
