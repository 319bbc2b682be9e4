//! Modes and nondimensional coefficients of a finished job, as a client sees them.

use crate::common::server::Server;
use serde_json::json;

#[tokio::test]
async fn a_finished_job_has_modes_and_its_derivatives_can_be_made_nondimensional() {
    let server = Server::start().await;
    let maneuver = server.upload(&crate::common::recordings::elevator()).await;
    let id = server.submit(&crate::common::jobs::job(&maneuver)).await;
    assert_eq!(server.wait(&id).await["outcome"], "converged");
    let estimate = server.get(&format!("/v1/jobs/{id}/estimate")).await.json();
    let mode = &estimate["modes"][0];
    // wn^2 = Za Mq - Zq Ma of the scenario's truth, 2.16 rad/s
    let frequency = mode["natural_frequency"]["value"]
        .as_f64()
        .expect("a number");
    assert!((frequency - 2.16).abs() < 0.05, "{mode}");
    assert!(
        mode["natural_frequency"]["standard_error"]
            .as_f64()
            .expect("a number")
            > 0.0
    );
    let page = server.get(&format!("/jobs/{id}")).await.text();
    assert!(
        page.contains(r#"<h2 id="modes">Modes</h2>"#) && page.contains("rad/s"),
        "{page}"
    );

    let path = format!("/v1/jobs/{id}/coefficients");
    let aircraft =
        json!({"m": 17600.0, "S": 64.0, "c": 3.16, "Iy": 331_000.0, "V": 130.0, "rho": 0.75});
    let answer = server.post_json(&path, &aircraft).await;
    assert_eq!(answer.status, 200, "{}", answer.text());
    let coefficients = answer.json();
    let names: Vec<&str> = (coefficients.as_array().expect("a list").iter())
        .map(|coefficient| coefficient["name"].as_str().expect("a name"))
        .collect();
    assert_eq!(names, ["Cza", "Czq", "Czde", "Cma", "Cmq", "Cmde"]);
    // Cm_alpha = Ma Iy/(qbar S c), bounds in proportion
    let row = |name: &str| {
        let rows = estimate["parameters"].as_array().expect("a list");
        rows.iter()
            .find(|row| row["name"] == name)
            .expect("it")
            .clone()
    };
    let factor = 331_000.0 / (0.5 * 0.75 * 130.0 * 130.0 * 64.0 * 3.16);
    for (of, key) in [("value", "estimate"), ("standard_error", "standard_error")] {
        let found = coefficients[3][of].as_f64().expect("a number");
        let expected = factor * row("Ma")[key].as_f64().expect("a number");
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
    }

    let without = json!({"m": 17600.0, "S": -64.0, "c": 3.16, "Iy": 331_000.0, "V": 130.0});
    let faults = server
        .post_json(&path, &without)
        .await
        .problem(422, "invalid_aircraft");
    let pointers: Vec<&str> = faults.iter().map(|(pointer, _)| pointer.as_str()).collect();
    assert_eq!(pointers, ["/S", "/rho"]);
    let incomplete = json!({"m": 17600.0, "S": 64.0, "c": 3.16, "V": 130.0, "rho": 0.75});
    let faults = server
        .post_json(&path, &incomplete)
        .await
        .problem(422, "invalid_aircraft");
    assert_eq!(faults[0].0, "/Iy");
}

#[tokio::test]
async fn a_constant_that_the_model_does_not_have_is_pointed_at() {
    let server = Server::start().await;
    let maneuver = server.upload(&crate::common::recordings::elevator()).await;
    let mut job = crate::common::jobs::job(&maneuver);
    job["constants"] = json!({"wingspan": 21.5});
    let faults = server
        .post_json("/v1/jobs", &job)
        .await
        .problem(422, "invalid_job");
    assert_eq!(
        faults,
        [(
            "/constants/wingspan".to_string(),
            "unknown_constant".to_string()
        )]
    );
}
