//! The document of the API is what the service does: its examples run as they stand, and events are what it says of them.

use serde_json::{Value, json};

use crate::common::server::Server;

/// The examples of a request, by name.
fn examples(document: &Value, path: &str) -> Vec<(String, Value)> {
    let content = &document["paths"][path]["post"]["requestBody"]["content"];
    let examples = content["application/json"]["examples"].as_object();
    let examples = examples.unwrap_or_else(|| panic!("{path} has examples"));
    let of = |(name, example): (&String, &Value)| (name.clone(), example["value"].clone());
    examples.iter().map(of).collect()
}

fn example(document: &Value, path: &str) -> Value {
    let mut all = examples(document, path);
    assert_eq!(all.len(), 1, "{path}");
    all.remove(0).1
}

#[tokio::test]
async fn every_example_of_the_document_runs_as_it_stands() {
    let server = Server::start().await;
    let document = server.get("/openapi.json").await.json();
    let uploaded = server
        .post_json("/v1/maneuvers", &example(&document, "/v1/maneuvers"))
        .await;
    assert_eq!(uploaded.status, 201, "{}", uploaded.text());
    let recording = uploaded.json()["id"].as_str().unwrap().to_string();

    let jobs = examples(&document, "/v1/jobs");
    let mut ids = std::collections::BTreeMap::new();
    for (name, spec) in &jobs {
        let id = server.submit(spec).await;
        let job = server.wait(&id).await;
        assert_eq!(job["status"], "succeeded", "{name}: {job:#}");
        let outcome = job["outcome"].as_str().unwrap();
        assert!(
            ["converged", "at_bound"].contains(&outcome),
            "{name}: {outcome}"
        );
        ids.insert(name.as_str(), id);
    }
    let kinds = [
        "derivative_study",
        "diagnosis",
        "filter_error",
        "fit",
        "structure",
    ];
    assert_eq!(ids.keys().copied().collect::<Vec<_>>(), kinds);

    // the elevator of the example was simulated with a lag of 0.15 s
    let found = server
        .get(&format!("/v1/jobs/{}/diagnosis", ids["diagnosis"]))
        .await
        .json();
    assert_eq!(
        found["effects"][0]["kind"], "actuator_lag",
        "{}",
        found["sentence"]
    );
    let lag = &found["effects"][0]["parameters"][0];
    let [size, error] = ["estimate", "standard_error"].map(|key| lag[key].as_f64().unwrap());
    assert!((size - 0.15).abs() < 4.0 * error, "{size} ± {error}");

    for (path, at) in [
        ("/v1/jobs/{id}/predictions", ids["fit"].as_str()),
        ("/v1/maneuvers/{id}/frequency-responses", &recording),
        ("/v1/simulations", ""),
    ] {
        let answer = server
            .post_json(&path.replace("{id}", at), &example(&document, path))
            .await;
        assert_eq!(answer.status, 200, "{path}: {}", answer.text());
    }
    let bulk = example(&document, "/v1/jobs/bulk");
    let submitted = server.post_json("/v1/jobs/bulk", &bulk).await;
    assert_eq!(submitted.status, 202, "{}", submitted.text());
    for job in submitted.json()["jobs"].as_array().unwrap() {
        let job = server.wait(job["id"].as_str().unwrap()).await;
        assert_eq!(job["status"], "succeeded", "{job:#}");
    }
    for id in ids.values() {
        events_are_as_described(&server, &document, id).await;
    }
}

/// Each event has the fields that its kind has, and all that this always has.
async fn events_are_as_described(server: &Server, document: &Value, job: &str) {
    let path = format!("/v1/jobs/{job}/events?limit=1000");
    let page = server.get_as(&path, "application/json").await.json();
    let schemas = &document["components"]["schemas"];
    let kinds = &schemas["Event"]["discriminator"];
    assert_eq!(kinds["propertyName"], "type");
    for event in page["events"].as_array().unwrap() {
        let kind = event["type"].as_str().unwrap();
        let schema = kinds["mapping"][kind]
            .as_str()
            .unwrap_or_else(|| panic!("{kind} is described"));
        assert!(
            schemas["Event"]["oneOf"]
                .as_array()
                .unwrap()
                .contains(&json!({"$ref": schema}))
        );
        let schema = &schemas[schema.rsplit('/').next().unwrap()];
        let known = schema["properties"].as_object().unwrap();
        for field in event.as_object().unwrap().keys() {
            assert!(known.contains_key(field), "{kind} has {field}");
        }
        for field in schema["required"].as_array().unwrap() {
            let field = field.as_str().unwrap();
            assert!(event.get(field).is_some(), "{kind} lacks {field}: {event}");
        }
    }
}

#[tokio::test]
async fn a_file_is_the_recording_that_it_is_by_its_own_type() {
    let server = Server::start_with(trimtab::http::Config::default(), 0).await;
    let csv = std::fs::read_to_string("data/rudder.csv").unwrap();
    let octets = "application/octet-stream";
    let first = server
        .post("/v1/maneuvers/files?name=rudder", octets, csv.clone())
        .await;
    assert_eq!(first.status, 201, "{}", first.text());
    assert_eq!(first.json()["name"], "rudder");
    assert_eq!(
        server.upload(&csv).await,
        first.json()["id"].as_str().unwrap()
    );
    let refused = server.post("/v1/maneuvers/files", octets, "no table").await;
    assert!(!refused.problem(422, "invalid_maneuver").is_empty());
}
