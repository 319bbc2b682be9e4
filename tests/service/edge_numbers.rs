//! Numbers out of range, which JSON writes as `null`: what has them is shown all the same, and takes nothing else down.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use sqlx::{AnyConnection, Connection, Row};
use trimtab::diagnose::Diagnosis;
use trimtab::estimate::Estimate;
use trimtab::estimate::study::DerivativeStudy;
use trimtab::ingest::Summary;
use trimtab::job::Event;
use trimtab::structure::Structure;

use crate::common::jobs::job;
use crate::common::recordings::{elevator, elevator_of};
use crate::common::server::{Server, database};

/// The places of all numbers with a fraction, but those of a model: what may stand there is checked before.
fn numbers(value: &Value, at: &str, found: &mut Vec<String>) {
    let escape = |key: &str| key.replace('~', "~0").replace('/', "~1");
    match value {
        Value::Number(number) if number.is_f64() => found.push(at.to_string()),
        Value::Array(values) => {
            for (index, value) in values.iter().enumerate() {
                numbers(value, &format!("{at}/{index}"), found);
            }
        }
        Value::Object(fields) => {
            for (key, value) in fields.iter().filter(|(key, _)| *key != "model") {
                numbers(value, &format!("{at}/{}", escape(key)), found);
            }
        }
        _ => {}
    }
}

fn places(value: &Value) -> Vec<String> {
    let mut found = Vec::new();
    numbers(value, "", &mut found);
    found
}

/// Each number by itself may be out of range: whatever was written is read.
fn is_read_whichever_is_out_of_range<T: DeserializeOwned>(whole: &Value) {
    let places = places(whole);
    for place in &places {
        let mut spoiled = whole.clone();
        *spoiled.pointer_mut(place).unwrap() = Value::Null;
        let read = serde_json::from_value::<T>(spoiled);
        assert!(read.is_ok(), "{place}: {:?}", read.err());
    }
    assert!(!places.is_empty());
}

async fn done(server: &Server, spec: &Value) -> String {
    let id = server.submit(spec).await;
    assert_eq!(server.wait(&id).await["status"], "succeeded");
    id
}

async fn json_of(server: &Server, path: &str) -> Value {
    let answer = server.get(path).await;
    assert_eq!(answer.status, 200, "{path}: {}", answer.text());
    answer.json()
}

#[tokio::test]
async fn what_is_kept_is_read_whichever_number_is_out_of_range() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator_of(6.0, 7)).await;
    let of_maneuver = json_of(&server, &format!("/v1/maneuvers/{maneuver}")).await;
    is_read_whichever_is_out_of_range::<Summary>(&of_maneuver["summary"]);
    let with = |kind: &str| {
        let mut spec = job(&maneuver);
        spec["kind"] = json!(kind);
        spec
    };
    let mut filtered = with("estimate");
    filtered["options"] = json!({"estimator": "filter_error"});
    let mut jobs = Vec::new();
    for spec in [with("estimate"), filtered] {
        let id = done(&server, &spec).await;
        let estimate = json_of(&server, &format!("/v1/jobs/{id}/estimate")).await;
        is_read_whichever_is_out_of_range::<Estimate>(&estimate);
        jobs.push(id);
    }
    let id = done(&server, &with("derivative_study")).await;
    let study = json_of(&server, &format!("/v1/jobs/{id}/derivative-study")).await;
    is_read_whichever_is_out_of_range::<DerivativeStudy>(&study);
    jobs.push(id);
    let id = done(&server, &with("diagnose")).await;
    let diagnosis = json_of(&server, &format!("/v1/jobs/{id}/diagnosis")).await;
    is_read_whichever_is_out_of_range::<Diagnosis>(&diagnosis);
    jobs.push(id);
    let mut structure = with("structure");
    structure["model"] = json!({
        "name": "pitch",
        "inputs": {"alpha": {"unit": "rad"}, "q": {"unit": "rad/s"}, "de": {"unit": "rad"}},
        "outputs": {"q_dot": {"unit": "rad/s^2", "equation": "0"}},
    });
    structure["channels"] = json!({"q_dot": "derivative(q, 0.2)"});
    structure["structure"] =
        json!({"output": "q_dot", "variables": ["alpha", "q", "de"], "order": 1});
    let id = done(&server, &structure).await;
    let structure = json_of(&server, &format!("/v1/jobs/{id}/structure")).await;
    is_read_whichever_is_out_of_range::<Structure>(&structure);
    jobs.push(id);
    for id in jobs {
        let log = json_of(&server, &format!("/v1/jobs/{id}/events?limit=1000")).await;
        for event in log["events"].as_array().unwrap() {
            if !places(event).is_empty() {
                is_read_whichever_is_out_of_range::<Event>(event);
            }
        }
    }
}

