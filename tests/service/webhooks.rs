//! Webhooks, with a real receiver.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use crate::common::jobs::job;
use crate::common::recordings::elevator;
use crate::common::server::{Answer, Server, send};
use axum::Router;
use axum::extract::{Request, State};
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::IntoResponse;
use reqwest::Method;
use serde_json::{Value, json};
use tokio::net::TcpListener;
use trimtab::http::Config;
use trimtab::webhook::{Allowed, signature};

/// What came in, and what to answer next; behind the last, 204.
#[derive(Clone, Default)]
struct Receiver {
    heard: Arc<Mutex<Vec<(HeaderMap, String)>>>,
    answers: Arc<Mutex<Vec<u16>>>,
}

impl Receiver {
    async fn start(answers: &[u16]) -> (Self, String) {
        let receiver = Self {
            answers: Arc::new(Mutex::new(answers.to_vec())),
            ..Self::default()
        };
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let url = format!("http://{}/hook", listener.local_addr().unwrap());
        let router = Router::new().fallback(hear).with_state(receiver.clone());
        tokio::spawn(async move { axum::serve(listener, router).await });
        (receiver, url)
    }

    async fn heard(&self, count: usize) -> Vec<(HeaderMap, String)> {
        for _ in 0..400 {
            let heard = self.heard.lock().unwrap().clone();
            if heard.len() >= count {
                return heard;
            }
            tokio::time::sleep(Duration::from_millis(50)).await;
        }
        panic!("fewer than {count} came: {:?}", self.heard.lock().unwrap());
    }
}

async fn hear(State(receiver): State<Receiver>, request: Request) -> impl IntoResponse {
    let headers = request.headers().clone();
    let body = axum::body::to_bytes(request.into_body(), 10_000)
        .await
        .unwrap();
    let text = String::from_utf8(body.to_vec()).unwrap();
    receiver.heard.lock().unwrap().push((headers, text));
    let mut answers = receiver.answers.lock().unwrap();
    let answer = if answers.is_empty() {
        204
    } else {
        answers.remove(0)
    };
    (
        StatusCode::from_u16(answer).unwrap(),
        [(header::LOCATION, "/elsewhere")],
    )
}

async fn server() -> Server {
    let config = Config {
        webhooks: Allowed::new(["127.0.0.1".to_string()]),
        ..Config::default()
    };
    Server::start_with(config, 2).await
}

async fn hook(server: &Server, url: &str, events: &[&str]) -> (String, String) {
    let answer = server
        .post_json("/v1/webhooks", &json!({"url": url, "events": events}))
        .await;
    assert_eq!(answer.status, 201, "{}", answer.text());
    assert_eq!(answer.header("cache-control"), "no-store");
    let hook = answer.json();
    let text = |key: &str| hook[key].as_str().unwrap().to_string();
    (text("id"), text("secret"))
}

/// The deliveries of a webhook, when they are as they should be.
async fn deliveries(server: &Server, id: &str, fits: impl Fn(&Value) -> bool) -> Value {
    let mut found = Value::Null;
    for _ in 0..400 {
        let path = format!("/v1/webhooks/{id}/deliveries");
        found = server.get(&path).await.json()["deliveries"].take();
        if found[0].is_object() && fits(&found[0]) {
            return found;
        }
        tokio::time::sleep(Duration::from_millis(50)).await;
    }
    panic!("{found:#}");
}

fn is_signed(secret: &str, (headers, body): &(HeaderMap, String)) -> bool {
    let of = |name: &str| headers[name].to_str().unwrap();
    let (id, at) = (
        of("webhook-id").parse().unwrap(),
        of("webhook-timestamp").parse().unwrap(),
    );
    let expected = signature(secret, id, at, body).unwrap();
    of("webhook-signature")
        .split(' ')
        .any(|one| one == expected)
}

#[tokio::test]
async fn the_end_of_a_job_is_told_once_and_signed() {
    let server = server().await;
    let (receiver, url) = Receiver::start(&[]).await;
    let (id, secret) = hook(&server, &url, &["job.succeeded"]).await;
    let job_id = server.submit(&job(&server.upload(&elevator()).await)).await;
    let heard = receiver.heard(1).await;
    assert!(is_signed(&secret, &heard[0]));
    assert!(!is_signed("whsec_AAAA", &heard[0]));
    let message: Value = serde_json::from_str(&heard[0].1).unwrap();
    assert_eq!(message["type"], "job.succeeded");
    assert_eq!(message["data"]["job"], job_id);
    let ended = server.get(&format!("/v1/jobs/{job_id}")).await.json();
    assert_eq!(message["timestamp"], ended["finished"]);
    let log = deliveries(&server, &id, |one| one["delivered"].is_string()).await;
    assert_eq!(
        (&log[0]["attempts"], &log[0]["status"]),
        (&json!(1), &json!(204))
    );
    assert_eq!(log[0]["id"], heard[0].0["webhook-id"].to_str().unwrap());
    // what was not asked for is not told
    let waiting = server.submit(&job(&server.upload(&elevator()).await)).await;
    server
        .post_json(&format!("/v1/jobs/{waiting}/cancel"), &Value::Null)
        .await;
    server.wait(&waiting).await;
    tokio::time::sleep(Duration::from_millis(1200)).await;
    let told = receiver.heard.lock().unwrap().len();
    let succeeded = server.get("/v1/jobs?status=succeeded").await.json();
    assert_eq!(told, succeeded["jobs"].as_array().unwrap().len());
}

