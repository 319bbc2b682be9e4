//! The problems P1 to P4 and P5b of the performance peers, one JSON line each with the peers' keys.
//!
//! `cargo bench --bench peers` needs the flight data; see `src/guide/development.md` for running the peers beside it. P3 and P5b are
//! simulated by the peers: `TRIMTAB_PEER_PROBLEMS` names the folder that their `export_problems.py --out` has written.
//! Names of problems as arguments restrict the run. One evaluation is by one thread; a solve of P5b, with its 50
//! maneuvers, by as many as there are cores (`RAYON_NUM_THREADS=1` for one).

#[path = "../common"]
mod common {
    pub(crate) mod flight_data;
    pub(crate) mod repository;
}

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use common::flight_data;
use indexmap::IndexMap;
use serde_json::{Value, json};
use trimtab_core::estimate::{Evaluator, NormalEquations};
use trimtab_core::flight::{Channel, Maneuver, Unit};
use trimtab_core::ingest;
use trimtab_core::job::{self, JobSpec, Plan};
use trimtab_core::model::ModelDocument;

struct Problem {
    name: &'static str,
    file: &'static str,
    model: String,
    spec: Value,
}

const FLIGHT_PATH: &str = include_str!("flight-path-reconstruction.toml");

/// What each maneuver of P5b has of its own.
const OWN: [&str; 12] = [
    "W_N", "W_E", "W_D", "u_0", "v_0", "w_0", "phi_0", "theta_0", "psi_0", "xE_0", "yE_0", "zE_0",
];

/// The model of P3 with wind and initial state for each maneuver, started from channels that say so.
fn flight_path_of_each() -> String {
    let line = |line: &str| {
        let (name, rest) = line.split_once(" = { start = ").unwrap_or((line, ""));
        match rest.split_once(',') {
            Some((_, rest)) if OWN.contains(&name) => {
                format!("{name} = {{ start = \"first(start_{name})\", per = \"maneuver\",{rest}\n")
            }
            _ => format!("{line}\n"),
        }
    };
    FLIGHT_PATH.lines().map(line).collect()
}

fn problems() -> [Problem; 5] {
    let start = |value: f64| json!({"start": value});
    [
        Problem {
            name: "P1",
            file: "attas_elv1.csv",
            model: include_str!("../../src/core/model/catalog/short-period.toml").into(),
            spec: json!({}),
        },
        Problem {
            name: "P2",
            file: "attas_ailrud1.csv",
            model: include_str!("../../src/core/model/catalog/lateral-directional-2.toml").into(),
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
            model: FLIGHT_PATH.into(),
            spec: json!({}),
        },
        Problem {
            name: "P4",
            file: "hfb320_1_10.csv",
            model: include_str!("hfb320.toml").into(),
            spec: json!({}),
        },
        Problem {
            name: "P5b",
            file: "P5b.csv",
            model: flight_path_of_each(),
            spec: json!({}),
        },
    ]
}