/// All that shows a result or makes something of it.
const SHOWN: [&str; 26] = [
    "/jobs/ID",
    "/jobs/ID/report",
    "/jobs/ID/dynamics",
    "/",
    "/v1/jobs",
    "/v1/jobs/ID/estimate",
    "/v1/jobs/ID/parameters",
    "/v1/jobs/ID/parameters?format=csv&comments=true",
    "/v1/jobs/ID/residuals",
    "/v1/jobs/ID/residual-analysis",
    "/v1/jobs/ID/time-histories",
    "/v1/jobs/ID/time-histories?format=csv",
    "/v1/jobs/ID/time-histories?format=mat",
    "/v1/jobs/ID/trajectories",
    "/v1/jobs/ID/trajectories?format=csv",
    "/v1/jobs/ID/model",
    "/v1/jobs/ID/linear-system",
    "/v1/jobs/ID/frequency-response",
    "/v1/jobs/ID/flying-qualities",
    "/v1/jobs/ID/source-code?language=c",
    "/v1/jobs/ID/source-code?language=matlab",
    "/v1/jobs/ID/simulator-model?format=fmu",
    "/v1/jobs/ID/iterations",
    "/v1/jobs/ID/iterations?format=csv",
    "/v1/campaigns?tag=edge&parameters=Ma",
    "/v1/campaigns?tag=edge&parameters=Ma&format=csv",
];

async fn is_shown(server: &Server, id: &str, why: &str) {
    for path in SHOWN {
        let path = path.replace("ID", id);
        let answer = server.get(&path).await;
        let status = answer.status.as_u16();
        assert!(status < 500, "{why}: {path} is answered {status}");
    }
    let aircraft = json!({"mass": 5000.0, "wing_area": 30.0, "chord": 2.0, "span": 15.0, "density": 1.0, "airspeed": 80.0});
    let path = format!("/v1/jobs/{id}/coefficients");
    let answer = server.post_json(&path, &aircraft).await;
    assert!(answer.status.as_u16() < 500, "{why}: {}", answer.text());
}

async fn connection(server: &Server) -> AnyConnection {
    let file = database(server.directory.path());
    let url = format!("sqlite://{}", file.to_str().unwrap());
    AnyConnection::connect(&url).await.unwrap()
}

/// Any numbers of a result may be out of range, with any others.
#[tokio::test]
async fn a_result_is_shown_whichever_of_its_numbers_are_out_of_range() {
    let server = Server::start().await;
    let mut spec = job(&server.upload(&elevator()).await);
    spec["tags"] = json!(["edge"]);
    let id = done(&server, &spec).await;
    is_shown(&server, &id, "whole").await;
    let whole = json_of(&server, &format!("/v1/jobs/{id}/estimate")).await;
    let places = places(&whole);
    let mut random = ChaCha8Rng::seed_from_u64(24);
    let mut database = connection(&server).await;
    for round in 0..24 {
        let share = [1.0, 0.5, 0.1, 0.02][round % 4];
        let mut spoiled = whole.clone();
        for place in &places {
            if random.random::<f64>() < share {
                *spoiled.pointer_mut(place).unwrap() = Value::Null;
            }
        }
        sqlx::query("UPDATE results SET body = $2 WHERE job = $1 AND part = 'estimate'")
            .bind(&id)
            .bind(spoiled.to_string().into_bytes())
            .execute(&mut database)
            .await
            .unwrap();
        is_shown(&server, &id, &format!("round {round}, share {share}")).await;
    }
    // and so may those of its time histories
    let row = sqlx::query("SELECT body FROM results WHERE job = $1 AND part LIKE 'history/%'")
        .bind(&id)
        .fetch_one(&mut database)
        .await
        .unwrap();
    let history: Vec<u8> = row.get("body");
    for out_of_range in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 1e300] {
        let mut spoiled = history.clone();
        let numbers = spoiled.len() / 8 / 4;
        for chunk in spoiled.rchunks_exact_mut(8).take(numbers) {
            chunk.copy_from_slice(&out_of_range.to_le_bytes());
        }
        sqlx::query("UPDATE results SET body = $2 WHERE job = $1 AND part LIKE 'history/%'")
            .bind(&id)
            .bind(spoiled)
            .execute(&mut database)
            .await
            .unwrap();
        is_shown(&server, &id, &format!("{out_of_range} in a history")).await;
    }
}

