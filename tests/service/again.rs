//! Many jobs at once, jobs run again, and what is needed no more.

use std::time::Duration;

use crate::common::jobs::job;
use crate::common::recordings::{elevator, elevator_of};
use crate::common::server::{Answer, Server, send};
use reqwest::Method;
use serde_json::{Value, json};
use trimtab::http::Config;

async fn delete(server: &Server, path: &str) -> Answer {
    send(server.request(Method::DELETE, path)).await
}

#[tokio::test]
async fn many_maneuvers_become_a_job_each_or_none_does() {
    let server = Server::start().await;
    let first = server.upload(&elevator()).await;
    let second = server.upload(&elevator_of(25.0, 7)).await;
    let wrong = json!({
        "job": {"model": "no such model", "name": "bulk"},
        "maneuvers": [{"id": first}, {"id": "nowhere"}, {"id": second, "rows": "all of them"}],
    });
    let answer = server.post_json("/v1/jobs/bulk", &wrong).await;
    let faults = answer.problem(422, "invalid_job");
    let places: Vec<&str> = faults.iter().map(|(place, _)| place.as_str()).collect();
    assert_eq!(
        places,
        ["/job/model", "/maneuvers/1/id", "/maneuvers/2/rows"]
    );
    assert_eq!(server.get("/v1/jobs").await.json()["jobs"], json!([]));

    let bulk = json!({
        "job": {"model": "short-period", "name": "bulk", "tags": ["flight 12"]},
        "maneuvers": [{"id": first}, {"id": second}],
    });
    let post = async || {
        let request = server.request(Method::POST, "/v1/jobs/bulk");
        let request = request.header("content-type", "application/json");
        send(
            request
                .header("idempotency-key", "bulk")
                .body(bulk.to_string()),
        )
        .await
    };
    let answer = post().await;
    assert_eq!(answer.status, 202, "{}", answer.text());
    let jobs = answer.json();
    let ids = ["0", "1"].map(|number| {
        jobs["jobs"][number.parse::<usize>().unwrap()]["id"]
            .as_str()
            .unwrap()
            .to_string()
    });
    assert_eq!(post().await.bytes, answer.bytes);
    for (id, maneuver) in ids.iter().zip([&first, &second]) {
        assert_eq!(server.wait(id).await["status"], "succeeded");
        let spec = server.get(&format!("/v1/jobs/{id}/spec")).await.json();
        assert_eq!(spec["maneuvers"], json!([{"id": maneuver}]));
    }
    let tagged = server.get("/v1/jobs?tag=flight%2012").await.json();
    assert_eq!(tagged["jobs"].as_array().unwrap().len(), 2);

    for (body, place) in [
        (json!({"job": {}, "maneuvers": []}), "/maneuvers"),
        (
            json!({"job": {"maneuvers": []}, "maneuvers": [{"id": first}]}),
            "/job/maneuvers",
        ),
        (json!({"job": {}}), ""),
    ] {
        let faults = server
            .post_json("/v1/jobs/bulk", &body)
            .await
            .problem(422, "wrong_shape");
        assert_eq!(faults[0].0, place);
    }
}

/// By another process of the same program, after the catalog's name has come to mean what it may.
#[tokio::test]
async fn a_job_that_is_run_again_comes_to_the_same_numbers() {
    let server = Server::start().await;
    let mut spec = job(&server.upload(&elevator()).await);
    spec["tags"] = json!(["mine"]);
    let first = server.submit(&spec).await;
    server.wait(&first).await;
    let answer = server
        .post(&format!("/v1/jobs/{first}/rerun"), "application/json", "")
        .await;
    assert_eq!(answer.status, 202, "{}", answer.text());
    let again = answer.json();
    assert_eq!(again["tags"], json!(["mine", format!("rerun:{first}")]));
    let second = again["id"].as_str().unwrap().to_string();
    assert_eq!(server.wait(&second).await["status"], "succeeded");
    for part in [
        "parameters",
        "estimate",
        "residuals",
        "model",
        "time-histories?format=csv",
    ] {
        let of = async |id: &str| server.get(&format!("/v1/jobs/{id}/{part}")).await.text();
        let (one, other) = (of(&first).await, of(&second).await);
        assert!(one == other, "{part} differs");
        assert!(one.len() > 100, "{part}: {one}");
    }
    let made = async |id: &str| {
        let mut provenance = server
            .get(&format!("/v1/jobs/{id}/provenance"))
            .await
            .json();
        provenance["job"].take();
        provenance
    };
    let made = (made(&first).await, made(&second).await);
    assert_eq!(made.0, made.1);
    assert_eq!(made.0["maneuvers"][0], spec["maneuvers"][0]["id"]);
    assert_eq!(made.0["model"]["name"], "short-period");
    assert_eq!(made.0["made_by"]["program"].as_str().unwrap().len(), 64);
    let nothing = "/v1/jobs/00000000-0000-0000-0000-000000000000/rerun";
    server
        .post(nothing, "application/json", "")
        .await
        .problem(404, "unknown_job");
}

