//! Confidence intervals by refits: how often they contain the truth, and how long they take.
//!
//! `cargo bench --bench intervals [-- SEEDS]` prints, for the bundled elevator maneuver with white and coloured noise, how
//! often the 95 % interval of each method contains the truth, and the standard deviations of bootstrap and Monte Carlo
//! beside the errors that were made. Then the time of a bootstrap of 1000 on P1 (`attas_elv1.csv` of the flight data) or,
//! without those, on the bundled maneuver, on all cores (`RAYON_NUM_THREADS`).

#[path = "../common"]
mod common {
    pub(crate) mod flight_data;
    pub(crate) mod repository;
}

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use indexmap::IndexMap;
use rayon::prelude::*;
use serde_json::{Value, json};
use trimtab_core::estimate::{ConfidenceIntervals, Estimate, IntervalMethod};
use trimtab_core::flight::Maneuver;
use trimtab_core::ingest;
use trimtab_core::job::{self, JobSpec};
use trimtab_core::model::{Model, ModelDocument, catalog};
use trimtab_core::simulate::{NoiseColour, Scenario};

use common::flight_data;

const ELEVATOR: &str = include_str!("../../data/elevator.toml");
const STEP: f64 = 0.04;

fn fit(document: &ModelDocument, spec: &Value, recording: Arc<Maneuver>) -> Estimate {
    let spec: JobSpec = serde_json::from_value(spec.clone()).expect("a spec");
    let plan = job::prepare(&spec, document, &[recording]).unwrap_or_else(|f| panic!("{f:#?}"));
    let result = job::run(&plan, &mut |_| ControlFlow::Continue(()));
    result.unwrap_or_else(|f| panic!("{f:#?}")).estimate
}

/// Of one method, over all seeds and parameters.
#[derive(Default)]
struct Row {
    inside: usize,
    of: usize,
    /// By parameter: mean standard deviation.
    deviations: IndexMap<String, Vec<f64>>,
    widths: IndexMap<String, Vec<f64>>,
}

