//! Diagnoses over HTTP: what a model lacks, from the recordings to a model that has it.

use crate::common::jobs::job;
use crate::common::recordings::{elevator, elevator_of};
use crate::common::server::Server;
use crate::common::sse::Stream;
use serde_json::{Value, json};
use trimtab::diagnose::{Diagnosis, Verdict};
use trimtab::estimate::Role;
use trimtab::http::Config;
use trimtab::model::{Model, catalog};
use trimtab::simulate::Scenario;

const FIT: &str = include_str!("../../data/effects/elevator-backlash-fit.csv");
const CHECK: &str = include_str!("../../data/effects/elevator-backlash-check.csv");
const FINAL: &str = include_str!("../../data/effects/elevator-backlash-final.csv");

/// A diagnosis on the flights of an elevator with play; its id.
async fn submit(server: &Server) -> String {
    let mut uses = Vec::new();
    for (csv, role) in [(FIT, "estimation"), (CHECK, "validation"), (FINAL, "final")] {
        uses.push(json!({"id": server.upload(csv).await, "label": role, "role": role}));
    }
    let spec = json!({"kind": "diagnose", "model": "short-period", "maneuvers": uses});
    server.submit(&spec).await
}

async fn diagnosis(server: &Server, id: &str) -> Diagnosis {
    let answer = server.get(&format!("/v1/jobs/{id}/diagnosis")).await;
    assert_eq!(answer.status, 200, "{}", answer.text());
    serde_json::from_value(answer.json()).unwrap()
}

#[tokio::test]
async fn a_diagnosis_tells_its_steps_and_names_what_is_missing() {
    let server = Server::start().await;
    let id = submit(&server).await;
    let live = Stream::open(&server.url, &id, None).await.unwrap();
    let events = live.rest().await;
    let steps: Vec<Value> = (events.iter())
        .filter(|event| event.event == "diagnosis")
        .map(|event| serde_json::from_str(&event.data).unwrap())
        .collect();
    let of = |step: &str| -> Vec<&Value> {
        let same = steps.iter().filter(|event| event["step"] == step);
        same.collect()
    };
    assert_eq!(steps[0]["step"], "fitted");
    assert_eq!(steps[0]["round"], 0);
    let screened = of("screened");
    assert!(screened[0]["candidates"].as_u64() > screened[0]["visible"].as_u64());
    assert!(!of("tried").is_empty());
    let accepted = of("accepted");
    assert_eq!(accepted.len(), 1, "{accepted:?}");
    assert_eq!(accepted[0]["name"], "backlash of de");

    let done = server.wait(&id).await;
    assert_eq!(
        (&done["status"], &done["kind"]),
        (&json!("succeeded"), &json!("diagnose"))
    );
    let jobs = server.get("/v1/jobs?kind=diagnose").await.json();
    assert_eq!(jobs["jobs"][0]["id"], id.as_str());

    let diagnosis = diagnosis(&server, &id).await;
    assert!(matches!(
        diagnosis.verdict,
        Verdict::Named | Verdict::NamedGroup
    ));
    let [effect] = &diagnosis.effects[..] else {
        panic!("{}", diagnosis.sentence);
    };
    assert_eq!(effect.effect.name(), "backlash of de");
    assert!(effect.evidence.likelihood_ratio > effect.evidence.threshold);
    assert!(effect.evidence.held_out.unwrap() > 0.0);
    let size = &effect.parameters[0];
    assert_eq!(
        (size.name.as_str(), size.unit.as_str()),
        ("de_backlash", "rad")
    );
    let off = (size.estimate - 0.005235987755982988).abs();
    assert!(off < 4.0 * size.standard_error.unwrap(), "{size:?}");

    assert!(diagnosis.refused.len() > 20);
    assert!(
        diagnosis
            .refused
            .iter()
            .all(|refused| !refused.sentence.is_empty())
    );
    for role in [Role::Estimation, Role::Validation, Role::Final] {
        let fits = diagnosis.fits.iter().filter(|fit| fit.role == role);
        let ratios: Vec<f64> = fits.map(|fit| fit.after.rms / fit.before.rms).collect();
        assert_eq!(ratios.len(), 2, "{role:?}");
        assert!(
            ratios.iter().all(|ratio| *ratio < 0.8),
            "{role:?}: {ratios:?}"
        );
    }
    let changed: Vec<&str> = diagnosis
        .diff
        .iter()
        .map(|change| change.pointer.as_str())
        .collect();
    assert!(changed.contains(&"/parameters/de_backlash"), "{changed:?}");
    assert!(
        diagnosis
            .parameters
            .iter()
            .any(|parameter| parameter.name == "Mde")
    );
    assert_eq!(diagnosis.residuals.len(), 2);
    // each segment is there as the declared model has it, too
    let histories = server.get(&format!("/v1/jobs/{id}/time-histories")).await;
    let histories = histories.json()["segments"].take();
    for segment in histories.as_array().unwrap() {
        let alpha = &segment["outputs"][0];
        let samples = alpha["model"].as_array().unwrap().len();
        assert_eq!(alpha["declared"].as_array().unwrap().len(), samples);
        assert_ne!(alpha["declared"], alpha["model"]);
    }
    // along the trajectory of the model with its effects
    let trajectories = server
        .get(&format!("/v1/jobs/{id}/trajectories?names=q"))
        .await;
    let modelled = &histories[0]["outputs"][1];
    let quantities = trajectories.json()["segments"][0]["quantities"].take();
    assert_eq!(modelled["name"], "q");
    let apart = |k: usize| {
        let of = |values: &serde_json::Value| values[k].as_f64().unwrap();
        (of(&quantities[1]["values"]) - of(&modelled["model"])).abs()
    };
    assert!(
        (0..600).all(|k| apart(k) < 1e-9),
        "{}",
        quantities[1]["name"]
    );
    let estimate = server.get(&format!("/v1/jobs/{id}/estimate")).await.json();
    let names = estimate["parameters"].as_array().unwrap();
    assert!(names.iter().any(|row| row["name"] == "de_backlash"));
}

