//! How often the 95 % intervals contain the truth: `cargo bench --bench coverage [-- SEEDS]` prints the tables.

#[path = "../common/coloured.rs"]
mod coloured;
#[path = "../common/coverage.rs"]
mod coverage;
#[path = "../common/reconstruction.rs"]
mod reconstruction;

use std::time::Instant;

use serde_json::json;
use trimtab::job::JobSpec;
use trimtab::simulate::NoiseColour;

use coverage::{fit, over_seeds};

/// Where no number is given.
const SEEDS: u64 = 1000;

fn main() {
    let mut numbers = std::env::args().filter_map(|argument| argument.parse().ok());
    let seeds: u64 = numbers.next_back().unwrap_or(SEEDS);
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
    for (name, colour) in colours {
        let begun = Instant::now();
        let coverage = coloured::short_period(colour, seeds);
        coverage.print(&format!(
            "short period, {name} noise ({:.1?})",
            begun.elapsed()
        ));
    }

    let begun = Instant::now();
    let truth = reconstruction::Truth::new();
    let document = reconstruction::document();
    let spec = json!({"model": "in the file", "maneuvers": [{"id": "x"}]});
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    let coverage = over_seeds(seeds, &truth.parameters, |seed| {
        fit(&document, &spec, truth.recording(seed))
    });
    coverage.print(&format!(
        "flight path reconstruction, white noise ({:.1?})",
        begun.elapsed()
    ));
    let outside: Vec<String> = (coverage.0.iter())
        .filter(|(_, row)| !(0.92..=0.98).contains(&row.share(|row| &row.corrected)))
        .map(|(name, row)| format!("{name} {:.1} %", 100.0 * row.share(|row| &row.corrected)))
        .collect();
    let biased: Vec<String> = (coverage.0.iter())
        .filter(|(_, row)| row.bias().abs() > 3.0)
        .map(|(name, row)| format!("{name} {:.1}", row.bias()))
        .collect();
    println!(
        "of {} parameters outside 92 to 98 %: {outside:?}; biased by more than 3 standard errors of the mean: {biased:?}",
        coverage.0.len()
    );
}
