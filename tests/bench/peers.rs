//! The problems P1 to P4 of the performance peers, one JSON line each with the peers' keys.
//!
//! `cargo bench --bench peers` needs the flight data; see the README for running the peers beside it. P3 is simulated
//! by the peers: `TRIMTAB_PEER_PROBLEMS` names the folder that their `export_problems.py --out` has written. Names of
//! problems as arguments restrict the run.

#[path = "../common/flight_data.rs"]
mod flight_data;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use indexmap::IndexMap;
use serde_json::{Value, json};
use trimtab::estimate::{Evaluator, NormalEquations};
use trimtab::flight::{Channel, Maneuver, Unit};
use trimtab::ingest;
use trimtab::job::{self, JobSpec, Plan};
use trimtab::model::ModelDocument;

struct Problem {
    name: &'static str,
    file: &'static str,
    model: &'static str,
    spec: Value,
}

fn problems() -> [Problem; 4] {
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
            name: "P3",
            file: "P3.csv",
            model: include_str!("flight-path-reconstruction.toml"),
            spec: json!({}),
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

/// Time that this process has spent on a processor, where the system tells.
fn processor_time() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/self/schedstat").ok()?;
    text.split(' ')
        .next()?
        .parse()
        .ok()
        .map(Duration::from_nanos)
}

/// Times of repeated calls, ms: least and median wall time, mean time on the processor. The last is what tells on a
/// machine that others load.
struct Times {
    least: f64,
    median: f64,
    processor: Option<f64>,
}

fn timed(mut call: impl FnMut()) -> Times {
    let mut times: Vec<Duration> = Vec::new();
    let processor = processor_time();
    let began = Instant::now();
    while times.len() < 5 || (began.elapsed() < Duration::from_millis(1500) && times.len() < 2000) {
        let start = Instant::now();
        call();
        times.push(start.elapsed());
    }
    let spent = processor_time()
        .zip(processor)
        .map(|(now, then)| now - then);
    times.sort();
    let ms = |time: Duration| time.as_secs_f64() * 1e3;
    Times {
        least: ms(times[0]),
        median: ms(times[times.len() / 2]),
        processor: spent.map(|spent| ms(spent) / times.len() as f64),
    }
}

fn solve(plan: &Plan) -> trimtab::estimate::Estimate {
    job::run(plan, &mut |_| ControlFlow::Continue(()))
        .unwrap_or_else(|faults| panic!("{faults:#?}"))
        .estimate
}

fn measure(problem: &Problem, directory: &Path) -> Value {
    let recording = Arc::new(recording(problem, directory));
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
    let mut put = |key: &str, times: &Times| {
        line[format!("{key}_ms_min")] = json!(times.least);
        line[format!("{key}_ms_median")] = json!(times.median);
        line[format!("{key}_ms_cpu_mean")] = json!(times.processor);
    };
    let theta = plan.problem.unknowns.start();
    let mut evaluator = Evaluator::new(&plan.problem);
    let evaluation = timed(|| {
        NormalEquations::at(&mut evaluator, &theta).expect("a bounded simulation");
    });
    put("eval", &evaluation);
    put("normal", &evaluation);
    for (share, suffix) in [(1e-4, ""), (1e-8, "_1e-08")] {
        let plan = prepare(problem, &recording, tolerance(share));
        put(
            &format!("solve{suffix}"),
            &timed(|| {
                solve(&plan);
            }),
        );
    }
    // from the model's text to the estimate, the recording being in memory
    put(
        "text_to_estimate",
        &timed(|| {
            solve(&prepare(problem, &recording, tolerance(1e-8)));
        }),
    );
    let compile = timed(|| {
        prepare(problem, &recording, 1.0);
    });
    line["compile_s"] = json!(compile.median / 1e3);
    line["compile_cpu_s"] = json!(compile.median / 1e3);
    // machine code is made once for each model, when its steps have taken as long
    let mut native: Vec<Duration> = (0..20)
        .map(|_| {
            let plan = prepare(problem, &recording, 1.0);
            let start = Instant::now();
            plan.problem.model.make_native();
            start.elapsed()
        })
        .collect();
    native.sort();
    line["native_s"] = json!(native[native.len() / 2].as_secs_f64());
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

/// The recording of a problem, with the start values that it comes with.
fn recording(problem: &Problem, directory: &Path) -> Maneuver {
    let bytes = std::fs::read(directory.join(problem.file)).expect("a data file");
    if problem.name != "P3" {
        return ingest::read(&bytes, ingest::Format::Csv, &ingest::Limits::default())
            .expect("a recording");
    }
    // the peers' own files: maneuver, t, inputs u_*, outputs z_*, all SI
    let document: ModelDocument = toml::from_str(problem.model).expect("a document");
    let mut reader = csv::Reader::from_reader(bytes.as_slice());
    let names: Vec<String> = reader
        .headers()
        .expect("a header")
        .iter()
        .map(str::to_string)
        .collect();
    let mut columns = vec![Vec::new(); names.len()];
    for row in reader.records() {
        for (column, cell) in columns.iter_mut().zip(&row.expect("a row")) {
            column.push(cell.parse::<f64>().expect("a number"));
        }
    }
    let mut channels = IndexMap::new();
    for (name, values) in names.iter().zip(&columns).skip(2) {
        let name = &name[2..];
        let unit = match (document.inputs.get(name), document.outputs.get(name)) {
            (Some(input), _) => &input.unit,
            (_, Some(output)) => &output.unit,
            _ => panic!("the model has no {name}"),
        };
        let unit = (unit, Unit::parse(unit).expect("a unit"));
        channels.insert(
            name.to_string(),
            Channel::from_recorded(unit.0, unit.1, values.clone()),
        );
    }
    Maneuver::new(columns[1].clone(), channels).expect("a maneuver")
}

/// The start values of P3 that the peers read off the records, as the parameters of a job.
fn start_values(directory: &Path) -> Value {
    let text = std::fs::read_to_string(directory.join("P3.json")).expect("P3.json");
    let exported: Value = serde_json::from_str(&text).expect("JSON");
    let list = |key: &str| exported[key].as_array().expect("a list").clone();
    let pairs = list("names").into_iter().zip(list("theta0"));
    let start = |(name, value): (Value, Value)| {
        (
            name.as_str().expect("a name").to_string(),
            json!({"start": value}),
        )
    };
    json!({"parameters": Value::Object(pairs.map(start).collect())})
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
    let wanted: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a.starts_with('P'))
        .collect();
    let flight = flight_data::directory("bench peers");
    let exported = std::env::var_os("TRIMTAB_PEER_PROBLEMS").map(PathBuf::from);
    for mut problem in problems() {
        if !wanted.is_empty() && !wanted.iter().any(|name| name == problem.name) {
            continue;
        }
        let directory = if problem.name == "P3" {
            &exported
        } else {
            &flight
        };
        let Some(directory) = directory else {
            eprintln!("SKIPPED {}: no data", problem.name);
            continue;
        };
        if problem.name == "P3" {
            problem.spec = start_values(directory);
        }
        println!("{}", measure(&problem, directory));
    }
}