#[tokio::test]
async fn what_results_is_a_model_that_can_be_fitted_again() {
    let server = Server::start().await;
    let id = submit(&server).await;
    server.wait(&id).await;
    let mut document = server.get(&format!("/v1/jobs/{id}/diagnosis")).await.json()["model"].take();
    document["name"] = json!("short-period-with-play");
    let stored = server.post_json("/v1/models", &document).await;
    assert_eq!(stored.status, 201, "{}", stored.text());
    let model = stored.json()["id"].clone();
    let spec = json!({"model": model, "maneuvers": [{"id": server.upload(FINAL).await}]});
    let again = server.submit(&spec).await;
    let done = server.wait(&again).await;
    assert_eq!(done["outcome"], "converged", "{done:#}");
    let table = server
        .get(&format!("/v1/jobs/{again}/parameters"))
        .await
        .json();
    let rows = table["parameters"].as_array().unwrap();
    let play = rows
        .iter()
        .find(|row| row["name"] == "de_backlash")
        .unwrap();
    let off = (play["estimate"].as_f64().unwrap() - 0.005236).abs();
    assert!(
        off < 4.0 * play["standard_error"].as_f64().unwrap(),
        "{play}"
    );
}

#[tokio::test]
async fn a_candidate_of_the_users_own_is_tried_and_named() {
    // no effect of the catalogue changes with time like this
    let term = "t*(de + 0.02)";
    let mut scenario: Scenario = toml::from_str(include_str!("../../data/elevator.toml")).unwrap();
    let effect = json!({"kind": "missing_term", "target": "q", "term": term, "value": 0.1});
    scenario.effects = vec![serde_json::from_value(effect).unwrap()];
    let design = json!({
        "shape": "multisine", "start": 6.0, "duration": 16.0, "amplitude": 2.0,
        "frequencies": [0.125, 0.25, 0.375, 0.5, 0.6875, 0.9375],
    });
    scenario.inputs["de"].design = serde_json::from_value(design).unwrap();
    let model = Model::compile(&catalog::find("short-period").unwrap()).unwrap();
    let csv = trimtab::ingest::to_csv(&scenario.fly(&model).unwrap(), |_| true);

    let server = Server::start().await;
    let mut spec = job(&server.upload(&csv).await);
    spec["kind"] = json!("diagnose");
    spec["candidates"] = json!([{
        "name": "elevator that loses its power",
        "edits": [{"kind": "missing_term", "target": "q", "term": term, "parameter": "Mdet"}],
    }]);
    let id = server.submit(&spec).await;
    server.wait(&id).await;
    let diagnosis = diagnosis(&server, &id).await;
    let [named] = &diagnosis.effects[..] else {
        panic!("{}", diagnosis.sentence);
    };
    let own = "elevator that loses its power";
    assert!(
        named.group.iter().any(|member| member.effect.name() == own),
        "{named:?}"
    );
    assert_eq!(named.effect.word(), "own", "{}", diagnosis.sentence);
    assert_eq!(named.parameters[0].name, "Mdet");
    let (size, error) = (
        named.parameters[0].estimate,
        named.parameters[0].standard_error,
    );
    assert!((size - 0.1).abs() < 4.0 * error.unwrap(), "{size}");
}

