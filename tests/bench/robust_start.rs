//! HFB-320, published case TC04, from random starts: how many end in the best known optimum, by start method.
//!
//! `cargo bench --bench robust_start [starts] [method]` needs the flight data. Each of the 11 derivatives is drawn evenly from a
//! range of multiples of its published estimate; initial states are those of the case. The best optimum is reached
//! when det R is within 1e-4 of the published one.

#[path = "../common"]
#[allow(dead_code)] // the tests use the rest
mod common {
    pub(crate) mod flight_data;
    pub(crate) mod preprocessing;
    pub(crate) mod published_cases;
    pub(crate) mod random_starts;
    pub(crate) mod recordings;
    pub(crate) mod repository;
}

use std::time::Instant;

use common::{flight_data, published_cases, random_starts};
use trimtab_core::estimate::StartMethod;

fn main() {
    let Some(directory) = flight_data::directory("bench robust_start") else {
        return;
    };
    let asked = std::env::args().find_map(|argument| argument.parse().ok());
    let starts: usize = asked.unwrap_or(1000);
    let case = published_cases::read(&directory, "TC04");
    let (problem, reference) = random_starts::problem(&case);
    let nelder_mead = StartMethod::NelderMead {
        max_evaluations: 4000,
    };
    let methods = [
        (
            "Levenberg-Marquardt alone",
            StartMethod::Document {},
            starts,
        ),
        (
            "multiple shooting",
            StartMethod::MultipleShooting { interval: 1.0 },
            starts,
        ),
        ("Nelder-Mead first", nelder_mead, starts.div_ceil(10)),
        (
            "equation error",
            StartMethod::EquationError {},
            starts.div_ceil(10),
        ),
        ("automatic", StartMethod::Automatic {}, starts),
    ];
    // part of a method's name chooses methods, as in "shooting"
    let words: Vec<String> = std::env::args().skip(1).collect();
    let chosen: Vec<&String> = words
        .iter()
        .filter(|word| word.parse::<usize>().is_err() && !word.starts_with("--"))
        .collect();
    for share in [0.0..=2.0, -1.0..=3.0, -3.0..=3.0] {
        for (name, method, starts) in &methods {
            if !chosen.is_empty() && !chosen.iter().any(|word| name.contains(word.as_str())) {
                continue;
            }
            let began = Instant::now();
            let count =
                random_starts::count(&problem, &reference, &share, *starts, method, case.det_r);
            println!(
                "from {share:?} times the estimate, {name}: {} of {} reach the best optimum, {} end elsewhere, {} cannot begin; {:.1} s",
                count.best,
                count.starts,
                count.elsewhere,
                count.unusable,
                began.elapsed().as_secs_f64()
            );
        }
    }
}