#[tokio::test]
async fn what_did_not_arrive_is_sent_again_later_under_the_same_id() {
    let server = server().await;
    let (receiver, url) = Receiver::start(&[500, 302]).await;
    let (id, old) = hook(&server, &url, &["job.failed"]).await;
    let test = format!("/v1/webhooks/{id}/test");
    assert_eq!(server.post_json(&test, &Value::Null).await.status, 202);
    receiver.heard(1).await;
    let log = deliveries(&server, &id, |one| one["status"] == 500).await;
    assert!(
        log[0]["delivered"].is_null() && log[0]["next_attempt"].is_string(),
        "{log:#}"
    );
    server.store.clock().advance(Duration::from_secs(7));
    receiver.heard(2).await;
    let log = deliveries(&server, &id, |one| one["status"] == 302).await;
    assert!(
        log[0]["fault"].as_str().unwrap().contains("not followed"),
        "{log:#}"
    );
    // both secrets sign after a rotation
    let rotated = server
        .post_json(&format!("/v1/webhooks/{id}/rotate"), &Value::Null)
        .await;
    let new = rotated.json()["secret"].as_str().unwrap().to_string();
    assert_ne!(new, old);
    server
        .store
        .clock()
        .advance(Duration::from_secs(6 * 60 + 1));
    let heard = receiver.heard(3).await;
    assert!(is_signed(&old, &heard[2]) && is_signed(&new, &heard[2]));
    assert!(!is_signed(&new, &heard[1]));
    let ids: Vec<_> = heard
        .iter()
        .map(|(headers, _)| headers["webhook-id"].clone())
        .collect();
    assert!(ids.iter().all(|one| *one == ids[0]));
    let log = deliveries(&server, &id, |one| one["delivered"].is_string()).await;
    assert_eq!(log.as_array().unwrap().len(), 1);
    assert_eq!(log[0]["attempts"], 3);
    assert!(heard[2].1.contains("webhook.test"));
}

#[tokio::test]
async fn who_is_gone_is_told_nothing_more() {
    let server = server().await;
    let (receiver, url) = Receiver::start(&[410]).await;
    let (id, _) = hook(&server, &url, &["job.succeeded"]).await;
    let spec = job(&server.upload(&elevator()).await);
    let first = server.submit(&spec).await;
    server.wait(&first).await;
    receiver.heard(1).await;
    deliveries(&server, &id, |one| one["status"] == 410).await;
    let hooks = server.get("/v1/webhooks").await.json();
    assert!(hooks["webhooks"][0]["disabled"].is_string());
    let second = server.submit(&spec).await;
    server.wait(&second).await;
    tokio::time::sleep(Duration::from_millis(1200)).await;
    assert_eq!(receiver.heard.lock().unwrap().len(), 1);
    let delete = async || -> Answer {
        send(server.request(Method::DELETE, &format!("/v1/webhooks/{id}"))).await
    };
    assert_eq!(delete().await.status, 204);
    delete().await.problem(404, "unknown_webhook");
}

/// The service must not be made to speak to what only it can reach.
#[tokio::test]
async fn a_webhook_that_leads_inside_is_refused() {
    let server = Server::start_with(Config::default(), 0).await;
    for url in [
        "http://example.org/",
        "https://127.0.0.1/",
        "https://127.1:8300/v1/keys",
        "https://[::ffff:10.0.0.1]/",
        "https://169.254.169.254/latest/meta-data/",
        "https://localhost/",
        "https://user:password@example.org/",
        "gopher://example.org/",
        "no URL",
    ] {
        let answer = server.post_json("/v1/webhooks", &json!({"url": url})).await;
        assert_eq!(
            answer.problem(422, "invalid_webhook"),
            [("/url".into(), "invalid_webhook".into())],
            "{url}"
        );
    }
    let nothing = json!({"url": "https://example.org/", "events": []});
    let answer = server.post_json("/v1/webhooks", &nothing).await;
    assert_eq!(answer.problem(422, "invalid_webhook")[0].0, "/events");
    for number in 0..20 {
        let url = format!("https://example.org/{number}");
        assert_eq!(
            server
                .post_json("/v1/webhooks", &json!({"url": url}))
                .await
                .status,
            201
        );
    }
    let one_more = server
        .post_json("/v1/webhooks", &json!({"url": "https://example.org/"}))
        .await;
    one_more.problem(409, "too_many_webhooks");
}
