//! What things are called, and how they are found: over HTTP.

use crate::common::recordings::{elevator, elevator_of};
use crate::common::server::{Server, send};
use reqwest::{Method, Url};
use serde_json::{Value, json};
use trimtab::estimate::Estimate;
use trimtab::http::Config;
use trimtab::model::catalog;

/// The address of a list with what it is searched for.
fn searched(list: &str, q: &str) -> String {
    let url = Url::parse_with_params("http://x", &[("q", q)]).unwrap();
    format!("/v1/{list}?{}", url.query().unwrap())
}

/// Of the entries that a search finds, what stands in a field, newest first.
async fn found(server: &Server, list: &str, q: &str, field: &str) -> Vec<String> {
    let answer = server.get(&searched(list, q)).await;
    assert_eq!(answer.status, 200, "{}", answer.text());
    let page = answer.json();
    let entries = page[list].as_array().unwrap().iter();
    let texts = entries.map(|entry| entry[field].as_str().unwrap().to_string());
    texts.collect()
}

async fn named(server: &Server, name: &str, csv: &str) -> String {
    let url = Url::parse_with_params("http://x/v1/maneuvers", &[("name", name)]).unwrap();
    let path = format!("/v1/maneuvers?{}", url.query().unwrap());
    let answer = server.post(&path, "text/csv", csv.to_string()).await;
    answer.json()["id"].as_str().unwrap().to_string()
}

async fn stored(server: &Server, name: &str, title: &str) -> Value {
    let mut document = serde_json::to_value(catalog::find("short-period").unwrap()).unwrap();
    (document["name"], document["title"]) = (json!(name), json!(title));
    let answer = server.post_json("/v1/models", &document).await;
    assert_eq!(answer.status, 201, "{}", answer.text());
    answer.json()
}

#[tokio::test]
async fn a_job_without_a_name_is_called_by_its_model_and_maneuvers() {
    let server = Server::start().await;
    let first = named(&server, "Flight 7, 3-2-1-1", &elevator()).await;
    let second = server.upload(&elevator_of(20.0, 3)).await;
    let model = stored(&server, "mine", "").await["id"].clone();
    let spec = json!({"model": model, "maneuvers": [
        {"id": first, "seconds": [0.0, 20.0]}, {"id": second, "label": "check", "role": "validation"}]});
    let id = server.submit(&spec).await;
    let job = server.wait(&id).await;
    assert_eq!(job["status"], "succeeded", "{job:#}");
    assert_eq!(job["name"], "");
    assert_eq!(job["title"], "mine: Flight 7, 3-2-1-1, 0 to 20 s and check");
    assert_eq!(job["model"], json!({"name": "mine", "id": model}));
    let maneuvers = json!([
        {"id": first, "label": "Flight 7, 3-2-1-1, 0 to 20 s", "role": "estimation"},
        {"id": second, "label": "check", "role": "validation"}]);
    assert_eq!(job["maneuvers"], maneuvers);

    // the fit in a line is that of the estimate
    let estimate = server.get(&format!("/v1/jobs/{id}/estimate")).await.json();
    let estimate: Estimate = serde_json::from_value(estimate).unwrap();
    let mut outputs = estimate.outputs.clone();
    outputs.sort_by(|a, b| a.r_squared.total_cmp(&b.r_squared));
    let fit = json!({"output": outputs[0].name, "r_squared": outputs[0].r_squared, "theil": outputs[0].theil,
        "samples": estimate.samples});
    assert_eq!(job["fit"], fit);
    assert_eq!(
        job["warnings"]["warnings"].as_u64(),
        Some(
            estimate
                .findings
                .iter()
                .filter(|finding| finding.severity == trimtab::flight::Severity::Warning)
                .count() as u64
        )
    );

    // lists say the same; a name of its own comes before
    assert_eq!(server.get("/v1/jobs").await.json()["jobs"][0], job);
    let named =
        json!({"name": "the good one", "model": "short-period", "maneuvers": [{"id": first}]});
    let id = server.submit(&named).await;
    let job = server.get(&format!("/v1/jobs/{id}")).await.json();
    assert_eq!(job["title"], "the good one");
    assert_eq!(job["maneuvers"][0]["label"], "Flight 7, 3-2-1-1");
    let written = serde_json::to_value(catalog::find("short-period").unwrap()).unwrap();
    let id = server
        .submit(&json!({"model": written, "maneuvers": [{"id": second}]}))
        .await;
    let job = server.get(&format!("/v1/jobs/{id}")).await.json();
    assert_eq!(job["model"], json!({"name": "short-period"}));
    assert_eq!(job["title"], format!("short-period: {}", &second[..12]));
}

