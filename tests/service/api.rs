//! What all of the API has in common: problems, request ids, documentation.

use crate::common::server::{Server, send};
use reqwest::Method;
use trimtab::http::{Config, code::Code};

async fn server() -> Server {
    Server::start_with(Config::default(), 0).await
}

#[tokio::test]
async fn unknown_routes_and_methods_are_problems_too() {
    let server = server().await;
    for path in [
        "/nope",
        "/v1",
        "/v1/jobs/x/y/z",
        "/v1/maneuvers/",
        "/docs/nope",
    ] {
        assert_eq!(
            server.get(path).await.problem(404, "unknown_route"),
            [],
            "{path}"
        );
    }
    let answer = send(server.request(Method::DELETE, "/v1/jobs")).await;
    assert_eq!(answer.problem(405, "method_not_allowed"), []);
    assert!(
        answer.header("allow").contains("POST"),
        "{}",
        answer.header("allow")
    );
    assert_eq!(
        server
            .get("/v1/maneuvers/%ff")
            .await
            .problem(400, "invalid_path"),
        []
    );
    assert_eq!(
        server
            .get("/v1/jobs?limit=%ff")
            .await
            .problem(400, "invalid_query"),
        []
    );
}

#[tokio::test]
async fn every_request_has_an_id() {
    let server = server().await;
    let first = server
        .get("/v1/jobs")
        .await
        .header("x-request-id")
        .to_string();
    let second = server
        .get("/v1/jobs")
        .await
        .header("x-request-id")
        .to_string();
    assert!(!first.is_empty() && first != second);
    let with = async |id: &str| {
        let request = server
            .request(Method::GET, "/nope")
            .header("x-request-id", id);
        let answer = send(request).await;
        answer.problem(404, "unknown_route");
        answer.header("x-request-id").to_string()
    };
    assert_eq!(with("mine-1.2:3").await, "mine-1.2:3");
    assert_ne!(with("not one\" id").await, "not one\" id");
    assert_ne!(with(&"x".repeat(65)).await, "x".repeat(65));
}

#[tokio::test]
async fn pages_of_other_origins_cannot_act() {
    let server = server().await;
    let request = server
        .request(Method::POST, "/v1/jobs")
        .header("origin", "https://example.org");
    let answer = send(request.header("sec-fetch-site", "cross-site").body("{}")).await;
    assert_eq!(answer.problem(403, "cross_origin"), []);
}

#[tokio::test]
async fn the_type_of_a_problem_explains_it() {
    let server = server().await;
    let problem = server.get("/nope").await.json();
    let explained = server.get(problem["type"].as_str().unwrap()).await.json();
    assert_eq!(explained["code"], problem["code"]);
    let all = server.get("/v1/problems").await.json();
    assert_eq!(all["problems"].as_array().unwrap().len(), Code::ALL.len());
    assert_eq!(
        server
            .get("/v1/problems/nope")
            .await
            .problem(404, "unknown_code"),
        []
    );
}

#[tokio::test]
async fn health_and_documentation_are_there_offline() {
    let server = server().await;
    for path in ["/health/live", "/health/ready"] {
        assert_eq!(server.get(path).await.json()["status"], "ok");
    }
    for path in ["/", "/docs/"] {
        let page = server.get(path).await;
        assert_eq!(page.status, 200);
        assert!(
            !page.text().contains("https://"),
            "nothing is fetched from elsewhere"
        );
    }
    assert!(server.get("/docs/").await.text().contains("swagger-ui"));
    assert!(server.get("/docs/swagger-ui-bundle.js").await.bytes.len() > 100_000);
    assert_eq!(server.get("/openapi.json").await.json()["openapi"], "3.1.0");
}

/// `openapi/trimtab.json` is what reviewers and client generators read.
#[test]
fn the_committed_openapi_document_is_that_of_the_code() {
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_trimtab"))
        .arg("openapi")
        .output()
        .unwrap();
    let current = String::from_utf8(output.stdout).unwrap();
    let committed = include_str!("../../openapi/trimtab.json");
    assert!(
        current == committed,
        "the API has changed; look at the difference after: cargo run -- openapi > openapi/trimtab.json"
    );
}

#[test]
fn every_operation_and_every_reference_is_described() {
    let document: serde_json::Value =
        serde_json::from_str(include_str!("../../openapi/trimtab.json")).unwrap();
    let mut names = Vec::new();
    for (path, item) in document["paths"].as_object().unwrap() {
        for (method, operation) in item.as_object().unwrap() {
            let text = |key: &str| operation[key].as_str().unwrap_or_default().to_string();
            assert!(!text("summary").is_empty(), "{method} {path}");
            names.push(text("operationId"));
        }
    }
    assert_eq!(undescribed(&document), Vec::<String>::new());
    let count = names.len();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), count, "operation ids are distinct");
    let schemas = document["components"]["schemas"].as_object().unwrap();
    let text = document.to_string();
    for reference in text.split("\"#/components/schemas/").skip(1) {
        let name = reference.split('"').next().unwrap();
        assert!(schemas.contains_key(name), "{name}");
    }
}

/// Places of the document without a word about them: parameters, schemas, and fields of schemas (a reference is described
/// where it leads).
fn undescribed(document: &serde_json::Value) -> Vec<String> {
    let mut places = Vec::new();
    for (path, item) in document["paths"].as_object().unwrap() {
        for (method, operation) in item.as_object().unwrap() {
            for parameter in operation["parameters"].as_array().into_iter().flatten() {
                if parameter["description"].is_null() {
                    places.push(format!("{method} {path} {}", parameter["name"]));
                }
            }
        }
    }
    let schemas = document["components"]["schemas"].as_object().unwrap();
    for (name, schema) in schemas {
        if schema["description"].is_null() {
            places.push(name.clone());
        }
        fields(name, schema, &mut places);
    }
    places
}

fn fields(name: &str, schema: &serde_json::Value, places: &mut Vec<String>) {
    for (field, property) in schema["properties"].as_object().into_iter().flatten() {
        let mut parts = ["oneOf", "allOf", "anyOf"].into_iter();
        let in_a_part = parts.any(|kind| {
            let items = property[kind].as_array().into_iter().flatten();
            items
                .into_iter()
                .any(|item| item["description"].is_string())
        });
        if property["description"].is_null() && !in_a_part && property["$ref"].is_null() {
            places.push(format!("{name}.{field}"));
        }
    }
    for kind in ["oneOf", "allOf", "anyOf"] {
        for item in schema[kind].as_array().into_iter().flatten() {
            fields(name, item, places);
        }
    }
}
