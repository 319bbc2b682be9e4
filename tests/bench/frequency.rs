//! Times of estimations in the frequency domain, beside output error in the time domain: the problems P1 and P2 of the
//! performance peers over a band from 0.1 Hz to 1.5 Hz.
//!
//! `cargo bench --bench frequency` needs the flight data.

#[path = "../common"]
#[allow(dead_code)] // the tests use the rest
mod common {
    pub(crate) mod flight_data;
    pub(crate) mod recordings;
    pub(crate) mod repository;
}

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::{Duration, Instant};

use common::{flight_data, recordings};
use serde_json::{Value, json};
use trimtab_core::flight::Maneuver;
use trimtab_core::job::{self, JobSpec, Plan};
use trimtab_core::model::ModelDocument;

fn plan(model: &str, recording: &Arc<Maneuver>, changes: &Value, options: Value) -> Plan {
    let document: ModelDocument = toml::from_str(model).expect("a document");
    let mut spec = json!({
        "model": "in the file", "options": options,
        "maneuvers": [{"id": recording.digest(), "gaps": "join"}],
    });
    for (key, value) in changes.as_object().expect("an object") {
        spec[key] = value.clone();
    }
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    job::prepare(&spec, &document, std::slice::from_ref(recording))
        .unwrap_or_else(|f| panic!("{f:#?}"))
}

/// Least and median of repeated runs of a plan.
fn timed(plan: &Plan) -> (Duration, Duration, usize) {
    let mut times = Vec::new();
    let mut iterations = 0;
    let began = Instant::now();
    while times.len() < 5 || began.elapsed() < Duration::from_secs(1) {
        let start = Instant::now();
        let result = job::run(plan, &mut |_| ControlFlow::Continue(()));
        times.push(start.elapsed());
        iterations = result
            .unwrap_or_else(|f| panic!("{f:#?}"))
            .estimate
            .iterations;
    }
    times.sort();
    (times[0], times[times.len() / 2], iterations)
}

fn main() {
    let Some(directory) = flight_data::directory("the frequency bench") else {
        return;
    };
    let read =
        |file: &str| recordings::maneuver(&std::fs::read(directory.join(file)).expect("a file"));
    let problems = [
        (
            "P1",
            include_str!("../../src/core/model/catalog/short-period.toml"),
            read("attas_elv1.csv"),
            json!({}),
        ),
        (
            "P2",
            include_str!("../../src/core/model/catalog/lateral-directional-2.toml"),
            read("attas_ailrud1.csv"),
            json!({"channels": {"da": "(da_right - da_left)/2"}}),
        ),
    ];
    println!(
        "{:3} {:26} {:13} {:>10} {:>10} {:>10}",
        "", "estimator", "error bounds", "least, ms", "median, ms", "iterations"
    );
    for (name, model, recording, changes) in &problems {
        for estimator in [
            "output_error_frequency",
            "equation_error_frequency",
            "output_error",
        ] {
            for bounds in ["conventional", "corrected"] {
                let mut options = json!({"estimator": estimator, "error_bounds": bounds});
                if estimator != "output_error" {
                    options["frequency"] = json!({"band_hz": [0.1, 1.5]});
                }
                let (least, median, iterations) = timed(&plan(model, recording, changes, options));
                let ms = |time: Duration| time.as_secs_f64() * 1e3;
                println!(
                    "{name:3} {estimator:26} {bounds:13} {:10.3} {:10.3} {iterations:10}",
                    ms(least),
                    ms(median)
                );
            }
        }
    }
}