/// From the model's text to a problem ready to be evaluated.
fn prepare(problem: &Problem, recordings: &[Arc<Maneuver>], tolerance: f64) -> Plan {
    let document: ModelDocument = toml::from_str(&problem.model).expect("a document");
    let uses =
        (0..recordings.len()).map(|number| json!({"id": number.to_string(), "gaps": "join"}));
    let mut spec = json!({
        "model": "in the file",
        "maneuvers": uses.collect::<Vec<Value>>(),
        // the peers know the conventional error bounds only
        "options": {"tolerance": tolerance, "method": "gauss_newton", "error_bounds": "conventional", "start": {"kind": "document"}},
    });
    for (key, value) in problem.spec.as_object().expect("an object") {
        spec[key] = value.clone();
    }
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    job::prepare(&spec, &document, recordings).unwrap_or_else(|faults| panic!("{faults:#?}"))
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
    let enough = |times: usize, took: Duration| {
        let least = if took < Duration::from_secs(5) { 5 } else { 2 };
        times >= least && (took > Duration::from_millis(1500) || times >= 2000)
    };
    while !enough(times.len(), began.elapsed()) {
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

fn solve(plan: &Plan) -> trimtab_core::estimate::Estimate {
    job::run(plan, &mut |_| ControlFlow::Continue(()))
        .unwrap_or_else(|faults| panic!("{faults:#?}"))
        .estimate
}

fn measure(problem: &Problem, directory: &Path) -> Value {
    let recordings = recordings(problem, directory);
    let samples: usize = recordings.iter().map(|recording| recording.len()).sum();
    let n = samples as f64;
    // the peers stop when det R changes by less than a share: a step of d standard errors changes it by d²/N;
    // more than one is more than a job may ask for (P5b at 1e-4)
    let tolerance = |share: f64| (share * n).sqrt().min(1.0);
    let plan = prepare(problem, &recordings, tolerance(1e-8));
    let own = if recordings.len() > 1 { OWN.len() } else { 0 };
    let of_one = plan.problem.unknowns.len() - own * (recordings.len() - 1);
    let mut line = json!({
        "peer": "trimtab", "problem": problem.name, "threads": 1, "N": samples / recordings.len(), "M": recordings.len(),
        "n_theta": plan.problem.unknowns.len(), "nloc": of_one,
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
        let plan = prepare(problem, &recordings, tolerance(share));
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
            solve(&prepare(problem, &recordings, tolerance(1e-8)));
        }),
    );
    let compile = timed(|| {
        prepare(problem, &recordings, 1.0);
    });
    line["compile_s"] = json!(compile.median / 1e3);
    line["compile_cpu_s"] = json!(compile.median / 1e3);
    // machine code is made once for each model, when its steps have taken as long
    let mut native: Vec<Duration> = (0..20)
        .map(|_| {
            let plan = prepare(problem, &recordings, 1.0);
            let start = Instant::now();
            plan.problem.model.make_native();
            start.elapsed()
        })
        .collect();
    native.sort();
    line["native_s"] = json!(native[native.len() / 2].as_secs_f64());
    for (share, suffix) in [(1e-4, ""), (1e-8, "_1e-08"), (1e-12, "_check")] {
        let plan = prepare(problem, &recordings, tolerance(share));
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

/// The recordings of a problem.
fn recordings(problem: &Problem, directory: &Path) -> Vec<Arc<Maneuver>> {
    let bytes = std::fs::read(directory.join(problem.file)).expect("a data file");
    if !is_simulated(problem) {
        let read = ingest::read(&bytes, ingest::Format::Csv, &ingest::Limits::default());
        return vec![Arc::new(read.expect("a recording"))];
    }
    // the peers' own files: maneuver, t, inputs u_*, outputs z_*, all SI
    let document: ModelDocument = toml::from_str(&problem.model).expect("a document");
    let mut reader = csv::Reader::from_reader(bytes.as_slice());
    let names: Vec<String> = reader
        .headers()
        .expect("a header")
        .iter()
        .map(str::to_string)
        .collect();
    let mut maneuvers: Vec<Vec<Vec<f64>>> = Vec::new();
    for row in reader.records() {
        let row = row.expect("a row");
        let number: usize = row[0].parse().expect("a number");
        if number == maneuvers.len() {
            maneuvers.push(vec![Vec::new(); names.len()]);
        }
        for (column, cell) in maneuvers[number].iter_mut().zip(&row) {
            column.push(cell.parse::<f64>().expect("a number"));
        }
    }
    let starts = exported_starts(problem, directory);
    let channel = |unit: &str, values: Vec<f64>| {
        let parsed = Unit::parse(unit).expect("a unit");
        Channel::from_recorded(unit, parsed, values)
    };
    let maneuver = |(number, columns): (usize, Vec<Vec<f64>>)| {
        let mut channels = IndexMap::new();
        let length = columns[1].len();
        for (name, values) in names.iter().zip(&columns).skip(2) {
            let name = &name[2..];
            let unit = match (document.inputs.get(name), document.outputs.get(name)) {
                (Some(input), _) => &input.unit,
                (_, Some(output)) => &output.unit,
                _ => panic!("the model has no {name}"),
            };
            channels.insert(name.to_string(), channel(unit, values.clone()));
        }
        for name in OWN {
            if let Some(&start) = starts.get(&format!("{name}[{number}]")) {
                let unit = &document.parameters[name].unit;
                channels.insert(format!("start_{name}"), channel(unit, vec![start; length]));
            }
        }
        Arc::new(Maneuver::new(columns[1].clone(), channels).expect("a maneuver"))
    };
    maneuvers.into_iter().enumerate().map(maneuver).collect()
}

fn is_simulated(problem: &Problem) -> bool {
    ["P3", "P5b"].contains(&problem.name)
}

/// Start values of a simulated problem, as the peers read them off the records.
fn exported_starts(problem: &Problem, directory: &Path) -> IndexMap<String, f64> {
    let path = directory.join(format!("{}.json", problem.name));
    let text = std::fs::read_to_string(path).expect("what the peers exported");
    let exported: Value = serde_json::from_str(&text).expect("JSON");
    let list = |key: &str| exported[key].as_array().expect("a list").clone();
    let pairs = list("names").into_iter().zip(list("theta0"));
    pairs
        .map(|(name, value)| {
            let name = name.as_str().expect("a name").to_string();
            (name, value.as_f64().expect("a number"))
        })
        .collect()
}

/// The peers' P2 has its parameters in another order than the catalog's document, and P5b maneuver by maneuver.
fn in_peer_order(problem: &Problem, values: Vec<(&str, f64)>) -> Vec<f64> {
    let value = |(_, value): &(&str, f64)| *value;
    match problem.name {
        "P2" => {
            let order = "Lp Lr Lda Ldr Lb Np Nr Nda Ndr Nb p_bias r_bias ay_bias Yp Yr Yda Ydr Yb";
            let find = |name| values.iter().find(|(own, _)| *own == name);
            order
                .split(' ')
                .map(|name| value(find(name).expect("a parameter")))
                .collect()
        }
        "P5b" => {
            let (own, shared): (Vec<_>, Vec<_>) =
                values.iter().partition(|(name, _)| OWN.contains(name));
            let maneuvers = own.len() / OWN.len();
            let of = |maneuver: usize| {
                let named = |name| own.iter().filter(move |(own, _)| *own == name);
                let nth = OWN.map(|name| named(name).nth(maneuver).expect("a parameter"));
                nth.map(value)
            };
            let shared = shared.iter().map(value);
            shared.chain((0..maneuvers).flat_map(of)).collect()
        }
        _ => values.iter().map(value).collect(),
    }
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
        let directory = if is_simulated(&problem) {
            &exported
        } else {
            &flight
        };
        let Some(directory) = directory else {
            eprintln!("SKIPPED {}: no data", problem.name);
            continue;
        };
        if is_simulated(&problem) {
            let starts = exported_starts(&problem, directory);
            let shared = starts.iter().filter(|(name, _)| !name.ends_with(']'));
            let starts = shared.map(|(name, value)| (name.clone(), json!({"start": value})));
            problem.spec = json!({"parameters": Value::Object(starts.collect())});
        }
        println!("{}", measure(&problem, directory));
    }
}
