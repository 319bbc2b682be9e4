//! Structure determination over HTTP: from a recording to an equation.

use crate::common::server::Server;
use serde_json::json;
use trimtab::structure::{StepVerdict, Structure};

/// Lift over angle of attack, with a term of the second order that is there and elevator that is not.
fn recording() -> String {
    let mut csv = "t[s],alpha[rad],de[rad],CL[-]\n".to_string();
    for k in 0..300 {
        let t = f64::from(k) * 0.05;
        let alpha = 0.08 + 0.06 * (0.9 * t).sin() + 0.02 * (2.1 * t).cos();
        let de = 0.05 * (1.3 * t).sin();
        let noise = 0.002
            * (f64::from(k) * 12.9898)
                .sin()
                .mul_add(43_758.547, 0.0)
                .fract();
        let lift = 0.2 + 4.5 * alpha - 6.0 * alpha * alpha + noise;
        csv += &format!("{t},{alpha},{de},{lift}\n");
    }
    csv
}

#[tokio::test]
async fn an_equation_is_found_and_its_steps_are_told() {
    let server = Server::start().await;
    let maneuver = server.upload(&recording()).await;
    let model = json!({
        "name": "lift",
        "inputs": {"alpha": {"unit": "rad"}, "de": {"unit": "rad"}},
        "outputs": {"CL": {"unit": "-", "equation": "0"}},
    });
    let spec = json!({
        "kind": "structure", "model": model, "maneuvers": [{"id": maneuver}],
        "structure": {"output": "CL", "variables": ["alpha", "de"], "order": 2, "f_to_enter": 10.0, "f_to_remove": 10.0},
    });
    let id = server.submit(&spec).await;
    let done = server.wait(&id).await;
    assert_eq!(
        (&done["status"], &done["kind"]),
        (&json!("succeeded"), &json!("structure"))
    );
    assert_eq!(
        done["links"]["structure"],
        format!("/v1/jobs/{id}/structure")
    );
    let answer = server.get(&format!("/v1/jobs/{id}/structure")).await;
    assert_eq!(answer.status, 200, "{}", answer.text());
    let found: Structure = serde_json::from_value(answer.json()).unwrap();
    assert_eq!(found.candidates, 5);
    let names: Vec<&str> = found.terms.iter().map(|term| term.term.as_str()).collect();
    assert_eq!(names, ["1", "alpha", "alpha^2"]);
    assert_eq!(found.steps[0].verdict, StepVerdict::Start);
    assert!(
        found
            .terms
            .iter()
            .zip([0.2, 4.5, -6.0])
            .all(|(term, truth)| { (term.estimate - truth).abs() < 4.0 * term.standard_error })
    );
    let model = server.get(&format!("/v1/jobs/{id}/model")).await.json();
    assert_eq!(model["outputs"]["CL"]["equation"], found.equation);
    // the report tells how terms were chosen, and of no integration of a model without states
    let report = server.get(&format!("/jobs/{id}/report")).await.text();
    for part in [
        "stepwise regression of CL: partial F to enter 10",
        "the start values being those of the regression",
    ] {
        assert!(report.contains(part), "{part}");
    }
    assert!(!report.contains("<dt>integrator"), "{report}");
    // its time histories are those of the equation
    let estimate = server.get(&format!("/v1/jobs/{id}/estimate")).await.json();
    assert!(estimate["outputs"][0]["r_squared"].as_f64().unwrap() > 0.999);
    // and a job of another kind has none
    let plain = server
        .submit(&crate::common::jobs::job(
            &server.upload(&crate::common::recordings::elevator()).await,
        ))
        .await;
    server.wait(&plain).await;
    assert_eq!(
        server
            .get(&format!("/v1/jobs/{plain}/structure"))
            .await
            .status,
        404
    );
}
