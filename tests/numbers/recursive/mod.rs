//! Estimates in flight: against an independent computation, against batches, against known truth.

mod batches;
mod changes;
mod filter;
mod independent;
mod refusals;

use std::ops::ControlFlow;
use std::sync::Arc;

use serde_json::{Value, json};
use trimtab_core::estimate::Estimate;
use trimtab_core::flight::Maneuver;
use trimtab_core::ingest::{Format, Limits, read};
use trimtab_core::job::{self, Plan};
use trimtab_core::model::{Model, catalog};
use trimtab_core::recursive::{Estimates, Sample, SampleFault, Setup, Tracker, TrackingOptions};
use trimtab_core::simulate::{Scenario, Segment};

use crate::common::plans::plan;

const NAMES: [&str; 6] = ["Za", "Zq", "Zde", "Ma", "Mq", "Mde"];

fn recorded() -> Arc<Maneuver> {
    let text = include_bytes!("../../../data/elevator.csv");
    Arc::new(read(text, Format::Csv, &Limits::default()).expect("a recording"))
}

/// data/elevator.toml or another, flown with a seed.
fn flown(scenario: &str, seed: u64) -> Arc<Maneuver> {
    let scenario: Scenario = toml::from_str(scenario).expect("a scenario");
    let document = catalog::find(&scenario.model).expect("a catalog model");
    let model = Model::compile(&document).expect("a model");
    let maneuver = Scenario { seed, ..scenario }.fly(&model);
    Arc::new(maneuver.expect("a maneuver"))
}

fn options(value: Value) -> TrackingOptions {
    serde_json::from_value(value).expect("options")
}

fn tracker(plan: &Plan, asked: Value) -> Tracker {
    let setup = Setup::of_problem(&plan.problem).expect("a segment");
    Tracker::new(&setup, &options(asked)).unwrap_or_else(|faults| panic!("{faults}"))
}

fn push<'t>(
    tracker: &'t mut Tracker,
    segment: &Segment,
    k: usize,
) -> Result<&'t Estimates, SampleFault> {
    let at =
        |series: &Vec<Vec<f64>>| -> Vec<f64> { series.iter().map(|values| values[k]).collect() };
    let (inputs, outputs) = (at(&segment.inputs), at(&segment.measured));
    tracker.push(&Sample {
        time: segment.time[k],
        inputs: &inputs,
        outputs: &outputs,
    })
}

/// After all samples of a plan's first segment.
fn tracked(plan: &Plan, asked: Value) -> (Tracker, Estimates) {
    let mut tracker = tracker(plan, asked);
    let segment = &plan.problem.segments[0];
    for k in 0..segment.len() {
        push(&mut tracker, segment, k).expect("a sample");
    }
    let found = tracker.finish().clone();
    (tracker, found)
}

fn place(tracker: &Tracker, name: &str) -> usize {
    let mut all = tracker.parameters().iter();
    all.position(|parameter| parameter.name == name)
        .expect("it is followed")
}

fn elevator(maneuver: Arc<Maneuver>, changes: Value) -> Plan {
    plan(json!("short-period"), changes, &[maneuver])
}

/// The start values of the filter in tests/python/recursive.py, and its other settings.
fn known_starts() -> Value {
    json!({"parameters": {"alpha_eq": {"start": 0.06}, "de_eq": {"start": -0.02}, "alpha_0": {"start": 0.06}}})
}

fn filter_options() -> Value {
    let deg = std::f64::consts::PI / 180.0;
    json!({"method": "ekf", "noise": {"alpha": 0.05 * deg, "q": 0.08 * deg}, "uncertainty": {"q_bias": 0.005}})
}

fn with(mut value: Value, more: Value) -> Value {
    for (key, own) in more.as_object().expect("an object") {
        value[key] = own.clone();
    }
    value
}

fn batch(plan: &Plan) -> Estimate {
    let result = job::run(plan, &mut |_| ControlFlow::Continue(()));
    result.unwrap_or_else(|faults| panic!("{faults}")).estimate
}

/// A normal number of a place (Box and Muller, of a hash).
fn normal(place: u64) -> f64 {
    let uniform = |salt: u64| {
        let mut z = (place ^ salt).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (a, b) = (uniform(0x51ED).max(1e-300), uniform(0xC0FFEE_u64 << 24));
    (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
}