fn coverage(name: &str, colour: NoiseColour, seeds: u64) {
    let mut scenario: Scenario = toml::from_str(ELEVATOR).expect("a scenario");
    for output in scenario.outputs.values_mut() {
        output.colour = colour;
    }
    let document = catalog::find("short-period").expect("a catalog model");
    let model = Model::compile(&document).expect("a model");
    let spec = json!({
        "model": "short-period", "maneuvers": [{"id": "x"}],
        "parameters": {"alpha_0": {"start": scenario.truth["alpha_0"]}},
        "options": {"confidence_intervals": {"bootstrap": 400, "monte_carlo": 400}},
    });
    let begun = Instant::now();
    let all: Vec<(Estimate, ConfidenceIntervals)> = (1..=seeds)
        .into_par_iter()
        .map(|seed| {
            let scenario = Scenario {
                seed,
                ..scenario.clone()
            };
            let flown = scenario.fly(&model).expect("a maneuver");
            let estimate = fit(&document, &spec, Arc::new(flown));
            let found = estimate.confidence_intervals.clone().expect("intervals");
            (estimate, found)
        })
        .collect();
    let mut rows: IndexMap<&str, Row> = IndexMap::new();
    let mut errors: IndexMap<String, Vec<f64>> = IndexMap::new();
    let (mut failed, mut blocks) = (0, Vec::new());
    for (_, found) in &all {
        failed += found.bootstrap.map_or(0, |made| made.failed);
        failed += found.monte_carlo.map_or(0, |made| made.failed);
        blocks.extend(found.bootstrap.map(|made| made.block as f64));
        for parameter in &found.parameters {
            let truth = scenario.truth[&parameter.name];
            let error = parameter.estimate - truth;
            errors
                .entry(parameter.name.clone())
                .or_default()
                .push(error);
            for interval in &parameter.intervals {
                let row = rows.entry(interval.method.name()).or_default();
                let above = interval.lower.is_none_or(|lower| lower <= truth);
                let below = interval.upper.is_none_or(|upper| truth <= upper);
                row.inside += usize::from(above && below);
                row.of += 1;
                if let Some(deviation) = interval.standard_deviation {
                    let to = row.deviations.entry(parameter.name.clone()).or_default();
                    to.push(deviation);
                }
                if let (Some(lower), Some(upper)) = (interval.lower, interval.upper) {
                    let to = row.widths.entry(parameter.name.clone()).or_default();
                    to.push(upper - lower);
                }
            }
        }
    }
    println!(
        "\n{name}: {seeds} seeds, {} parameters, blocks of {:.1} samples in the mean, {failed} refits failed ({:.1?})",
        errors.len(),
        mean(&blocks),
        begun.elapsed()
    );
    println!(
        "{:18} {:>9} {:>30}",
        "method", "coverage", "s.d. or width/3.92 by scatter"
    );
    for (method, row) in &rows {
        let ratio = errors.iter().map(|(name, errors)| {
            let scatter = deviation(errors);
            match row.deviations.get(name) {
                Some(found) => mean(found) / scatter,
                None => row
                    .widths
                    .get(name)
                    .map_or(f64::NAN, |w| mean(w) / 3.92 / scatter),
            }
        });
        let ratios: Vec<f64> = ratio.collect();
        let share = 100.0 * row.inside as f64 / row.of as f64;
        println!(
            "{method:18} {share:8.1}% {:>14.2} (mean over parameters)",
            mean(&ratios)
        );
    }
    // the same recordings: bootstrap beside corrected bound
    let both: Vec<f64> = (all.iter().flat_map(|(_, found)| &found.parameters))
        .filter_map(|parameter| {
            let of = |method| {
                let mut all = parameter.intervals.iter();
                all.find(|i| i.method == method)?.standard_deviation
            };
            Some(of(IntervalMethod::Bootstrap)? / of(IntervalMethod::Corrected)?)
        })
        .collect();
    println!(
        "bootstrap s.d. over corrected bound: {:.3} ± {:.3}",
        mean(&both),
        deviation(&both)
    );
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn deviation(values: &[f64]) -> f64 {
    let middle = mean(values);
    let squares: f64 = values.iter().map(|value| (value - middle).powi(2)).sum();
    (squares / (values.len() as f64 - 1.0)).sqrt()
}

/// A bootstrap of 1000 by itself, and the fit before it.
fn timed() {
    let document = catalog::find("short-period").expect("a catalog model");
    let (name, recording) = match flight_data::directory("the bench") {
        Some(folder) => {
            let bytes = std::fs::read(folder.join("attas_elv1.csv")).expect("a recording");
            let limits = ingest::Limits::default();
            let read = ingest::read(&bytes, ingest::Format::Csv, &limits);
            (
                "P1 (attas_elv1.csv)",
                read.unwrap_or_else(|f| panic!("{f:#?}")),
            )
        }
        None => {
            let scenario: Scenario = toml::from_str(ELEVATOR).expect("a scenario");
            let model = Model::compile(&document).expect("a model");
            (
                "the bundled elevator maneuver",
                scenario.fly(&model).expect("a maneuver"),
            )
        }
    };
    let recording = Arc::new(recording);
    let spec = |intervals: Value| {
        let options = json!({"confidence_intervals": intervals});
        json!({"model": "short-period", "maneuvers": [{"id": "x", "gaps": "join"}], "options": options})
    };
    let least = |intervals: Value| {
        let once = |_| {
            let begun = Instant::now();
            fit(&document, &spec(intervals.clone()), recording.clone());
            begun.elapsed().as_secs_f64()
        };
        (0..5).map(once).fold(f64::INFINITY, f64::min)
    };
    let alone = least(Value::Null);
    let with = |intervals: Value| least(intervals) - alone;
    println!(
        "\n{name}, {} rows, {} threads, least of 5: fit {alone:.4} s; and beyond it",
        recording.time().len(),
        rayon::current_num_threads()
    );
    let none = json!({"bootstrap": 0, "profile": false, "monte_carlo": 0});
    for (what, changes) in [
        ("bootstrap of 1000", json!({"bootstrap": 1000})),
        (
            "bootstrap of 1000, blocks of 25",
            json!({"bootstrap": 1000, "block": 25}),
        ),
        ("profile of all parameters", json!({"profile": true})),
        ("Monte Carlo of 1000", json!({"monte_carlo": 1000})),
    ] {
        let mut asked = none.clone();
        for (key, value) in changes.as_object().expect("an object") {
            asked[key] = value.clone();
        }
        println!("{what:32} {:.3} s", with(asked));
    }
}

fn main() {
    let mut numbers = std::env::args().filter_map(|argument| argument.parse().ok());
    let seeds: u64 = numbers.next().unwrap_or(200);
    timed();
    // correlation of neighbouring samples: exp(-step/time)
    let first_order = |lag_one: f64| NoiseColour::FirstOrder {
        correlation_time: -STEP / lag_one.ln(),
    };
    coverage("white noise", NoiseColour::White, seeds);
    for lag_one in [0.8, 0.95] {
        let name = format!("first-order noise, lag 1 {lag_one}");
        coverage(&name, first_order(lag_one), seeds);
    }
}
