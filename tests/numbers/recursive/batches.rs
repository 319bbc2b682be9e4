//! At the end of a record the batch estimators.

use serde_json::{Value, json};
use trimtab_core::estimate::Estimate;
use trimtab_core::recursive::{Estimates, Tracker};

use super::{batch, elevator, flown, tracked};
use crate::common::plans::plan;

/// How far, in standard errors of the batch, recursive estimates are from it at the end of the record.
fn distance(batch: &Estimate, tracker: &Tracker, found: &Estimates) -> f64 {
    let mut far = 0.0_f64;
    for (i, parameter) in tracker.parameters().iter().enumerate() {
        let mut rows = batch.parameters.iter();
        let row = rows.find(|row| row.name == parameter.name).expect("a row");
        // what the batch does not determine the tracker does not, either
        let Some(error) = row.standard_error else {
            assert!(
                found.values[i].is_nan(),
                "{}: {}",
                parameter.name,
                found.values[i]
            );
            continue;
        };
        far = far.max((found.values[i] - row.estimate).abs() / error);
    }
    far
}

/// Half widths from which the batch chooses what suits the whole record best, which nobody knows in flight.
const HALF_WIDTHS: [usize; 9] = [2, 3, 4, 6, 8, 12, 16, 24, 32];

#[test]
fn recursive_least_squares_end_where_the_batch_does() {
    let mut worst = 0.0_f64;
    for seed in 1..=100 {
        let estimator = json!({"options": {"estimator": "equation_error", "tolerance": 1e-10}});
        let plan = elevator(
            flown(include_str!("../../../data/elevator.toml"), seed),
            estimator,
        );
        let batch = batch(&plan);
        let distances = HALF_WIDTHS.map(|half_width| {
            let (tracker, found) =
                tracked(&plan, json!({"method": "rls", "half_width": half_width}));
            assert_eq!(tracker.parameters().len(), 6);
            distance(&batch, &tracker, &found)
        });
        // with the window that the batch has chosen
        worst = worst.max(distances.into_iter().fold(f64::INFINITY, f64::min));
    }
    println!("farthest from the batch: {worst:e} standard errors");
    assert!(worst < 1e-3, "{worst}");
}

#[test]
fn recursive_fourier_regression_ends_where_the_batch_does() {
    let frequency = json!({"band_hz": [0.1, 1.5], "step_hz": 0.04});
    let options = json!({"estimator": "equation_error_frequency", "frequency": frequency, "tolerance": 1e-10});
    let asked = json!({"method": "rft", "frequency": frequency});
    let mut worst = 0.0_f64;
    for seed in 1..=100 {
        let maneuver = flown(include_str!("../../../data/elevator.toml"), seed);
        let plan = elevator(maneuver, json!({"options": options}));
        let (tracker, found) = tracked(&plan, asked.clone());
        worst = worst.max(distance(&batch(&plan), &tracker, &found));
    }
    println!("farthest from the batch: {worst:e} standard errors");
    assert!(worst < 0.1, "{worst}");
}

/// A lateral acceleration has derivatives that an equation of motion has, too: equations are weighed against each other.
#[test]
fn equations_that_share_parameters_are_weighed_as_the_batch_does() {
    let scenario = include_str!("../../../data/aileron.toml");
    let frequency = json!({"band_hz": [0.1, 1.2], "step_hz": 0.05});
    let changes = |estimator: &str, frequency: Option<&Value>| {
        let mut options = json!({"estimator": estimator, "tolerance": 1e-10});
        if let Some(frequency) = frequency {
            options["frequency"] = frequency.clone();
        }
        json!({"options": options})
    };
    let maneuver = flown(scenario, 7);
    let model = json!("lateral-directional-4");
    let of_time = plan(
        model.clone(),
        changes("equation_error", None),
        std::slice::from_ref(&maneuver),
    );
    let (in_time, best) = (
        batch(&of_time),
        HALF_WIDTHS.map(|half_width| {
            let (tracker, found) =
                tracked(&of_time, json!({"method": "rls", "half_width": half_width}));
            distance(&batch(&of_time), &tracker, &found)
        }),
    );
    let far = best.into_iter().fold(f64::INFINITY, f64::min);
    println!("rls: {far:e}, {} parameters", in_time.parameters.len());
    assert!(far < 0.1, "{far}");
    let of_band = plan(
        model,
        changes("equation_error_frequency", Some(&frequency)),
        &[maneuver],
    );
    let (tracker, found) = tracked(&of_band, json!({"method": "rft", "frequency": frequency}));
    let far = distance(&batch(&of_band), &tracker, &found);
    println!("rft: {far:e}");
    assert!(far < 0.1, "{far}");
}