#[tokio::test]
async fn lists_are_searched_by_words() {
    let server = Server::start_with(Config::default(), 0).await;
    let first = named(&server, "Pitch doublet, 100%", &elevator()).await;
    let second = named(&server, "Roll_step", &elevator_of(20.0, 3)).await;
    let said = json!({"flown": {"flight": "F 12", "notes": "Gegenwind, Böen", "tags": ["keep"]}});
    let patch = server.request(Method::PATCH, &format!("/v1/maneuvers/{second}"));
    let patch = patch.header("content-type", "application/merge-patch+json");
    let answer = send(patch.body(said.to_string())).await;
    assert_eq!(answer.status, 200, "{}", answer.text());
    for (q, names) in [
        ("DOUBLET pitch", &["Pitch doublet, 100%"][..]),
        ("böen", &["Roll_step"]),
        ("BÖEN f 12 KEEP", &["Roll_step"]),
        ("o", &["Roll_step", "Pitch doublet, 100%"]),
        ("", &["Roll_step", "Pitch doublet, 100%"]),
        // no sign has a meaning
        ("%", &["Pitch doublet, 100%"]),
        ("l_s", &["Roll_step"]),
        ("h_d", &[]),
        ("' OR 1=1 --", &[]),
        ("doublet roll", &[]),
    ] {
        assert_eq!(found(&server, "maneuvers", q, "name").await, names, "{q}");
    }

    for (name, maneuver, tag) in [("", &first, "one"), ("Second Try", &second, "Two")] {
        let spec = json!({"name": name, "tags": [tag], "model": "short-period", "maneuvers": [{"id": maneuver}]});
        server.submit(&spec).await;
    }
    for (q, titles) in [
        (
            "short-period pitch",
            &["short-period: Pitch doublet, 100%"][..],
        ),
        ("second try two", &["Second Try"]),
        ("roll_step", &["Second Try"]),
        ("ONE", &["short-period: Pitch doublet, 100%"]),
        ("roll_step one", &[]),
        // ids are no words: each has every digit somewhere
        (&second[..6], &[]),
    ] {
        assert_eq!(found(&server, "jobs", q, "title").await, titles, "{q}");
    }

    stored(&server, "mine", "Kurzperiode des Segelflugzeugs, ÜBERZOGEN").await;
    assert_eq!(
        found(&server, "models", "überzogen mine", "name").await,
        ["mine"]
    );
    assert!(
        found(&server, "models", "SHORT attack", "name")
            .await
            .contains(&"short-period".to_string())
    );
    assert!(
        found(&server, "models", "nothing of the kind", "name")
            .await
            .is_empty()
    );
    for list in ["jobs", "maneuvers", "models"] {
        let answer = server.get(&searched(list, &"x".repeat(201))).await;
        assert_eq!(answer.problem(400, "invalid_query"), []);
    }
}

#[tokio::test]
async fn pages_of_a_search_follow_each_other() {
    let server = Server::start_with(Config::default(), 0).await;
    for number in 0..5 {
        stored(&server, &format!("mine-{number}"), "").await;
        stored(&server, &format!("other-{number}"), "").await;
    }
    let (mut names, mut cursor) = (Vec::new(), String::new());
    loop {
        let page = server
            .get(&format!("/v1/models?q=mine&limit=2{cursor}"))
            .await
            .json();
        let models = page["models"].as_array().unwrap();
        names.extend(
            models
                .iter()
                .map(|model| model["name"].as_str().unwrap().to_string()),
        );
        match page["next_cursor"].as_str() {
            Some(next) => cursor = format!("&cursor={next}"),
            None => break,
        }
    }
    assert_eq!(names, ["mine-4", "mine-3", "mine-2", "mine-1", "mine-0"]);
}

#[tokio::test]
async fn models_of_one_name_are_deleted_one_by_one() {
    let server = Server::start().await;
    let [old, new] = [
        stored(&server, "mine", "").await,
        stored(&server, "mine", "").await,
    ];
    assert_ne!(old["id"], new["id"]);
    assert_eq!(old["name"], new["name"]);
    let maneuver = server.upload(&elevator()).await;
    let job = server
        .submit(&json!({"model": old["id"], "maneuvers": [{"id": maneuver}]}))
        .await;
    let path = old["links"]["self"].as_str().unwrap().to_string();
    assert_eq!(
        send(server.request(Method::DELETE, &path)).await.status,
        204
    );
    server.get(&path).await.problem(404, "unknown_model");
    let again = send(server.request(Method::DELETE, &path)).await;
    again.problem(404, "unknown_model");
    let left = found(&server, "models", "mine", "id").await;
    assert_eq!(left, [new["id"].as_str().unwrap()]);
    for unknown in ["nope", "01950000-0000-7000-8000-000000000000"] {
        let answer = send(server.request(Method::DELETE, &format!("/v1/models/{unknown}"))).await;
        answer.problem(404, "unknown_model");
    }
    let catalog = send(server.request(Method::DELETE, "/v1/models/short-period")).await;
    catalog.problem(409, "of_catalog");
    assert_eq!(server.get("/v1/models/short-period").await.status, 200);

    // the job has its model still, and can be run again
    assert_eq!(server.wait(&job).await["status"], "succeeded");
    let page = server.get(&format!("/jobs/{job}")).await.text();
    assert!(
        page.contains("mine (deleted since; the job keeps its copy)"),
        "{page}"
    );
    let again = server
        .post_json(&format!("/v1/jobs/{job}/rerun"), &json!({}))
        .await;
    assert_eq!(again.status, 202, "{}", again.text());
    let again = again.json()["id"].as_str().unwrap().to_string();
    assert_eq!(server.wait(&again).await["status"], "succeeded");
}
