//! Requests that are sent twice, and answers that wait.

use crate::common::jobs::{endless_job, job};
use crate::common::recordings::elevator;
use crate::common::server::{Answer, Server, send};
use reqwest::Method;
use serde_json::{Value, json};
use trimtab::http::Config;
use trimtab::store::{NewKey, Scope};

async fn post_with(server: &Server, path: &str, key: &str, body: &Value) -> Answer {
    let request = server
        .request(Method::POST, path)
        .header("content-type", "application/json")
        .header("idempotency-key", key)
        .body(body.to_string());
    send(request).await
}

#[tokio::test]
async fn a_job_that_is_posted_twice_is_submitted_once() {
    let server = Server::start_with(Config::default(), 0).await;
    let spec = job(&server.upload(&elevator()).await);
    let first = post_with(&server, "/v1/jobs", "k-1", &spec).await;
    assert_eq!(first.status, 202, "{}", first.text());
    assert_eq!(first.header("idempotency-replayed"), "");
    let again = post_with(&server, "/v1/jobs", "k-1", &spec).await;
    assert_eq!(again.status, 202);
    assert_eq!(again.header("idempotency-replayed"), "true");
    assert_eq!(again.bytes, first.bytes);
    assert_eq!(again.header("location"), first.header("location"));

    let mut other = spec.clone();
    other["name"] = json!("another");
    let refused = post_with(&server, "/v1/jobs", "k-1", &other).await;
    assert_eq!(refused.problem(422, "idempotency_key_reused"), []);
    let second = post_with(&server, "/v1/jobs", "k-2", &spec).await;
    assert_ne!(second.json()["id"], first.json()["id"]);
    let jobs = server.get("/v1/jobs").await.json();
    assert_eq!(jobs["jobs"].as_array().unwrap().len(), 2);

    for key in ["", &"x".repeat(256), "ä"] {
        let answer = post_with(&server, "/v1/jobs", key, &spec).await;
        assert_eq!(answer.problem(400, "invalid_header"), [], "{key}");
    }
}

#[tokio::test]
async fn what_was_refused_may_be_put_right_under_its_key() {
    let server = Server::start_with(Config::default(), 0).await;
    let mut spec = job(&server.upload(&elevator()).await);
    spec["model"] = json!("no such model");
    let refused = post_with(&server, "/v1/jobs", "k", &spec).await;
    assert_eq!(
        refused.problem(422, "invalid_job"),
        [("/model".into(), "unknown_model".into())]
    );
    spec["model"] = json!("short-period");
    let accepted = post_with(&server, "/v1/jobs", "k", &spec).await;
    assert_eq!(accepted.status, 202, "{}", accepted.text());
}

/// Both are sent before either is answered: one does it, the other is told to wait or gets the same answer.
#[tokio::test]
async fn twins_submit_one_job() {
    let server = Server::start_with(Config::default(), 0).await;
    let spec = job(&server.upload(&elevator()).await);
    let twins = (0..8).map(|_| post_with(&server, "/v1/jobs", "twin", &spec));
    let answers = futures_util::future::join_all(twins).await;
    let mut accepted = 0;
    for answer in answers {
        if answer.status == 202 {
            accepted += 1;
        } else {
            answer.problem(409, "idempotency_key_in_hand");
            assert!(!answer.header("retry-after").is_empty());
        }
    }
    assert!(accepted >= 1);
    let jobs = server.get("/v1/jobs").await.json();
    assert_eq!(jobs["jobs"].as_array().unwrap().len(), 1);
}

#[tokio::test]
async fn models_and_maneuvers_are_kept_once_too() {
    let server = Server::start_with(Config::default(), 0).await;
    let model = server.get("/v1/models/short-period").await.json();
    let [first, again] = [
        post_with(&server, "/v1/models", "m", &model).await,
        post_with(&server, "/v1/models", "m", &model).await,
    ];
    assert_eq!(first.status, 201, "{}", first.text());
    assert_eq!(again.status, 201);
    assert_eq!(again.bytes, first.bytes);
    let upload = async || {
        let request = server
            .request(Method::POST, "/v1/maneuvers?name=elevator")
            .header("content-type", "text/csv")
            .header("idempotency-key", "u")
            .body(elevator());
        send(request).await
    };
    let (first, again) = (upload().await, upload().await);
    assert_eq!((first.status, again.status), (first.status, first.status));
    assert_eq!(again.bytes, first.bytes);
}

#[tokio::test]
async fn an_answer_waits_until_the_job_is_over() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let post = async |spec: &Value, preference: &str| {
        let request = server
            .request(Method::POST, "/v1/jobs")
            .header("content-type", "application/json")
            .header("prefer", preference)
            .body(spec.to_string());
        send(request).await
    };
    let done = post(&job(&maneuver), "wait=30").await;
    assert_eq!(done.status, 200, "{}", done.text());
    assert_eq!(done.json()["status"], "succeeded");
    assert_eq!(done.header("preference-applied"), "wait=30");

    let long = server
        .upload(&crate::common::recordings::elevator_of(2000.0, 5))
        .await;
    let running = post(&endless_job(&long), "wait=1").await;
    assert_eq!(running.status, 202);
    assert!(running.json()["finished"].is_null());
    let at_once = post(&job(&maneuver), "wait=soon").await;
    assert_eq!(at_once.status, 202);
    assert_eq!(at_once.header("preference-applied"), "");
}

/// What has a secret was made as often as it was asked for.
#[tokio::test]
async fn what_has_a_secret_is_made_once_and_shows_it_once() {
    let server = Server::start_with(Config::default(), 0).await;
    let admin = NewKey {
        project: "default".into(),
        name: "admin".into(),
        scopes: [Scope::Admin].into(),
        max_priority: 0,
        lifetime: None,
    };
    let (id, admin) = server.store.add_key(&admin).await.unwrap();
    let rotated = format!("/v1/keys/{}/rotate", id.id);
    let list = async |path: &str| {
        let request = server
            .request(Method::GET, path)
            .bearer_auth(admin.reveal());
        send(request).await.json()
    };
    let made = async |of: &str| {
        let listed = list(&format!("/v1/{of}")).await;
        listed[of].as_array().unwrap().len()
    };
    let hook = json!({"url": "https://example.org/hook"});
    for (path, of, body) in [
        ("/v1/webhooks", "webhooks", hook),
        ("/v1/keys", "keys", json!({"name": "another"})),
        (&rotated, "keys", json!({})),
    ] {
        let before = made(of).await;
        let post = async || {
            let request = server
                .request(Method::POST, path)
                .bearer_auth(admin.reveal())
                .header("content-type", "application/json")
                .header("idempotency-key", path);
            send(request.body(body.to_string())).await
        };
        let (first, again) = (post().await, post().await);
        assert_eq!((first.status.as_u16(), again.status.as_u16()), (201, 201));
        assert_eq!(again.header("idempotency-replayed"), "true", "{path}");
        assert_eq!(made(of).await, before + 1, "{path}");
        let mut shown = first.json();
        let secret = shown.as_object_mut().unwrap().remove("secret").unwrap();
        assert_eq!(again.json(), shown, "{path}");
        assert!(!again.text().contains(secret.as_str().unwrap()), "{path}");
    }
    let kept = std::fs::read(server.directory.path().join("test.db-wal")).unwrap();
    let kept = String::from_utf8_lossy(&kept);
    assert!(
        !kept.contains("\"secret\":\"trimtab_"),
        "a key is kept nowhere"
    );
}