#[tokio::test]
async fn what_is_old_goes_and_what_is_kept_can_be_run_again() {
    let server = Server::start().await;
    let used = server.upload(&elevator()).await;
    let kept = server.upload(&elevator_of(25.0, 7)).await;
    let never_used = server.upload(&elevator_of(25.0, 8)).await;
    let old = server.submit(&job(&used)).await;
    let mut spec = job(&kept);
    spec["tags"] = json!(["keep"]);
    let wanted = server.submit(&spec).await;
    for id in [&old, &wanted] {
        server.wait(id).await;
    }
    server
        .store
        .clock()
        .advance(Duration::from_secs(40 * 24 * 3600));
    let recent = server.submit(&job(&kept)).await;
    server.wait(&recent).await;
    let expire = async |dry_run: bool| {
        let wish = json!({"older_than_days": 30, "dry_run": dry_run});
        server.post_json("/v1/retention", &wish).await.json()
    };
    let would = expire(true).await;
    assert_eq!(
        (&would["jobs"], &would["maneuvers"]),
        (&json!(1), &json!(2)),
        "{would}"
    );
    assert!(would["maneuver_bytes"].as_u64().unwrap() > 10_000);
    assert_eq!(server.get(&format!("/v1/jobs/{old}")).await.status, 200);
    let did = expire(false).await;
    assert_eq!(
        (&did["jobs"], &did["maneuver_bytes"]),
        (&would["jobs"], &would["maneuver_bytes"])
    );
    server
        .get(&format!("/v1/jobs/{old}"))
        .await
        .problem(404, "unknown_job");
    server
        .get(&format!("/v1/jobs/{old}/estimate"))
        .await
        .problem(404, "unknown_job");
    for gone in [&used, &never_used] {
        server
            .get(&format!("/v1/maneuvers/{gone}"))
            .await
            .problem(404, "unknown_maneuver");
    }
    for id in [&wanted, &recent] {
        assert_eq!(
            server.get(&format!("/v1/jobs/{id}/estimate")).await.status,
            200
        );
    }
    assert_eq!(expire(false).await["jobs"], 0);
    for days in [0, 36501] {
        let wish = json!({"older_than_days": days});
        let faults = server
            .post_json("/v1/retention", &wish)
            .await
            .problem(422, "wrong_shape");
        assert_eq!(faults[0].0, "/older_than_days");
    }
}

#[tokio::test]
async fn what_is_in_use_is_not_deleted() {
    let server = Server::start_with(Config::default(), 0).await;
    let maneuver = server.upload(&elevator()).await;
    let id = server.submit(&job(&maneuver)).await;
    let (of_maneuver, of_job) = (
        format!("/v1/maneuvers/{maneuver}"),
        format!("/v1/jobs/{id}"),
    );
    delete(&server, &of_maneuver).await.problem(409, "in_use");
    delete(&server, &of_job).await.problem(409, "not_finished");
    let cancel = format!("{of_job}/cancel");
    server.post_json(&cancel, &Value::Null).await;
    assert_eq!(delete(&server, &of_job).await.status, 204);
    delete(&server, &of_job).await.problem(404, "unknown_job");
    assert_eq!(delete(&server, &of_maneuver).await.status, 204);
    delete(&server, &of_maneuver)
        .await
        .problem(404, "unknown_maneuver");
    delete(&server, "/v1/maneuvers/%25")
        .await
        .problem(404, "unknown_maneuver");
}