/// The recording with one channel so large that what is worked out of it leaves the range of numbers.
fn enlarged(factor: f64) -> String {
    let recording = elevator();
    let mut lines = recording.lines();
    let header = lines.next().unwrap();
    let at = header.split(',').position(|name| name.starts_with("alpha"));
    let at = at.expect("it has alpha");
    let mut csv = format!("{header}\n");
    for line in lines {
        let mut cells: Vec<String> = line.split(',').map(ToString::to_string).collect();
        cells[at] = format!("{:e}", cells[at].parse::<f64>().unwrap() * factor);
        csv += &(cells.join(",") + "\n");
    }
    csv
}

#[tokio::test]
async fn a_fit_of_huge_numbers_has_a_page_and_exports() {
    let server = Server::start().await;
    for factor in [1e100, 1e150, 1e200] {
        let mut spec = job(&server.upload(&enlarged(factor)).await);
        spec["tags"] = json!(["edge"]);
        let answer = server.post_json("/v1/jobs", &spec).await;
        assert!(
            answer.status.as_u16() < 500,
            "{factor:e}: {}",
            answer.text()
        );
        if answer.status == 202 {
            let id = answer.json()["id"].as_str().unwrap().to_string();
            server.wait(&id).await;
            is_shown(&server, &id, &format!("{factor:e}")).await;
        }
    }
    for path in ["/maneuvers", "/v1/maneuvers", "/", "/v1/jobs"] {
        assert_eq!(server.get(path).await.status, 200, "{path}");
    }
}

#[tokio::test]
async fn an_entry_that_cannot_be_read_takes_no_list_down() {
    let server = Server::start().await;
    let spoiled = server.upload(&elevator_of(6.0, 1)).await;
    let whole = server.upload(&elevator_of(6.0, 2)).await;
    let mut spec = job(&whole);
    spec["tags"] = json!(["edge"]);
    let jobs = [done(&server, &spec).await, done(&server, &spec).await];
    let mut model = server.get("/v1/models/short-period").await.json();
    let mut models = Vec::new();
    for name in ["one", "other"] {
        model["name"] = json!(name);
        let answer = server.post_json("/v1/models", &model).await;
        models.push(answer.json()["id"].as_str().unwrap().to_string());
    }
    let mut hooks = Vec::new();
    for _ in 0..2 {
        let order = json!({"url": "https://example.org/hook"});
        let answer = server.post_json("/v1/webhooks", &order).await;
        hooks.push(answer.json()["id"].as_str().unwrap().to_string());
    }
    let mut database = connection(&server).await;
    for (sql, id) in [
        (
            "UPDATE maneuvers SET summary = '{\"rate\": \"?\"}', flown = '[' WHERE id = $1",
            &spoiled,
        ),
        ("UPDATE events SET body = '{' WHERE job = $1", &jobs[0]),
        ("UPDATE jobs SET tags = '{' WHERE id = $1", &jobs[0]),
        (
            "UPDATE results SET body = X'00' WHERE job = $1 AND part = 'estimate'",
            &jobs[0],
        ),
        (
            "UPDATE models SET document = '{}' WHERE id = $1",
            &models[0],
        ),
        ("UPDATE webhooks SET events = '{' WHERE id = $1", &hooks[0]),
    ] {
        let changed = sqlx::query(sql).bind(id).execute(&mut database).await;
        assert!(changed.unwrap().rows_affected() > 0, "{sql}");
    }
    for (path, whole) in [
        ("/maneuvers", &whole),
        ("/v1/maneuvers", &whole),
        ("/", &jobs[1]),
        ("/v1/jobs", &jobs[1]),
        ("/models", &models[1]),
        ("/v1/models?limit=100", &models[1]),
        ("/v1/webhooks", &hooks[1]),
        ("/v1/campaigns?tag=edge&parameters=Ma", &jobs[1]),
    ] {
        let answer = server.get(path).await;
        assert_eq!(answer.status, 200, "{path}: {}", answer.text());
        assert!(answer.text().contains(whole.as_str()), "{path}");
    }
    // nor the end of a job, which is told to those who can be told
    done(&server, &spec).await;
}
