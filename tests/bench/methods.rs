//! Levenberg-Marquardt beside Gauss-Newton: iterations from the published cases' own starts, and from random ones.
//!
//! `cargo bench --bench methods [starts] [problem]` needs the flight data. P1, P2 and P4 are the peers' problems, P3 is the
//! simulated flight path of the tests. A random start has each unknown drawn evenly from [0, 2] times the estimate.

#[path = "../common"]
#[allow(dead_code)] // the tests use the rest
mod common {
    pub(crate) mod flight_data;
    pub(crate) mod preprocessing;
    pub(crate) mod published_cases;
    pub(crate) mod reconstruction;
    pub(crate) mod recordings;
    pub(crate) mod repository;
}

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use common::{flight_data, published_cases, reconstruction, recordings};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use trimtab_core::estimate::{Estimate, Method, Outcome, Problem, output_error};
use trimtab_core::flight::Maneuver;
use trimtab_core::job::{self, JobSpec};
use trimtab_core::model::ModelDocument;

const CASES: [&str; 9] = [
    "TC01",
    "TC03_ailrud1",
    "TC04",
    "TC11_elv1",
    "TC22",
    "TC22_x0free",
    "TC27_qst01",
    "TC32",
    "TC33",
];
const MOST_ITERATIONS: usize = 700;

fn prepared(document: &ModelDocument, maneuvers: &[Arc<Maneuver>], changes: &Value) -> Problem {
    let uses = maneuvers
        .iter()
        .map(|maneuver| json!({"id": maneuver.digest(), "gaps": "join"}));
    let mut spec = json!({
        "model": "given", "maneuvers": uses.collect::<Vec<Value>>(),
        "options": {"error_bounds": "conventional", "steps_per_sample": 1, "max_iterations": MOST_ITERATIONS},
    });
    for (key, value) in changes.as_object().expect("an object") {
        spec[key] = value.clone();
    }
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    let plan = job::prepare(&spec, document, maneuvers);
    plan.unwrap_or_else(|faults| panic!("{faults:#?}")).problem
}

fn published(directory: &Path, name: &str) -> Problem {
    let case = published_cases::read(directory, name);
    let document: ModelDocument = serde_json::from_value(case.model).expect("a document");
    let maneuvers: Vec<Arc<Maneuver>> = case
        .segments
        .iter()
        .map(|(text, _)| recordings::maneuver(text.as_bytes()))
        .collect();
    let uses = maneuvers.iter().zip(&case.segments).enumerate();
    let uses: Vec<Value> = uses
        .map(|(i, (maneuver, (_, rows)))| {
            json!({"id": maneuver.digest(), "rows": rows, "gaps": "join", "label": (i + 1).to_string()})
        })
        .collect();
    prepared(
        &document,
        &maneuvers,
        &json!({"channels": case.channels, "maneuvers": uses}),
    )
}

fn peers(directory: &Path, name: &str) -> Problem {
    let start = |value: f64| json!({"start": value});
    let read =
        |file: &str| recordings::maneuver(&std::fs::read(directory.join(file)).expect("a file"));
    let document = |text: &str| toml::from_str::<ModelDocument>(text).expect("a document");
    match name {
        "P1" => prepared(
            &document(include_str!(
                "../../src/core/model/catalog/short-period.toml"
            )),
            &[read("attas_elv1.csv")],
            &json!({}),
        ),
        "P2" => prepared(
            &document(include_str!(
                "../../src/core/model/catalog/lateral-directional-2.toml"
            )),
            &[read("attas_ailrud1.csv")],
            &json!({
                "channels": {"da": "(da_right - da_left)/2"},
                "parameters": {
                    "Lp": start(-3.5), "Lr": start(0.5), "Lda": start(-5.0), "Ldr": start(0.7), "Lb": start(-4.3),
                    "Np": start(-0.09), "Nr": start(-0.17), "Nda": start(-0.19), "Ndr": start(-0.75), "Nb": start(1.55),
                    "Yp": start(0.04), "Yr": start(2.1), "Yda": start(0.7), "Ydr": start(2.3), "Yb": start(-5.2),
                },
            }),
        ),
        "P3" => {
            let recording = reconstruction::Truth::new().recording(1, 1.0);
            prepared(&reconstruction::document(), &[recording], &json!({}))
        }
        _ => prepared(
            &document(include_str!("hfb320.toml")),
            &[read("hfb320_1_10.csv")],
            &json!({}),
        ),
    }
}

fn solved(problem: &Problem, method: Method) -> Option<Estimate> {
    let mut problem = problem.clone();
    problem.options.method = method;
    output_error(&problem, &mut |_| ControlFlow::Continue(()))
        .ok()
        .map(|solution| solution.estimate)
}

