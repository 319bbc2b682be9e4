//! Model documents over HTTP.

use crate::common::server::{Server, send};
use reqwest::Method;
use serde_json::{Value, json};
use trimtab::http::Config;
use trimtab::model::{ModelDocument, catalog};

async fn server() -> Server {
    Server::start_with(Config::default(), 0).await
}

fn short_period() -> Value {
    serde_json::to_value(catalog::find("short-period").unwrap()).unwrap()
}

#[tokio::test]
async fn a_stored_model_can_be_named_in_a_job() {
    let server = server().await;
    let mut document = short_period();
    document["name"] = json!("my-model");
    let answer = server.post_json("/v1/models", &document).await;
    assert_eq!(answer.status, 201, "{}", answer.text());
    let stored = answer.json();
    assert_eq!(
        (&stored["name"], &stored["origin"]),
        (&json!("my-model"), &json!("stored"))
    );
    let id = stored["id"].as_str().unwrap();
    assert_eq!(answer.header("location"), format!("/v1/models/{id}"));
    assert_eq!(
        server.get(&format!("/v1/models/{id}")).await.json(),
        document
    );

    let maneuver = server.upload(&crate::common::recordings::elevator()).await;
    let spec = json!({"model": id, "maneuvers": [{"id": maneuver}]});
    assert_eq!(server.post_json("/v1/jobs", &spec).await.status, 202);
}

#[tokio::test]
async fn json_and_toml_are_one_document() {
    let server = server().await;
    let toml = server
        .get_as("/v1/models/short-period", "application/toml")
        .await;
    assert_eq!(toml.header("content-type"), "application/toml");
    let document: ModelDocument = toml::from_str(&toml.text()).unwrap();
    assert_eq!(Some(&document), catalog::find("short-period").as_ref());
    let stored = server
        .post("/v1/models", "application/toml", toml.text())
        .await;
    assert_eq!(stored.status, 201, "{}", stored.text());
    let path = stored.header("location").to_string();
    let json: ModelDocument = serde_json::from_value(server.get(&path).await.json()).unwrap();
    assert_eq!(json, document);
    let etag = toml.header("etag");
    let again = server.request(Method::GET, "/v1/models/short-period?format=toml");
    assert_eq!(send(again.header("if-none-match", etag)).await.status, 304);
}

#[tokio::test]
async fn the_list_is_the_catalog_and_then_what_was_stored() {
    let server = server().await;
    let mut stored = Vec::new();
    for _ in 0..3 {
        let model = server.post_json("/v1/models", &short_period()).await.json();
        stored.insert(0, model["id"].as_str().unwrap().to_string());
    }
    let mut expected: Vec<String> = catalog::all().into_iter().map(|model| model.name).collect();
    expected.extend(stored);
    for limit in [1, 2, 3, 5, 200] {
        let (mut seen, mut query) = (Vec::new(), String::new());
        loop {
            let page = server
                .get(&format!("/v1/models?limit={limit}{query}"))
                .await
                .json();
            let models = page["models"].as_array().unwrap();
            assert!(models.len() <= limit);
            seen.extend(
                models
                    .iter()
                    .map(|model| model["id"].as_str().unwrap().to_string()),
            );
            match page["next_cursor"].as_str() {
                Some(cursor) => query = format!("&cursor={cursor}"),
                None => break,
            }
        }
        assert_eq!(seen, expected, "limit {limit}");
    }
    assert_eq!(
        server
            .get("/v1/models?cursor=x")
            .await
            .problem(400, "invalid_cursor"),
        []
    );
}

#[tokio::test]
async fn faults_of_a_model_are_pointed_at_all_at_once() {
    let server = server().await;
    let mut document = short_period();
    document["states"]["q"]["derivative"] = json!("Ma*alpah");
    document["outputs"]["q"]["equation"] = json!("q + alpha");
    let answer = server.post_json("/v1/models", &document).await;
    let pointers: Vec<String> = answer
        .problem(422, "invalid_model")
        .into_iter()
        .map(|(pointer, _)| pointer)
        .collect();
    assert!(
        pointers.contains(&"/states/q/derivative".to_string()),
        "{pointers:?}"
    );
    assert!(
        pointers.contains(&"/outputs/q/equation".to_string()),
        "{pointers:?}"
    );

    let toml = "name = \"x\"\n[states.q]\ninitial = ";
    let answer = server.post("/v1/models", "application/toml", toml).await;
    assert_eq!(answer.problem(400, "invalid_toml"), []);
    assert!(
        answer.json()["detail"].as_str().unwrap().contains("line 3"),
        "{}",
        answer.text()
    );
    let answer = server
        .post(
            "/v1/models",
            "application/toml",
            "a = ".to_string() + &"[".repeat(100_000),
        )
        .await;
    assert_eq!(answer.problem(400, "invalid_toml"), []);
    let answer = server.post("/v1/models", "text/plain", "x").await;
    assert_eq!(answer.problem(415, "unsupported_media_type"), []);
    assert_eq!(
        server
            .get("/v1/models/nope")
            .await
            .problem(404, "unknown_model"),
        []
    );
}

#[tokio::test]
async fn hostile_models_are_refused_in_no_time() {
    let server = server().await;
    let mut deep = short_period();
    deep["states"]["q"]["derivative"] =
        json!(format!("{}q{}", "(".repeat(100_000), ")".repeat(100_000)));
    let mut wide = short_period();
    for number in 0..500 {
        wide["states"][format!("x{number}")] = json!({"initial": "0", "derivative": "0"});
    }
    for (document, what) in [(deep, "deep"), (wide, "wide")] {
        let started = std::time::Instant::now();
        let answer = server.post_json("/v1/models", &document).await;
        assert!(!answer.problem(422, "invalid_model").is_empty(), "{what}");
        assert!(started.elapsed().as_secs() < 5, "{what}");
    }
}
