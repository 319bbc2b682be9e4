//! The problems P1, P2 and P4 of the performance peers, one JSON line each with the peers' keys.
//!
//! `cargo bench --bench peers` needs the flight data; see the README for running the peers beside it.

#[path = "../common/flight_data.rs"]
mod flight_data;

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use trimtab::estimate::{Evaluator, NormalEquations};
use trimtab::flight::Maneuver;
use trimtab::ingest;
use trimtab::job::{self, JobSpec, Plan};
use trimtab::model::ModelDocument;

struct Problem {
    name: &'static str,
    file: &'static str,
    model: &'static str,
    spec: Value,
}

fn problems() -> [Problem; 3] {
    let start = |value: f64| json!({"start": value});
    [
        Problem {
            name: "P1",
            file: "attas_elv1.csv",
            model: include_str!("../../src/model/catalog/short-period.toml"),
            spec: json!({}),
        },
        Problem {
            name: "P2",
            file: "attas_ailrud1.csv",
            model: include_str!("../../src/model/catalog/lateral-directional-2.toml"),
            spec: json!({
                "channels": {"da": "(da_right - da_left)/2"},
                "parameters": {
                    "Lp": start(-3.5), "Lr": start(0.5), "Lda": start(-5.0), "Ldr": start(0.7), "Lb": start(-4.3),
                    "Np": start(-0.09), "Nr": start(-0.17), "Nda": start(-0.19), "Ndr": start(-0.75), "Nb": start(1.55),
                    "Yp": start(0.04), "Yr": start(2.1), "Yda": start(0.7), "Ydr": start(2.3), "Yb": start(-5.2),
                },
            }),
        },
        Problem {
            name: "P4",
            file: "hfb320_1_10.csv",
            model: include_str!("hfb320.toml"),
            spec: json!({}),
        },
    ]
}

/// From the model's text to a problem ready to be evaluated.
fn prepare(problem: &Problem, recording: &Arc<Maneuver>, tolerance: f64) -> Plan {
    let document: ModelDocument = toml::from_str(problem.model).expect("a document");
    let mut spec = json!({
        "model": "in the file",
        "maneuvers": [{"id": "the recording", "gaps": "join"}],
        // the peers know the conventional error bounds only
        "options": {"tolerance": tolerance, "method": "gauss_newton", "error_bounds": "conventional", "start": {"kind": "document"}},
    });
    for (key, value) in problem.spec.as_object().expect("an object") {
        spec[key] = value.clone();
    }
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    job::prepare(&spec, &document, std::slice::from_ref(recording))
        .unwrap_or_else(|faults| panic!("{faults:#?}"))
}

/// Wall times of repeated calls, ms: least and median.
fn timed(mut call: impl FnMut()) -> (f64, f64) {
    let mut times: Vec<Duration> = Vec::new();
    let began = Instant::now();
    while times.len() < 5 || (began.elapsed() < Duration::from_millis(1500) && times.len() < 2000) {
        let start = Instant::now();
        call();
        times.push(start.elapsed());
    }
    times.sort();
    let ms = |time: Duration| time.as_secs_f64() * 1e3;
    (ms(times[0]), ms(times[times.len() / 2]))
}

fn solve(plan: &Plan) -> trimtab::estimate::Estimate {
    job::run(plan, &mut |_| ControlFlow::Continue(()))
        .unwrap_or_else(|faults| panic!("{faults:#?}"))
        .estimate
}

fn measure(problem: &Problem, directory: &Path) -> Value {
    let bytes = std::fs::read(directory.join(problem.file)).expect("a data file");
    let recording =
        ingest::read(&bytes, ingest::Format::Csv, &ingest::Limits::default()).expect("a recording");
    let recording = Arc::new(recording);
    let n = recording.len() as f64;
    // the peers stop when det R changes by less than a share: a step of d standard errors changes it by d²/N
    let tolerance = |share: f64| (share * n).sqrt();
    let plan = prepare(problem, &recording, tolerance(1e-8));
    let mut line = json!({
        "peer": "trimtab", "problem": problem.name, "threads": 1, "N": recording.len(), "M": 1,
        "n_theta": plan.problem.unknowns.len(), "nloc": plan.problem.unknowns.len(),
        "nx": plan.problem.model.states.len(), "ny": plan.problem.model.outputs.len(),
        "eval_includes_normal": true,
    });
    let mut put = |key: &str, (least, median): (f64, f64)| {
        line[format!("{key}_ms_min")] = json!(least);
        line[format!("{key}_ms_median")] = json!(median);
    };
    let theta = plan.problem.unknowns.start();
    let mut evaluator = Evaluator::new(&plan.problem);
    let evaluation = timed(|| {
        NormalEquations::at(&mut evaluator, &theta).expect("a bounded simulation");
    });
    put("eval", evaluation);
    put("normal", evaluation);
    for (share, suffix) in [(1e-4, ""), (1e-8, "_1e-08")] {
        let plan = prepare(problem, &recording, tolerance(share));
        put(
            &format!("solve{suffix}"),
            timed(|| {
                solve(&plan);
            }),
        );
    }
    // from the model's text to the estimate, the recording being in memory
    put(
        "text_to_estimate",
        timed(|| {
            solve(&prepare(problem, &recording, tolerance(1e-8)));
        }),
    );
    let compile = timed(|| {
        prepare(problem, &recording, 1.0);
    });
    line["compile_s"] = json!(compile.1 / 1e3);
    line["compile_cpu_s"] = json!(compile.1 / 1e3);
    for (share, suffix) in [(1e-4, ""), (1e-8, "_1e-08"), (1e-12, "_check")] {
        let plan = prepare(problem, &recording, tolerance(share));
        let estimate = solve(&plan);
        line[format!("iterations{suffix}")] = json!(estimate.iterations);
        line[format!("evals{suffix}")] = json!(estimate.evaluations);
        line[format!("sims{suffix}")] = json!(estimate.simulations);
        line[format!("converged{suffix}")] = json!(estimate.outcome.is_minimum());
        line[format!("cost{suffix}")] = json!(estimate.det_r);
        let free = || estimate.parameters.iter().filter(|p| !p.fixed);
        line[format!("theta{suffix}")] = json!(in_peer_order(
            problem,
            free().map(|p| (p.name.as_str(), p.estimate)).collect()
        ));
        let errors = free()
            .map(|p| (p.name.as_str(), p.standard_error.unwrap_or(f64::NAN)))
            .collect();
        line["sd"] = json!(in_peer_order(problem, errors));
    }
    line
}

/// The peers' P2 has its parameters in another order than the catalog's document.
fn in_peer_order(problem: &Problem, values: Vec<(&str, f64)>) -> Vec<f64> {
    let order = "Lp Lr Lda Ldr Lb Np Nr Nda Ndr Nb p_bias r_bias ay_bias Yp Yr Yda Ydr Yb";
    if problem.name != "P2" {
        return values.into_iter().map(|(_, value)| value).collect();
    }
    let find = |name| {
        values
            .iter()
            .find(|(own, _)| *own == name)
            .expect("a parameter")
            .1
    };
    order.split(' ').map(find).collect()
}

fn main() {
    let Some(directory) = flight_data::directory("bench peers") else {
        return;
    };
    for problem in problems() {
        println!("{}", measure(&problem, &directory));
    }
}
