//! Derivative techniques and derivative studies, asked for over HTTP.

use crate::common::jobs::job;
use crate::common::recordings::elevator;
use crate::common::server::Server;
use serde_json::{Value, json};
use trimtab::estimate::study::DerivativeStudy;

fn with(job: &Value, key: &str, value: Value) -> Value {
    let mut job = job.clone();
    job[key] = value;
    job
}

#[tokio::test]
async fn a_study_has_its_events_its_result_and_its_page() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let spec = with(&job(&maneuver), "kind", json!("derivative_study"));
    let id = server.submit(&spec).await;
    let done = server.wait(&id).await;
    assert_eq!(
        (&done["status"], &done["kind"]),
        (&json!("succeeded"), &json!("derivative_study")),
        "{done:#}"
    );

    let answer = server.get(&format!("/v1/jobs/{id}/derivative-study")).await;
    let study: DerivativeStudy = serde_json::from_value(answer.json()).unwrap();
    assert_eq!(
        (study.size.states, study.size.outputs, study.size.samples),
        (2, 2, 626)
    );
    let techniques: Vec<&str> = study
        .techniques
        .iter()
        .map(|t| t.technique.as_str())
        .collect();
    let all = [
        "forward_difference",
        "central_difference",
        "complex_step",
        "forward_sensitivities",
        "adjoint",
    ];
    assert_eq!(techniques, all);
    for technique in &study.techniques {
        assert_eq!(technique.outcome, "converged", "{technique:?}");
        // each stops within 1e-5 standard errors of the minimum
        assert!(technique.cost_excess < 1e-8, "{technique:?}");
        assert!(technique.wall_seconds > 0.0 && technique.operations > 0 && technique.bytes > 0);
    }

    // the shape of the curves: differences have a best step between the largest and the smallest, near √ε and ∛ε,
    // and lose everything at the ends; the complex step has only a largest step to avoid
    let curve = |name: &str| {
        study
            .error_curves
            .iter()
            .find(|c| c.technique == name)
            .unwrap()
    };
    for (name, step, error) in [
        ("forward_difference", 1.5e-8, 1e-5),
        ("central_difference", 6e-6, 1e-8),
    ] {
        let (best, least) = curve(name).best().unwrap();
        assert!(
            (best / step).log10().abs() <= 2.0 && least < error,
            "{name}: {best:e} {least:e}"
        );
        let last = curve(name).points.last().unwrap();
        assert!(last.step < 2e-16 && last.error.unwrap() > 0.1, "{last:?}");
    }
    for point in curve("complex_step")
        .points
        .iter()
        .filter(|point| point.step <= 1e-8)
    {
        assert!(point.error.unwrap() < 1e-12, "{point:?}");
    }

    let log = server.get(&format!("/v1/jobs/{id}/events")).await.json();
    let findings: Vec<&Value> = log["events"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|e| e["type"] == "finding")
        .collect();
    assert!(
        findings.len() > 10
            && findings[0]["finding"]
                .as_str()
                .unwrap()
                .contains("forward_difference")
    );
    let page = server
        .get_as(&format!("/jobs/{id}"), "text/html")
        .await
        .text();
    assert!(page.contains("Derivative techniques") && page.matches("<svg").count() >= 3);
}

#[tokio::test]
async fn every_technique_can_be_asked_for() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let mut estimates = Vec::new();
    for derivatives in [
        json!({"technique": "forward_sensitivities"}),
        json!({"technique": "forward_difference"}),
        json!({"technique": "central_difference", "step": 1e-5}),
        json!({"technique": "complex_step", "step": 1e-300}),
        json!({"technique": "adjoint"}),
        json!({"technique": "adjoint", "scaling": "sizes"}),
    ] {
        let options = json!({"derivatives": derivatives, "max_iterations": 200});
        let id = server
            .submit(&with(&job(&maneuver), "options", options))
            .await;
        let done = server.wait(&id).await;
        assert_eq!(done["outcome"], "converged", "{derivatives} {done:#}");
        let table = server
            .get(&format!("/v1/jobs/{id}/parameters"))
            .await
            .json();
        let parameters = table["parameters"].as_array().unwrap().clone();
        estimates.push(parameters);
    }
    for other in &estimates[1..] {
        for (a, b) in estimates[0].iter().zip(other) {
            let Some(error) = a["standard_error"].as_f64() else {
                continue;
            };
            let apart = (a["estimate"].as_f64().unwrap() - b["estimate"].as_f64().unwrap()).abs();
            // each is within 1e-5 standard errors of the minimum, but where correlation lets one slide further
            assert!(apart < 1e-3 * error, "{a} {b}");
        }
    }
    // no study was asked for
    let id = server.submit(&job(&maneuver)).await;
    server.wait(&id).await;
    let answer = server.get(&format!("/v1/jobs/{id}/derivative-study")).await;
    assert_eq!(
        (answer.status.as_u16(), answer.json()["code"].clone()),
        (404, json!("no_result"))
    );
}

#[tokio::test]
async fn bad_techniques_are_refused_with_their_place() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    for (derivatives, pointer) in [
        (
            json!({"technique": "forward_difference", "step": 0.0}),
            "/options/derivatives/step",
        ),
        (
            json!({"technique": "complex_step", "step": 1e-305}),
            "/options/derivatives/step",
        ),
        (
            json!({"technique": "adjoint", "step": 1e-6}),
            "/options/derivatives",
        ),
        (
            json!({"technique": "forward_sensitivities", "step": 1e-6}),
            "/options/derivatives",
        ),
        (json!({"technique": "magic"}), "/options/derivatives"),
    ] {
        let spec = with(
            &job(&maneuver),
            "options",
            json!({"derivatives": derivatives}),
        );
        let answer = server.post_json("/v1/jobs", &spec).await;
        assert_eq!(answer.status, 422, "{derivatives} {}", answer.text());
        let text = answer.text();
        assert!(text.contains(pointer), "{derivatives} {text}");
    }
}
