//! The published filter-error estimation, run as a client would.

use std::collections::HashMap;

use crate::common::filter_case::{FilterCase, read};
use crate::common::server::Server;
use serde_json::{Value, json};
use trimtab::estimate::{Bound, Estimate};

/// The reference stops when det R changes by less than 1e-4 from one iteration to the next, which leaves its det R
/// 0.2 % above the optimum that it approaches, and its estimates this far (in standard errors) from ours.
const WITHIN_STANDARD_ERRORS: f64 = 0.15;

async fn estimate(server: &Server, maneuver: &str, case: &FilterCase, options: Value) -> Estimate {
    let spec = json!({
        "model": case.model,
        "channels": case.channels,
        "maneuvers": [{"id": maneuver, "rows": case.rows, "gaps": "join"}],
        "options": options,
    });
    let id = server.submit(&spec).await;
    let done = server.wait(&id).await;
    assert_eq!(
        (&done["status"], &done["outcome"]),
        (&json!("succeeded"), &json!("at_bound")),
        "{done:#}"
    );
    let answer = server.get(&format!("/v1/jobs/{id}/estimate")).await;
    serde_json::from_value(answer.json()).unwrap()
}

/// As published from the published start values, and from ours.
#[tokio::test]
async fn longitudinal_motion_in_turbulence() {
    let Some(directory) = crate::common::flight_data::directory("FEM_TC04") else {
        return;
    };
    let server = Server::start().await;
    let case = read(&directory, "FEM_TC04");
    let recording = std::fs::read_to_string(directory.join(&case.file)).unwrap();
    let maneuver = server.upload(&recording).await;
    for (start, method) in [
        (case.process_noise.clone(), "gauss_newton"),
        (json!({}), "levenberg_marquardt"),
    ] {
        let options =
            json!({"estimator": "filter_error", "process_noise": start, "method": method});
        let estimate = estimate(&server, &maneuver, &case, options).await;
        let excess = estimate.det_r / case.det_r - 1.0;
        println!(
            "{method}: {} iterations, det R {:e} ({excess:+.1e})",
            estimate.iterations, estimate.det_r
        );
        assert!(
            (-3e-3..1e-6).contains(&excess),
            "det R {excess:e} off the reference's"
        );
        let filter = estimate.filter.expect("a filter");
        let parameters = estimate.parameters.iter();
        let parameters = parameters.map(|p| (p.name.clone(), (p.estimate, p.standard_error)));
        let noises = filter.process_noise.iter();
        let noises = noises.map(|n| (format!("f_{}", n.state), (n.estimate, n.standard_error)));
        let found: HashMap<String, _> = parameters.chain(noises).collect();
        for (name, reference, deviation) in &case.reference {
            let (ours, standard_error) = found[name];
            let distance = (ours - reference).abs() / deviation;
            assert!(
                distance < WITHIN_STANDARD_ERRORS,
                "{name}: {distance} standard errors"
            );
            // the intensity at its limit has no bound of its own; 1 % as between the reference's last two iterates
            if let Some(standard_error) = standard_error {
                let ratio = standard_error / deviation;
                assert!(
                    (ratio - 1.0).abs() < 0.01,
                    "{name}: standard errors differ by {ratio}"
                );
            }
        }
        // the data would like more than all of the error in alpha taken away, here as in the reference
        let held = filter.process_noise.iter().map(|noise| noise.at_bound);
        assert!(held.eq([None, Some(Bound::Upper), None, None]));
        for (row, reference) in filter.gains[0].gain.iter().zip(&case.gain) {
            let largest = reference.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
            for (ours, reference) in row.iter().zip(reference) {
                assert!(
                    (ours - reference).abs() < 0.02 * largest,
                    "{row:?} {reference:?}"
                );
            }
        }
    }
}

/// The formulation itself, to rounding: at the reference's estimates and with the R that it had in its gain, held, the
/// gain and the innovations are the reference's. Only the Jacobians differ, exact here and central differences there.
#[tokio::test]
async fn at_the_published_estimates_it_has_the_published_gain_and_innovations() {
    let Some(directory) = crate::common::flight_data::directory("FEM_TC04") else {
        return;
    };
    let server = Server::start().await;
    let mut case = read(&directory, "FEM_TC04");
    let recording = std::fs::read_to_string(directory.join(&case.file)).unwrap();
    let maneuver = server.upload(&recording).await;
    let mut process_noise = serde_json::Map::new();
    for (name, value, _) in &case.reference {
        match name.strip_prefix("f_") {
            Some(state) => {
                process_noise.insert(state.into(), json!({"start": value, "fixed": true}));
            }
            // one is left free by the hair of its bounds: a job must have something to estimate
            None if name == "CD0" => {
                let bounds = (value - 1e-12, value + 1e-12);
                case.model["parameters"][name] =
                    json!({"start": value, "lower": bounds.0, "upper": bounds.1});
            }
            None => {
                case.model["parameters"][name] = json!({
                    "unit": case.model["parameters"][name]["unit"], "start": value, "fixed": true,
                })
            }
        }
    }
    let options = json!({
        "estimator": "filter_error", "process_noise": process_noise,
        "noise": {"kind": "given", "variance": case.gain_variance},
    });
    let estimate = estimate(&server, &maneuver, &case, options).await;
    let det: f64 = estimate
        .outputs
        .iter()
        .map(|output| output.rms * output.rms)
        .product();
    let excess = det / case.det_r - 1.0;
    println!("det R {det:e} ({excess:+.1e})");
    assert!(excess.abs() < 1e-8, "{excess:e}");
    let filter = estimate.filter.expect("a filter");
    for (row, reference) in filter.gains[0].gain.iter().zip(&case.gain) {
        for (ours, reference) in row.iter().zip(reference) {
            assert!(
                (ours / reference - 1.0).abs() < 1e-7,
                "{ours:e} {reference:e}"
            );
        }
    }
}
