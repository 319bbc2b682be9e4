//! Error bounds against the errors of many seeds, and redundancies of the flight path reconstruction by name. The same
//! with more seeds, as tables: `cargo bench --bench coverage`.

use std::collections::BTreeSet;

use serde_json::json;
use trimtab_core::estimate::Outcome;
use trimtab_core::job::JobSpec;
use trimtab_core::simulate::NoiseColour;

use crate::common::coloured::Logged;
use crate::common::coverage::{fit, over_seeds};
use crate::common::{coloured, reconstruction};

/// Of 60 seeds and 9 parameters, some of them strongly correlated. Taken for some 200 independent intervals (60 if all
/// of a seed were one, 540 if none were alike), a pooled share of 95 % has a standard deviation of
/// √(0.95·0.05/200) = 1.5 %; three of those below it are 90 %.
#[test]
fn intervals_hold_for_white_and_coloured_noise() {
    let white = coloured::short_period(NoiseColour::White, 1..61);
    white.print("white");
    let (corrected, conventional) = (
        white.pooled(|row| &row.corrected),
        white.pooled(|row| &row.conventional),
    );
    assert!((0.91..0.985).contains(&corrected), "{corrected}");
    assert!(
        (corrected - conventional).abs() < 0.02,
        "{corrected} {conventional}"
    );
    for colour in [
        NoiseColour::FirstOrder {
            correlation_time: 0.1,
        },
        NoiseColour::BandLimited { bandwidth: 2.0 },
    ] {
        let coloured = coloured::short_period(colour, 1..61);
        coloured.print(&format!("{colour:?}"));
        let (corrected, conventional) = (
            coloured.pooled(|row| &row.corrected),
            coloured.pooled(|row| &row.conventional),
        );
        assert!(corrected > 0.90, "{colour:?}: {corrected}");
        assert!(conventional < 0.80, "{colour:?}: {conventional}");
    }
}

/// The same of recordings with gaps that are integrated through, and of a channel that was held and is made fresh. The noise is drawn anew
/// for each seed, and the truth is that of the scenario.
#[test]
fn intervals_hold_through_gaps_and_for_held_channels_made_fresh() {
    for (by, colour) in [
        (Logged::WithGaps, NoiseColour::White),
        (Logged::Held, NoiseColour::White),
        (
            Logged::HeldWithGaps,
            NoiseColour::FirstOrder {
                correlation_time: 0.1,
            },
        ),
    ] {
        let coverage = coloured::logged(colour, by, 1..61);
        coverage.print(&format!("{by:?}, {colour:?}"));
        let corrected = coverage.pooled(|row| &row.corrected);
        assert!((0.90..0.99).contains(&corrected), "{by:?}: {corrected}");
    }
}

/// Pooled over 25 parameters of 24 seeds, many of them correlated; 3 standard deviations of a share of 95 % pooled over
/// what is independent of them (some 200) are 5 %.
#[test]
fn a_reconstruction_is_as_accurate_as_it_says() {
    let truth = reconstruction::Truth::new();
    let document = reconstruction::document();
    let spec = json!({"model": "flight-path-reconstruction", "maneuvers": [{"id": "x"}]});
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    let coverage = over_seeds(1..25, &truth.parameters, |seed| {
        fit(&document, &spec, truth.recording(seed, 1.0))
    });
    coverage.print("flight path reconstruction");
    assert_eq!(coverage.0.len(), 25);
    let share = coverage.pooled(|row| &row.corrected);
    assert!((0.90..=1.0).contains(&share), "{share}");
    for (name, row) in &coverage.0 {
        assert!(row.bias().abs() < 4.0, "{name}: {}", row.bias());
    }
}

/// A bias of a measured position is an initial position: exactly, and before anything is estimated.
#[test]
fn redundant_position_biases_are_named() {
    let truth = reconstruction::Truth::new();
    let document = reconstruction::document();
    let freed = json!({"fixed": false});
    let spec = |iterations: usize| -> JobSpec {
        let spec = json!({
            "model": "flight-path-reconstruction", "maneuvers": [{"id": "x"}],
            "parameters": {"x_bias": freed, "y_bias": freed, "z_bias": freed},
            "options": {"max_iterations": iterations},
        });
        serde_json::from_value(spec).expect("a spec")
    };
    let pairs: BTreeSet<BTreeSet<String>> = ["x", "y", "z"]
        .iter()
        .map(|name| BTreeSet::from([format!("{name}_bias"), format!("{name}_0")]))
        .collect();
    let named = |sets: &[trimtab_core::estimate::CollinearSet]| -> BTreeSet<BTreeSet<String>> {
        sets.iter()
            .map(|set| set.parameters.iter().cloned().collect())
            .collect()
    };

    let looked = fit(&document, &spec(0), truth.recording(1, 1.0));
    assert_eq!((looked.outcome, looked.iterations), (Outcome::Budget, 0));
    let identifiability = looked.identifiability.expect("it");
    assert_eq!(named(&identifiability.before.redundant), pairs);
    assert_eq!(identifiability.before.singular_values.len(), 28);
    assert!(identifiability.before.condition_number.is_nan());
    assert!(identifiability.before.unseen.is_empty() && identifiability.after.is_none());

    let fitted = fit(&document, &spec(50), truth.recording(1, 1.0));
    assert_eq!(fitted.outcome, Outcome::Singular, "{}", fitted.reason);
    assert_eq!(named(&fitted.collinear), pairs);
    let after = fitted
        .identifiability
        .and_then(|both| both.after)
        .expect("it");
    assert_eq!(named(&after.redundant), pairs);
    println!("nearly collinear: {:#?}", after.nearly_collinear);
    println!("highly correlated: {:?}", after.highly_correlated);
    let determined = fitted
        .parameters
        .iter()
        .filter(|p| p.standard_error.is_some());
    assert_eq!(determined.count(), 22);
}
