//! Recordings as the service reads them, and simulated ones of known truth.

use std::sync::Arc;

use trimtab_core::flight::Maneuver;
use trimtab_core::ingest::{self, Format, Limits};
use trimtab_core::model::{Model, catalog};
use trimtab_core::simulate::Scenario;

/// A recording as the service reads it.
pub(crate) fn maneuver(csv: &[u8]) -> Arc<Maneuver> {
    let read = ingest::read(csv, Format::Csv, &Limits::default());
    Arc::new(read.expect("a recording"))
}

/// The bundled elevator maneuver as CSV: 626 samples.
pub(crate) fn elevator() -> String {
    elevator_of(25.0, 20_261_121)
}

/// An elevator maneuver of that duration (25 samples a second) and noise.
pub(crate) fn elevator_of(duration: f64, seed: u64) -> String {
    let mut scenario: Scenario = toml::from_str(include_str!("../../data/elevator.toml")).unwrap();
    (scenario.duration, scenario.seed) = (duration, seed);
    let model = Model::compile(&catalog::find("short-period").unwrap()).unwrap();
    ingest::to_csv(&scenario.fly(&model).unwrap(), |_| true)
}