#[tokio::test]
async fn a_diagnosis_that_runs_is_cancelled() {
    let server = Server::start().await;
    let mut spec = job(&server.upload(&elevator_of(1000.0, 3)).await);
    spec["kind"] = json!("diagnose");
    let id = server.submit(&spec).await;
    let mut stream = Stream::open(&server.url, &id, None).await.unwrap();
    while stream.next().await.expect("it runs").event != "diagnosis" {}
    let asked = server
        .post(&format!("/v1/jobs/{id}/cancel"), "text/plain", "")
        .await;
    assert_eq!(asked.status, 202, "{}", asked.text());
    let done = server.wait(&id).await;
    assert_eq!(
        (&done["status"], &done["outcome"]),
        (&json!("cancelled"), &json!("cancelled")),
        "{done:#}"
    );
    // the declared model's estimate is kept, a verdict there is not
    assert_eq!(done["has_result"], true);
    let estimate = server.get(&format!("/v1/jobs/{id}/estimate")).await.json();
    assert_eq!(estimate["outcome"], "cancelled");
    let none = server.get(&format!("/v1/jobs/{id}/diagnosis")).await;
    assert_eq!(none.problem(404, "no_result"), []);
}

#[tokio::test]
async fn what_a_diagnosis_cannot_start_from_is_refused() {
    let server = Server::start_with(Config::default(), 0).await;
    let mut spec = job(&server.upload(&elevator()).await);
    spec["kind"] = json!("diagnose");
    let faults = async |change: &dyn Fn(&mut Value)| {
        let mut spec = spec.clone();
        change(&mut spec);
        let answer = server.post_json("/v1/jobs", &spec).await;
        answer.problem(422, "invalid_job")
    };
    let fault = |pointer: &str, code: &str| vec![(pointer.to_string(), code.to_string())];

    let unfit = json!([
        {"name": "good", "edits": [{"kind": "sensor_lag", "target": "q"}]},
        {"name": "bad", "edits": [{"kind": "sensor_lag", "target": "theta"}]},
    ]);
    assert_eq!(
        faults(&|spec| spec["candidates"] = unfit.clone()).await,
        fault("/candidates/1/edits", "unknown_target")
    );
    let mismatch = json!([{"name": "bad", "edits": [{"kind": "missing_term", "target": "q", "term": "alpha + q"}]}]);
    assert_eq!(
        faults(&|spec| spec["candidates"] = mismatch.clone()).await,
        fault("/candidates/0/edits", "unit_mismatch")
    );
    let many = json!(vec![
        json!({"name": "lag", "edits": [{"kind": "sensor_lag", "target": "q"}]});
        101
    ]);
    assert_eq!(
        faults(&|spec| spec["candidates"] = many.clone()).await,
        fault("/candidates", "job_too_large")
    );
    assert_eq!(
        faults(&|spec| spec["options"] = json!({"estimator": "filter_error"})).await,
        fault("/options/estimator", "bad_option")
    );
    let adjoint = json!({"derivatives": {"technique": "adjoint"}});
    assert_eq!(
        faults(&|spec| spec["options"] = adjoint.clone()).await,
        fault("/options/derivatives", "bad_option")
    );
}

#[tokio::test]
async fn there_is_no_diagnosis_before_the_end_nor_of_other_jobs() {
    let idle = Server::start_with(Config::default(), 0).await;
    let mut spec = job(&idle.upload(&elevator()).await);
    spec["kind"] = json!("diagnose");
    let id = idle.submit(&spec).await;
    let answer = idle.get(&format!("/v1/jobs/{id}/diagnosis")).await;
    assert_eq!(answer.problem(409, "not_finished"), []);
    let nobody = format!("/v1/jobs/{}/diagnosis", uuid::Uuid::nil());
    assert_eq!(idle.get(&nobody).await.problem(404, "unknown_job"), []);

    let server = Server::start().await;
    let id = server.submit(&job(&server.upload(&elevator()).await)).await;
    server.wait(&id).await;
    let answer = server.get(&format!("/v1/jobs/{id}/diagnosis")).await;
    assert_eq!(answer.problem(404, "no_result"), []);
}