fn at(problem: &Problem, theta: &[f64]) -> Problem {
    let mut problem = problem.clone();
    for (place, &value) in theta.iter().enumerate() {
        let index = problem.unknowns.free[place];
        let unknown = &mut problem.unknowns.all[index];
        unknown.start = value.clamp(unknown.lower, unknown.upper);
    }
    problem
}

const BOTH: [Method; 2] = [Method::LevenbergMarquardt, Method::GaussNewton];

fn compare_random(name: &str, problem: &Problem, starts: usize) {
    let reference = output_error(problem, &mut |_| ControlFlow::Continue(())).expect("a reference");
    let theta = reference.theta.clone();
    let next = AtomicUsize::new(0);
    let some = || {
        let mut found = Vec::new();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= starts {
                return found;
            }
            let mut random = ChaCha8Rng::seed_from_u64(number as u64);
            let drawn: Vec<f64> = theta
                .iter()
                .map(|value| value * random.random_range(0.0..=2.0))
                .collect();
            let mut problem = at(problem, &drawn);
            problem.options.max_iterations = 200;
            found.push(BOTH.map(|method| solved(&problem, method)));
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut all: Vec<[Option<Estimate>; 2]> = Vec::new();
    std::thread::scope(|scope| {
        let running: Vec<_> = (0..threads).map(|_| scope.spawn(some)).collect();
        running
            .into_iter()
            .for_each(|thread| all.extend(thread.join().expect("a thread")));
    });
    let best = all
        .iter()
        .flatten()
        .flatten()
        .map(|e| e.cost)
        .fold(reference.estimate.cost, f64::min);
    let is_best = |e: &Option<Estimate>| e.as_ref().is_some_and(|e| e.cost < best + 0.01);
    let mut line = format!("{name}:");
    for (i, label) in ["LM", "GN"].into_iter().enumerate() {
        let ended = all.iter().filter(|pair| is_best(&pair[i])).count();
        let of = |outcome: Outcome| {
            all.iter()
                .filter(|p| p[i].as_ref().is_some_and(|e| e.outcome == outcome))
                .count()
        };
        line += &format!(
            " {label} best {ended}/{starts} budget {} stalled {} diverged {};",
            of(Outcome::Budget),
            of(Outcome::Stalled),
            of(Outcome::Diverged)
        );
    }
    // iterations of both methods, then looks of both
    let both: Vec<[usize; 4]> = all
        .iter()
        .filter(|pair| is_best(&pair[0]) && is_best(&pair[1]))
        .map(|pair| {
            let of = |i: usize| {
                pair[i]
                    .as_ref()
                    .map_or((0, 0), |e| (e.iterations, e.evaluations + e.simulations))
            };
            [of(0).0, of(1).0, of(0).1, of(1).1]
        })
        .collect();
    let median = |which: usize| {
        let mut values: Vec<usize> = both.iter().map(|efforts| efforts[which]).collect();
        values.sort_unstable();
        (
            values.get(values.len() / 2).copied(),
            values.last().copied(),
        )
    };
    let ratio = both
        .iter()
        .map(|[lm, gn, ..]| *lm as f64 / (*gn).max(1) as f64)
        .fold(0.0, f64::max);
    let above = both.iter().filter(|[lm, gn, ..]| *lm > 2 * gn).count();
    let budget_alone = all
        .iter()
        .filter(|p| p[0].as_ref().is_some_and(|e| e.outcome == Outcome::Budget))
        .filter(|p| p[1].as_ref().is_some_and(|e| e.outcome.is_minimum()))
        .count();
    println!(
        "{line} of both: median, most iterations LM {:?} GN {:?}, looks LM {:?} GN {:?}; largest ratio {ratio:.1}, above twice {above}; LM budget where GN converges {budget_alone}",
        median(0),
        median(1),
        median(2),
        median(3)
    );
}

fn main() {
    let Some(directory) = flight_data::directory("bench methods") else {
        return;
    };
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|w| !w.starts_with("--"))
        .collect();
    let starts = words
        .iter()
        .find_map(|word| word.parse().ok())
        .unwrap_or(1000);
    let chosen = |name: &str| {
        let names: Vec<&String> = words
            .iter()
            .filter(|w| w.parse::<usize>().is_err())
            .collect();
        names.is_empty() || names.iter().any(|word| name == word.as_str())
    };
    for name in CASES.into_iter().filter(|name| chosen(name)) {
        let problem = published(&directory, name);
        let told = BOTH.map(|method| match solved(&problem, method) {
            Some(e) => format!(
                "{} ({} looks) {} at {:.4}",
                e.iterations,
                e.evaluations + e.simulations,
                e.outcome.name(),
                e.cost
            ),
            None => "cannot begin".to_string(),
        });
        println!(
            "{name}: Levenberg-Marquardt {}; Gauss-Newton {}",
            told[0], told[1]
        );
    }
    for name in ["P1", "P2", "P3", "P4"]
        .into_iter()
        .filter(|name| chosen(name))
    {
        compare_random(name, &peers(&directory, name), starts);
    }
}
