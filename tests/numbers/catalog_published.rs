//! Catalog models on recorded flights, against published estimates.

use std::path::Path;
use std::sync::Arc;

use crate::common::estimation::{solve, solve_all};
use crate::common::published_cases::read;
use crate::common::recordings::maneuver;
use serde_json::{Map, Value, json};
use trimtab_core::estimate::Estimate;
use trimtab_core::flight::Maneuver;

fn recording(directory: &Path, file: &str) -> Arc<Maneuver> {
    maneuver(&std::fs::read(directory.join(file)).expect("a recording"))
}

/// The largest distance of an estimate from the reference's, in standard errors; `name` says what it is called here.
fn farthest(
    estimate: &Estimate,
    reference: &[(String, Option<String>, f64, f64)],
    name: &dyn Fn(&str) -> String,
) -> f64 {
    let mut compared = 0;
    let mut worst: f64 = 0.0;
    for (published, _, value, error) in reference {
        let name = name(published);
        if let Some(found) = estimate.parameters.iter().find(|p| p.name == name) {
            worst = worst.max((found.estimate - value).abs() / error);
            compared += 1;
        }
    }
    assert!(compared >= 6, "only {compared} compared");
    worst
}

/// TC04: HFB-320, 11 derivatives, initial states given. The reference stops at a relative change of the cost of
/// 1e-4, 0.05 standard errors from the optimum at most; the constants are products in the reference and factors
/// here, rounded to seven digits.
#[test]
fn nonlinear_longitudinal_motion() {
    let Some(directory) = crate::common::flight_data::directory("TC04") else {
        return;
    };
    let case = read(&directory, "TC04");
    let given = |value: f64| json!({"start": value, "fixed": true});
    let initial = json!({"V_0": given(106.023), "alpha_0": given(0.111685), "theta_0": given(0.104887), "q_0": given(-0.00332659)});
    let maneuver = recording(&directory, "hfb320_1_10.csv");
    let estimate = solve(
        "longitudinal-nonlinear",
        &maneuver,
        &json!({"parameters": initial}),
    )
    .estimate;
    let excess = estimate.det_r / case.det_r - 1.0;
    let worst = farthest(&estimate, &case.reference, &str::to_string);
    println!(
        "TC04: det R {excess:+.1e}, worst {worst:.3} standard errors; {}",
        estimate.reason
    );
    assert!(estimate.outcome.is_minimum());
    assert!(excess.abs() < 1e-4 && worst < 0.05, "{excess:e} {worst}");
    assert_eq!(estimate.modes.len(), 2, "{:#?}", estimate.modes);
}

/// TC22 with its 21 initial states free: ATTAS, six biases from three maneuvers. The recorded derivatives of the rates
/// are the reference's but for 4 samples at either end.
#[test]
fn flight_path_reconstruction() {
    let Some(directory) = crate::common::flight_data::directory("TC22_x0free") else {
        return;
    };
    let case = read(&directory, "TC22_x0free");
    let maneuvers = ["attas_elv1.csv", "attas_ail1.csv", "attas_rud1.csv"]
        .map(|file| recording(&directory, file));
    let uses: Vec<Value> = (maneuvers.iter())
        .map(|maneuver| json!({"id": maneuver.digest(), "gaps": "join"}))
        .collect();
    let spec = json!({
        "model": "flight-path-reconstruction-attitude",
        "maneuvers": uses,
        "channels": {"pdot": "pdot_diff", "qdot": "qdot_diff", "rdot": "rdot_diff", "h": "h_p"},
        "constants": {"g": 9.8, "x_a": -1.01, "y_a": 0.886, "z_a": 0.103, "x_b": 13.08, "y_b": -0.01, "z_b": -0.027},
        "parameters": Map::new(),
    });
    let estimate = solve_all("flight-path-reconstruction-attitude", &maneuvers, &spec).estimate;
    let excess = estimate.det_r / case.det_r - 1.0;
    let name = |published: &str| match published.strip_prefix("b_") {
        Some(of) => format!("{of}_bias"),
        None => published.to_string(),
    };
    let worst = farthest(&estimate, &case.reference, &name);
    println!(
        "TC22_x0free: det R {excess:+.1e}, worst {worst:.3} standard errors; {}",
        estimate.reason
    );
    assert!(estimate.outcome.is_minimum());
    assert!(excess.abs() < 1e-3 && worst < 0.1, "{excess:e} {worst}");
    assert!(estimate.modes.is_empty());
}
