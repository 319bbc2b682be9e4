//! Mappings that are kept, and uploads that name them.

use crate::common::server::{Server, send};
use reqwest::Method;
use serde_json::{Value, json};
use trimtab::http::Config;
use trimtab::ingest::Mapping;

fn logger() -> Value {
    json!({
        "about": "the lab's third logger",
        "time": {"from": "(:,1)", "unit": "s"},
        "channels": {
            "alpha": {"from": "(:,2)", "unit": "deg"},
            "q": {"from": "(:,3)", "unit": "deg/s"},
        },
    })
}

#[tokio::test]
async fn a_mapping_is_kept_once_and_named_by_uploads() {
    let server = Server::start_with(Config::default(), 0).await;
    let keep = async |name: &str, mapping: &Value| {
        server
            .post_json(&format!("/v1/mappings?name={name}"), mapping)
            .await
    };
    let kept = keep("logger-3", &logger()).await;
    assert_eq!(kept.status, 201, "{}", kept.text());
    assert_eq!(kept.header("location"), "/v1/mappings/logger-3");
    assert_eq!(server.get("/v1/mappings/logger-3").await.json(), logger());
    assert_eq!(keep("logger-3", &logger()).await.status, 201);
    let mut other = logger();
    other["channels"]["q"]["unit"] = json!("rad/s");
    keep("logger-3", &other).await.problem(409, "name_taken");
    keep("sidpac", &logger()).await.problem(409, "name_taken");
    keep("a%20b", &logger()).await.problem(400, "invalid_query");
    other["channels"]["q"]["from"] = json!(" ");
    let faults = keep("broken", &other).await.problem(422, "invalid_mapping");
    assert_eq!(faults[0].0, "/channels/q/from");

    let matrix = "0 1 2\n0.1 1.5 2.5\n0.2 2 3\n";
    let uploaded = server
        .post("/v1/maneuvers?mapping=logger-3", "text/plain", matrix)
        .await;
    assert_eq!(uploaded.status, 201, "{}", uploaded.text());
    let channels = uploaded.json()["summary"]["channels"].to_string();
    assert!(
        channels.contains("alpha") && channels.contains("deg/s"),
        "{channels}"
    );
    let unknown = server
        .post("/v1/maneuvers?mapping=logger-4", "text/plain", matrix)
        .await;
    unknown.problem(400, "invalid_query");

    let listed = server.get("/v1/mappings").await.json();
    let names: Vec<&str> = listed["mappings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["name"].as_str().unwrap())
        .collect();
    let expected: Vec<&str> = Mapping::names().chain(["logger-3"]).collect();
    assert_eq!(names, expected);
    // a bundled one can be read, changed and kept by another name
    let bundled = server.get("/v1/mappings/sidpac").await.json();
    assert_eq!(keep("sidpac-2", &bundled).await.status, 201);
    let gone = send(server.request(Method::DELETE, "/v1/mappings/logger-3")).await;
    assert_eq!(gone.status, 204);
    server
        .get("/v1/mappings/logger-3")
        .await
        .problem(404, "unknown_mapping");
    send(server.request(Method::DELETE, "/v1/mappings/sidpac"))
        .await
        .problem(404, "unknown_mapping");
}
