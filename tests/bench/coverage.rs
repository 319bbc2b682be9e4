//! How often the 95 % intervals contain the truth: `cargo bench --bench coverage [-- SEEDS [FIRST]]` prints the tables.
//! Seeds count from FIRST, 1 if not given. `--short-period` leaves the flight path reconstruction out.

#[path = "../common"]
mod common {
    pub(crate) mod coloured;
    pub(crate) mod coverage;
    pub(crate) mod reconstruction;
}

use std::ops::Range;
use std::time::Instant;

use serde_json::{Value, json};
use trimtab_core::job::JobSpec;
use trimtab_core::simulate::NoiseColour;

use common::coloured::Logged;
use common::coverage::{Coverage, fit, over_seeds};
use common::{coloured, reconstruction};

/// Where no number is given.
const SEEDS: u64 = 1000;

fn main() {
    let mut numbers = std::env::args().filter_map(|argument| argument.parse().ok());
    let seeds: u64 = numbers.next().unwrap_or(SEEDS);
    let first: u64 = numbers.next().unwrap_or(1);
    let n = seeds as f64;
    println!(
        "a share of 95 % is known to ±{:.1} % (95 %) from {seeds} seeds",
        196.0 * (0.95_f64 * 0.05 / n).sqrt()
    );

    let colours = [
        ("white", NoiseColour::White),
        (
            "first-order, 0.1 s",
            NoiseColour::FirstOrder {
                correlation_time: 0.1,
            },
        ),
        (
            "first-order, 0.4 s",
            NoiseColour::FirstOrder {
                correlation_time: 0.4,
            },
        ),
        (
            "band-limited, 2 Hz",
            NoiseColour::BandLimited { bandwidth: 2.0 },
        ),
    ];
    for (name, colour) in &colours {
        let begun = Instant::now();
        let coverage = coloured::short_period(*colour, first..first + seeds);
        coverage.print(&format!(
            "short period, {name} noise ({:.1?})",
            begun.elapsed()
        ));
    }

    for by in [Logged::WithGaps, Logged::Held, Logged::HeldWithGaps] {
        for (name, colour) in &colours[..2] {
            let begun = Instant::now();
            let coverage = coloured::logged(*colour, by, first..first + seeds);
            let took = begun.elapsed();
            coverage.print(&format!("short period, {by:?}, {name} noise ({took:.1?})"));
        }
    }
    if !std::env::args().any(|argument| argument == "--short-period") {
        reconstruct(first..first + seeds);
    }
}

/// Flight path reconstruction, with noise and with half of it: a bias from the noise, which an estimate has that is not
/// linear in it, is then half as many standard deviations; one from how the truth was integrated twice as many.
fn reconstruct(seeds: Range<u64>) {
    let truth = reconstruction::Truth::new();
    let document = reconstruction::document();
    let spec = |options: Value| -> JobSpec {
        let spec = json!({"model": document.name, "maneuvers": [{"id": "x"}], "options": options});
        serde_json::from_value(spec).expect("a spec")
    };
    let flown = |share: f64| {
        let begun = Instant::now();
        let plain = spec(json!({}));
        let coverage = over_seeds(seeds.clone(), &truth.parameters, |seed| {
            fit(&document, &plain, truth.recording(seed, share))
        });
        coverage.print(&format!(
            "flight path reconstruction, white noise times {share} ({:.1?})",
            begun.elapsed()
        ));
        coverage
    };
    let (whole, half) = (flown(1.0), flown(0.5));
    let outside: Vec<String> = (whole.0.iter())
        .filter(|(_, row)| !(0.92..=0.98).contains(&row.share(|row| &row.corrected)))
        .map(|(name, row)| format!("{name} {:.1} %", 100.0 * row.share(|row| &row.corrected)))
        .collect();
    println!(
        "of {} parameters outside 92 to 98 %: {outside:?}",
        whole.0.len()
    );

    let variance: Vec<f64> = reconstruction::NOISE.iter().map(|s| s * s).collect();
    let given = spec(json!({"noise": {"kind": "given", "variance": variance}}));
    let silent = fit(&document, &given, truth.recording(1, 0.0));
    let mut integration = Coverage::default();
    integration.add(&silent, &truth.parameters);
    println!("\nbias in standard deviations of the estimate; with half the noise; without noise");
    let known = ((seeds.end - seeds.start) as f64).sqrt().recip();
    for (name, row) in &whole.0 {
        println!(
            "{name:12} {:7.3} ±{known:.3} {:7.3} ±{known:.3} {:9.1e}",
            row.bias() * known,
            half.0[name].bias() * known,
            integration.0[name].errors[0] / row.scatter(),
        );
    }
}
