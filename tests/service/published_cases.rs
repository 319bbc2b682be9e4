//! Published estimations, run as a client would: recording and model uploaded to the real server,
//! the estimates compared with those that the reference found.

use std::collections::HashMap;

use crate::common::published_cases::{Case, read};
use crate::common::server::Server;
use serde_json::json;
use trimtab::estimate::{Estimate, ParameterEstimate};

/// The reference stops at a relative change of the cost of 1e-4, which leaves it this far (in standard
/// errors) from the optimum that we converge to.
const WITHIN_STANDARD_ERRORS: f64 = 0.05;
/// Standard errors are taken at points that far apart.
const BOUNDS: f64 = 0.01;

async fn estimate(server: &Server, name: &str, case: &Case, method: &str) -> Estimate {
    let mut maneuvers = Vec::new();
    for (recording, rows) in &case.segments {
        maneuvers.push(json!({"id": server.upload(recording).await, "rows": rows, "gaps": "join"}));
    }
    let spec = json!({
        "name": name,
        "model": case.model,
        "channels": case.channels,
        "maneuvers": maneuvers,
        // the reference takes one step a sample
        "options": {"method": method, "start": {"kind": "document"}, "steps_per_sample": 1},
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

/// By name, and segment where each has its own and there are several.
fn by_name(estimate: &Estimate) -> HashMap<(&str, Option<&str>), &ParameterEstimate> {
    let rows = estimate.parameters.iter();
    let alone = rows
        .clone()
        .all(|row| row.segment.as_deref().unwrap_or("1") == "1");
    rows.map(|row| {
        let segment = row.segment.as_deref().filter(|_| !alone);
        ((row.name.as_str(), segment), row)
    })
    .collect()
}

/// `within` standard errors, which themselves agree to `bounds`, a share.
async fn reproduces(name: &str, within: f64, bounds: f64) {
    let Some(directory) = crate::common::flight_data::directory(name) else {
        return;
    };
    let server = Server::start().await;
    let case = read(&directory, name);
    for method in ["levenberg_marquardt", "gauss_newton"] {
        let estimate = estimate(&server, name, &case, method).await;
        let excess = estimate.det_r / case.det_r - 1.0;
        println!(
            "{name} {method}: {} iterations, det R {:e} ({excess:+.1e})",
            estimate.iterations, estimate.det_r
        );
        assert!(
            excess < 1e-6,
            "{name}: det R {excess:e} above the reference's"
        );

        let found = by_name(&estimate);
        for (parameter, segment, reference, deviation) in &case.reference {
            let ours = found[&(parameter.as_str(), segment.as_deref())];
            // the reference knows of white residuals only
            let standard_error = ours.conventional_standard_error.expect("the data see it");
            let distance = (ours.estimate - reference).abs() / standard_error;
            assert!(
                distance < within,
                "{name} {parameter}: {distance} standard errors"
            );
            let ratio = standard_error / deviation;
            assert!(
                (ratio - 1.0).abs() < bounds,
                "{name} {parameter}: standard errors differ by {ratio}"
            );
        }
    }
}

#[tokio::test]
async fn lateral_directional_with_accelerations() {
    reproduces("TC01", WITHIN_STANDARD_ERRORS, BOUNDS).await;
}

#[tokio::test]
async fn lateral_directional_two_states() {
    reproduces("TC03_ailrud1", WITHIN_STANDARD_ERRORS, BOUNDS).await;
}

#[tokio::test]
async fn nonlinear_longitudinal() {
    reproduces("TC04", WITHIN_STANDARD_ERRORS, BOUNDS).await;
}

#[tokio::test]
async fn short_period() {
    reproduces("TC11_elv1", WITHIN_STANDARD_ERRORS, BOUNDS).await;
}

#[tokio::test]
async fn flight_path_reconstruction_of_three_maneuvers() {
    reproduces("TC22", WITHIN_STANDARD_ERRORS, BOUNDS).await;
}

#[tokio::test]
async fn flight_path_reconstruction_with_initial_states_of_each_maneuver() {
    reproduces("TC22_x0free", WITHIN_STANDARD_ERRORS, BOUNDS).await;
}

#[tokio::test]
async fn flight_path_reconstruction_with_biases_of_each_maneuver() {
    reproduces("TC32", WITHIN_STANDARD_ERRORS, BOUNDS).await;
}

/// No states; smoothed and differentiated channels. The reference stops further out than elsewhere: its det R is 2.0e-5
/// above ours, which with N = 3001 samples is about √(N 2.0e-5) = 0.25 standard errors from the minimum (the cost is not
/// quite a parabola there). Farthest is tau2, 0.288 apart, over which its standard error changes by 1.03 %.
#[tokio::test]
async fn quasi_steady_stall() {
    reproduces("TC27_qst01", 0.3, 0.02).await;
}

/// The reference takes a delayed signal from a straight line through the last two samples, which for the two negative
/// delays here is an extrapolation; ours is a cubic between the samples to both sides (`tests/numbers/delays.rs` shows which
/// is nearer to the truth), and fits better: det R is 0.28 % lower. Delays, and the calibrations of the delayed
/// vanes, differ by what the interpolations do, up to one standard error; all else is the same model and agrees.
#[tokio::test]
async fn flight_path_reconstruction_with_time_delays() {
    let name = "TC33";
    let Some(directory) = crate::common::flight_data::directory(name) else {
        return;
    };
    let server = Server::start().await;
    let case = read(&directory, name);
    let estimate = estimate(&server, name, &case, "levenberg_marquardt").await;
    let excess = estimate.det_r / case.det_r - 1.0;
    println!(
        "{name}: {} iterations, det R {:e} ({excess:+.1e})",
        estimate.iterations, estimate.det_r
    );
    let found = by_name(&estimate);
    let mut worst = (0.0_f64, 0.0_f64);
    for (parameter, segment, reference, deviation) in &case.reference {
        let ours = found[&(parameter.as_str(), segment.as_deref())];
        let standard_error = ours.standard_error.expect("the data see it");
        let distance = (ours.estimate - reference).abs() / deviation;
        println!(
            "{parameter} {segment:?}: {} ± {standard_error:.3e}, reference {reference} ± {deviation:.3e}: {distance:.3} apart",
            ours.estimate
        );
        if ["tau_", "f_", "b_alpha"]
            .iter()
            .any(|own| parameter.starts_with(own))
        {
            worst.1 = worst.1.max(distance);
        } else {
            worst.0 = worst.0.max(distance);
        }
    }
    println!(
        "{name}: apart by at most {:.3} standard errors, delays and calibrations {:.3}",
        worst.0, worst.1
    );
    assert!((-0.01..0.0).contains(&excess), "{excess:e}");
    assert!(
        worst.0 < WITHIN_STANDARD_ERRORS && worst.1 < 1.1,
        "{worst:?}"
    );
}
