//! How time and memory grow with the length of a recording: time linear, memory by no more than the data.
//!
//! `cargo bench --bench growth` prints, for recordings of up to a million samples, the nanoseconds a sample of one set
//! of normal equations and what it adds to the largest memory so far, beside what ∂y/∂θ of all samples would take.

mod simulated;

use std::time::{Duration, Instant};

use trimtab_core::estimate::{Evaluator, NormalEquations};

/// The largest memory that this process has had, MB, where the system tells.
fn peak_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<f64>().ok());
    kilobytes.map_or(f64::NAN, |kilobytes| kilobytes / 1024.0)
}

fn main() {
    println!(
        "problem                     samples  ns/sample  peak MB before  after  d(y)/d(theta) MB"
    );
    for (name, step, most) in [
        ("short-period", 0.04, 1_000_000),
        ("flight-path-reconstruction", 0.05, 1_000_000),
        // with its controls held, this airplane does not stay in flight for hours
        ("hfb320", 0.1, 10_000),
    ] {
        for samples in [1_000, 10_000, 100_000, 1_000_000] {
            if samples > most {
                break;
            }
            let plan = simulated::plan(name, Some(f64::from(samples - 1) * step));
            let problem = &plan.problem;
            let theta = problem.unknowns.start();
            let before = peak_memory();
            let mut evaluator = Evaluator::new(problem);
            let mut least = Duration::MAX;
            for _ in 0..5 {
                let began = Instant::now();
                NormalEquations::at(&mut evaluator, &theta).expect("a bounded simulation");
                least = least.min(began.elapsed());
            }
            let count = problem.samples();
            let rows = count * problem.model.outputs.len() * theta.len() * size_of::<f64>();
            println!(
                "{name:26} {count:8} {:10.1} {before:15.1} {:6.1} {:17.1}",
                least.as_secs_f64() * 1e9 / count as f64,
                peak_memory(),
                rows as f64 / 1e6
            );
        }
    }
}
