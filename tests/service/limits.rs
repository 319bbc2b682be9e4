//! What is too much is refused by name, and what goes on is counted.

use crate::common::jobs::job;
use crate::common::recordings::{elevator, elevator_of};
use crate::common::server::{Answer, Server, send};
use reqwest::Method;
use trimtab::http::Config;
use trimtab::store::{NewKey, Scope};

async fn key(server: &Server) -> String {
    let new = NewKey {
        project: "default".into(),
        name: "test".into(),
        scopes: Scope::ALL.into(),
        max_priority: 0,
        lifetime: None,
    };
    server.store.add_key(&new).await.unwrap().1.reveal().into()
}

async fn submit_as(server: &Server, key: &str, spec: &serde_json::Value) -> Answer {
    let request = server.request(Method::POST, "/v1/jobs").bearer_auth(key);
    let request = request.header("content-type", "application/json");
    send(request.body(spec.to_string())).await
}

fn retry_after(answer: &Answer) -> u64 {
    answer.header("retry-after").parse().unwrap()
}

#[tokio::test]
async fn a_full_queue_is_said_by_name_and_with_the_time_to_come_back() {
    let config = Config {
        max_queued: 4,
        max_queued_per_key: 3,
        ..Config::default()
    };
    let server = Server::start_with(config, 0).await;
    let spec = job(&server.upload(&elevator()).await);
    let [one, other] = [key(&server).await, key(&server).await];
    let mut ids = Vec::new();
    for _ in 0..3 {
        let answer = submit_as(&server, &one, &spec).await;
        assert_eq!(answer.status, 202, "{}", answer.text());
        ids.push(answer.json()["id"].as_str().unwrap().to_string());
    }
    let refused = submit_as(&server, &one, &spec).await;
    assert_eq!(refused.problem(429, "queue_full"), []);
    assert!(
        refused
            .text()
            .contains("3 jobs of this key wait, and 3 may (--max-queued-per-key)")
    );
    assert!(retry_after(&refused) > 0);
    assert_eq!(submit_as(&server, &other, &spec).await.status, 202);
    let refused = submit_as(&server, &other, &spec).await;
    refused.problem(429, "queue_full");
    assert!(
        refused.text().contains("--max-queued)"),
        "{}",
        refused.text()
    );
    // one is done, one may come
    let cancel = format!("/v1/jobs/{}/cancel", ids[0]);
    let cancelled = server.request(Method::POST, &cancel).bearer_auth(&one);
    assert_eq!(send(cancelled).await.status, 202);
    assert_eq!(submit_as(&server, &one, &spec).await.status, 202);
}

#[tokio::test]
async fn a_key_that_asks_too_often_is_told_to_wait_and_no_other_is() {
    let config = Config {
        max_requests_per_second: 2,
        ..Config::default()
    };
    let server = Server::start_with(config, 0).await;
    let [hasty, calm] = [key(&server).await, key(&server).await];
    let ask =
        async |key: &str| send(server.request(Method::GET, "/v1/jobs").bearer_auth(key)).await;
    let mut refused = None;
    for _ in 0..20 {
        let answer = ask(&hasty).await;
        if answer.status != 200 {
            refused = Some(answer);
            break;
        }
    }
    let refused = refused.expect("twenty at once are too many");
    refused.problem(429, "too_many_requests");
    assert_eq!(ask(&calm).await.status, 200);
    tokio::time::sleep(std::time::Duration::from_secs(retry_after(&refused))).await;
    assert_eq!(ask(&hasty).await.status, 200);
}

#[tokio::test]
async fn a_project_that_is_full_takes_no_more_until_something_is_deleted() {
    let config = Config {
        max_stored_bytes: 1000,
        ..Config::default()
    };
    let server = Server::start_with(config, 0).await;
    let id = server.upload(&elevator()).await;
    let another = || server.post("/v1/maneuvers", "text/csv", elevator_of(25.0, 7));
    another().await.problem(413, "quota_exceeded");
    let gone = send(server.request(Method::DELETE, &format!("/v1/maneuvers/{id}"))).await;
    assert_eq!(gone.status, 204);
    assert_eq!(another().await.status, 201);
}

#[tokio::test]
async fn what_goes_on_is_counted() {
    let server = Server::start().await;
    let spec = job(&server.upload(&elevator()).await);
    for _ in 0..3 {
        server.wait(&server.submit(&spec).await).await;
    }
    server.get("/no/such/route").await;
    let answer = server.get("/metrics").await;
    assert!(
        answer
            .header("content-type")
            .starts_with("application/openmetrics-text")
    );
    let text = answer.text();
    for line in [
        "trimtab_jobs{status=\"succeeded\"} 3",
        "trimtab_jobs_ended_total{how=\"succeeded\"} 3",
        "trimtab_job_run_seconds_count 3",
        "trimtab_job_wait_seconds_count 3",
        "trimtab_job_wait_seconds_bucket{le=\"+Inf\"} 3",
        "trimtab_queue_oldest_seconds 0.0",
        "trimtab_event_streams 0",
        "trimtab_http_requests_total{method=\"POST\",route=\"/v1/jobs\",status=\"202\"} 3",
        "trimtab_http_requests_total{method=\"GET\",route=\"none\",status=\"404\"} 1",
    ] {
        assert!(text.lines().any(|found| found == line), "{line}\n{text}");
    }
    assert!(text.ends_with("# EOF\n") && text.matches("# EOF").count() == 1);
    // each name is described once
    let mut described: Vec<&str> = text
        .lines()
        .filter(|line| line.starts_with("# TYPE"))
        .collect();
    let all = described.len();
    described.sort_unstable();
    described.dedup();
    assert_eq!(described.len(), all);
}
