//! Published estimations, run as a client would: recording and model uploaded to the real server,
//! the estimates compared with those that the reference found.

mod common;

use std::collections::HashMap;
use std::path::Path;

use common::published_cases::{Case, read};
use common::server::Server;
use serde_json::json;
use trimtab::estimate::{Estimate, ParameterEstimate};

/// The reference stops at a relative change of the cost of 1e-4, which leaves it this far (in standard
/// errors) from the optimum that we converge to.
const WITHIN_STANDARD_ERRORS: f64 = 0.05;

async fn estimate(server: &Server, directory: &Path, case: &Case, method: &str) -> Estimate {
    let mut maneuvers = Vec::new();
    for (file, rows) in &case.segments {
        let recording = std::fs::read_to_string(directory.join(file)).unwrap();
        maneuvers
            .push(json!({"id": server.upload(&recording).await, "rows": rows, "gaps": "join"}));
    }
    let spec = json!({
        "name": case.name,
        "model": case.model,
        "channels": case.channels,
        "maneuvers": maneuvers,
        "options": {"method": method, "start": {"kind": "document"}},
    });
    let id = server.submit(&spec).await;
    let done = server.wait(&id).await;
    assert_eq!(
        (&done["status"], &done["outcome"]),
        (&json!("succeeded"), &json!("converged")),
        "{done:#}"
    );
    let answer = server.get(&format!("/v1/jobs/{id}/estimate")).await;
    serde_json::from_value(answer.json()).unwrap()
}

async fn reproduces(name: &str) {
    let Some(directory) = common::flight_data::directory(name) else {
        return;
    };
    let server = Server::start().await;
    let case = read(&directory, name);
    for method in ["levenberg_marquardt", "gauss_newton"] {
        let estimate = estimate(&server, &directory, &case, method).await;
        let excess = estimate.det_r / case.det_r - 1.0;
        println!(
            "{name} {method}: {} iterations, det R {:e} ({excess:+.1e})",
            estimate.iterations, estimate.det_r
        );
        assert!(
            excess < 1e-6,
            "{name}: det R {excess:e} above the reference's"
        );

        let found: HashMap<&str, &ParameterEstimate> = estimate
            .parameters
            .iter()
            .map(|parameter| (parameter.name.as_str(), parameter))
            .collect();
        for (parameter, reference, deviation) in &case.reference {
            let ours = found[parameter.as_str()];
            let standard_error = ours.standard_error.expect("the data see it");
            let distance = (ours.estimate - reference).abs() / standard_error;
            assert!(
                distance < WITHIN_STANDARD_ERRORS,
                "{name} {parameter}: {distance} standard errors"
            );
            let ratio = standard_error / deviation;
            assert!(
                (ratio - 1.0).abs() < 0.01,
                "{name} {parameter}: standard errors differ by {ratio}"
            );
        }
    }
}

#[tokio::test]
async fn lateral_directional_with_accelerations() {
    reproduces("TC01").await;
}

#[tokio::test]
async fn lateral_directional_two_states() {
    reproduces("TC03_ailrud1").await;
}

#[tokio::test]
async fn nonlinear_longitudinal() {
    reproduces("TC04").await;
}

#[tokio::test]
async fn short_period() {
    reproduces("TC11_elv1").await;
}
