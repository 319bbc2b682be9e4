//! Jobs that are stopped, and servers that are.

use std::time::{Duration, Instant};

use crate::common::chain::{chain, recorded};
use crate::common::jobs::{endless_job, job};
use crate::common::process::Process;
use crate::common::recordings::{elevator, elevator_of};
use crate::common::server::{Server, client, send, wait};
use crate::common::sse::{Received, Stream};
use serde_json::{Value, json};
use sqlx::Connection;
use tempfile::TempDir;
use trimtab::http::Config;
use trimtab::store::{DEFAULT_PROJECT, LEASE};

/// A job that is certain to run while the test acts on it.
async fn running(server: &Server) -> String {
    let maneuver = server.upload(&elevator_of(4000.0, 3)).await;
    let id = server.submit(&endless_job(&maneuver)).await;
    let mut stream = Stream::open(&server.url, &id, None).await.unwrap();
    while stream.next().await.expect("it runs").event != "iteration" {}
    id
}

/// When it was recorded, in seconds of the day.
fn at(event: &Received) -> f64 {
    let body: Value = serde_json::from_str(&event.data).unwrap();
    let (_, time) = body["at"].as_str().unwrap().split_once('T').unwrap();
    let parts = time.trim_end_matches('Z').split(':');
    parts.fold(0.0, |sum, part| sum * 60.0 + part.parse::<f64>().unwrap())
}

#[tokio::test]
async fn a_running_job_is_cancelled_and_keeps_its_best_iterate() {
    let server = Server::start().await;
    let id = running(&server).await;
    let asked = server
        .post(&format!("/v1/jobs/{id}/cancel"), "text/plain", "")
        .await;
    assert_eq!(asked.status, 202);
    assert_eq!(asked.json()["status"], "cancelling");
    let again = server
        .post(&format!("/v1/jobs/{id}/cancel"), "text/plain", "")
        .await;
    assert_eq!(again.status, 202, "asking twice is asking once");
    let done = server.wait(&id).await;
    assert_eq!(
        (&done["status"], &done["outcome"]),
        (&json!("cancelled"), &json!("cancelled"))
    );
    assert_eq!(done["has_result"], true);
    let estimate = server.get(&format!("/v1/jobs/{id}/estimate")).await.json();
    assert_eq!(estimate["outcome"], "cancelled");
    let events = Stream::open(&server.url, &id, None)
        .await
        .unwrap()
        .rest()
        .await;
    let asked = events
        .iter()
        .position(|event| event.event == "cancel_requested")
        .unwrap();
    // how many iterations pass until the worker has heard of it is the machine's affair; that the solver ends with the
    // one after is shown where it is asked, in src/work/solve.rs
    let (last, behind) = events[asked + 1..].split_last().unwrap();
    assert_eq!(last.event, "cancelled");
    for event in behind {
        assert_eq!(event.event, "iteration");
    }
    if let Some(late) = behind.last() {
        let took = at(late) - at(&events[asked]);
        assert!(took < 2.0, "the worker is told at once: {took} s");
    }
    let again = server
        .post(&format!("/v1/jobs/{id}/cancel"), "text/plain", "")
        .await;
    assert_eq!(again.problem(409, "already_over"), []);
}

/// A job whose every sweep along the samples takes much longer than a second: 64 states, 512 parameters.
async fn sweeping(server: &Server) -> String {
    let flown = trimtab::ingest::to_csv(&recorded(64, 3000), |_| true);
    let maneuver = server.upload(&flown).await;
    let id = server
        .submit(&json!({
            "model": chain(64, 5),
            "maneuvers": [{"id": maneuver}],
            "options": {"start": {"kind": "document"}, "derivatives": {"technique": "complex_step"}},
        }))
        .await;
    let mut stream = Stream::open(&server.url, &id, None).await.unwrap();
    while stream.next().await.expect("it runs").event != "prepared" {}
    tokio::time::sleep(Duration::from_secs(1)).await;
    id
}

/// What of the second the test's own machine takes is not the solver's.
const MOMENT: Duration = Duration::from_millis(500);

#[tokio::test]
async fn a_long_sweep_is_cancelled_within_a_second() {
    let server = Server::start().await;
    let id = sweeping(&server).await;
    let asked = Instant::now();
    server
        .post(&format!("/v1/jobs/{id}/cancel"), "text/plain", "")
        .await;
    let done = server.wait(&id).await;
    let took = asked.elapsed();
    assert_eq!(done["status"], "cancelled");
    assert_eq!(done["has_result"], false, "no iterate was come to");
    assert!(took < Duration::from_secs(1) + MOMENT, "{took:?}");
}

#[tokio::test]
async fn a_long_sweep_is_given_back_within_a_second() {
    let server = Server::start().await;
    let id = sweeping(&server).await;
    let store = server.store.project(DEFAULT_PROJECT, "");
    let started = Instant::now();
    server.stop().await;
    let took = started.elapsed();
    assert!(took < Duration::from_secs(1) + MOMENT, "{took:?}");
    let job = store.job(id.parse().unwrap()).await.unwrap().unwrap();
    assert_eq!(job.status.name(), "queued");
}

#[tokio::test]
async fn stopping_gives_a_running_job_back_to_the_queue() {
    let server = Server::start().await;
    let id = running(&server).await;
    let store = server.store.project(DEFAULT_PROJECT, "");
    let started = Instant::now();
    server.stop().await;
    let took = started.elapsed();
    // given back, not left until its lease has run out; how soon a whole process ends is held where one is terminated
    assert!(took < LEASE, "{took:?}");
    let id = id.parse().unwrap();
    let job = store.job(id).await.unwrap().unwrap();
    assert_eq!(job.status.name(), "queued");
    let last = store
        .events(id, 0, 1000)
        .await
        .unwrap()
        .entries
        .pop()
        .unwrap();
    assert_eq!(last.name, "released");
}

#[tokio::test]
async fn a_worker_that_is_overtaken_writes_nothing_more() {
    let server = Server::start_with(Config::default(), 1).await;
    let id = running(&server).await;
    // the worker extends its lease with all it writes: it takes some tries to come in between
    let mut successor = None;
    for _ in 0..200 {
        server.store.clock().advance(LEASE * 2);
        successor = server.store.claim("successor").await.unwrap();
        if successor.is_some() {
            break;
        }
    }
    let successor = successor.expect("the lease has run out");
    assert_eq!(successor.attempt, 2);
    tokio::time::sleep(Duration::from_millis(500)).await;
    server.store.heartbeat(&successor).await.unwrap();
    let events = server
        .store
        .project(DEFAULT_PROJECT, "")
        .events(successor.job, 0, 1000)
        .await
        .unwrap()
        .entries;
    assert_eq!(
        events[events.len() - 1].name,
        "claimed",
        "nothing behind the second claim"
    );

    // and the overtaken worker is free for the next job
    let maneuver = server.upload(&elevator()).await;
    let next = server.submit(&job(&maneuver)).await;
    let done = tokio::time::timeout(Duration::from_secs(20), server.wait(&next))
        .await
        .unwrap();
    assert_eq!(done["status"], "succeeded");
    assert_eq!(
        server.get(&format!("/v1/jobs/{id}")).await.json()["status"],
        "running"
    );
}

/// A server with some finished jobs, one under way and a queue behind it.
struct Busy {
    directory: TempDir,
    process: Process,
    /// With their parameter tables.
    finished: Vec<(String, Value)>,
    waiting: Vec<String>,
}

impl Busy {
    async fn start() -> Self {
        let directory = TempDir::new().unwrap();
        let process = Process::start(directory.path(), 1);
        let short = upload(&process.url, elevator()).await;
        let long = upload(&process.url, elevator_of(2000.0, 5)).await;
        let mut finished = Vec::new();
        for _ in 0..3 {
            let id = submit(&process.url, &job(&short)).await;
            assert_eq!(wait(&process.url, &id).await["status"], "succeeded");
            finished.push((id.clone(), parameters(&process.url, &id).await));
        }
        let mut endless = endless_job(&long);
        endless["options"]["max_iterations"] = json!(20);
        let mut waiting = vec![submit(&process.url, &endless).await];
        for _ in 0..8 {
            waiting.push(submit(&process.url, &job(&short)).await);
        }
        Self {
            directory,
            process,
            finished,
            waiting,
        }
    }

    /// A new server on the same database has what was finished and finishes what waited.
    async fn finishes_in(directory: &TempDir, finished: &[(String, Value)], waiting: &[String]) {
        let process = Process::start(directory.path(), 2);
        for (id, table) in finished {
            assert_eq!(&parameters(&process.url, id).await, table);
        }
        for id in waiting {
            let done = wait(&process.url, id).await;
            assert_eq!(done["status"], "succeeded", "{done:#}");
            let events = Stream::open(&process.url, id, None)
                .await
                .unwrap()
                .rest()
                .await;
            let ids: Vec<u64> = events.iter().map(|event| event.id).collect();
            assert_eq!(ids, (1..=events.len() as u64).collect::<Vec<_>>());
        }
        let (status, took) = process.terminate();
        assert!(
            status.success() && took < Duration::from_secs(5),
            "{status} {took:?}"
        );
    }
}

async fn upload(url: &str, csv: String) -> String {
    let request = client()
        .post(format!("{url}/v1/maneuvers"))
        .header("content-type", "text/csv");
    send(request.body(csv)).await.json()["id"]
        .as_str()
        .unwrap()
        .to_string()
}

async fn submit(url: &str, spec: &Value) -> String {
    let answer = send(client().post(format!("{url}/v1/jobs")).json(spec)).await;
    assert_eq!(answer.status, 202, "{}", answer.text());
    answer.json()["id"].as_str().unwrap().to_string()
}

async fn parameters(url: &str, id: &str) -> Value {
    send(client().get(format!("{url}/v1/jobs/{id}/parameters")))
        .await
        .json()
}

#[tokio::test]
async fn sigterm_with_a_queue_and_a_follower_loses_nothing() {
    let Busy {
        directory,
        process,
        finished,
        waiting,
    } = Busy::start().await;
    let mut follower = Stream::open(&process.url, &waiting[0], None).await.unwrap();
    let mut seen = Vec::new();
    while seen
        .last()
        .is_none_or(|event: &Received| event.event != "iteration")
    {
        seen.push(follower.next().await.expect("it runs"));
    }
    let rest = tokio::spawn(follower.rest());
    let (status, took) = tokio::task::spawn_blocking(|| process.terminate())
        .await
        .unwrap();
    assert!(status.success(), "{status}");
    assert!(took < Duration::from_secs(5), "{took:?}");
    seen.extend(rest.await.unwrap());

    // the follower goes on where it was cut off, on the new server
    let process = Process::start(directory.path(), 1);
    let last = seen.last().map(|event| event.id);
    let resumed = Stream::open(&process.url, &waiting[0], last).await.unwrap();
    seen.extend(resumed.rest().await);
    let ids: Vec<u64> = seen.iter().map(|event| event.id).collect();
    assert_eq!(ids, (1..=seen.len() as u64).collect::<Vec<_>>());
    let names: Vec<&str> = seen.iter().map(|event| event.event.as_str()).collect();
    assert!(names.contains(&"released"), "{names:?}");
    assert_eq!(names[names.len() - 1], "succeeded");
    process.terminate();
    Busy::finishes_in(&directory, &finished, &waiting).await;
}

#[tokio::test]
async fn sigkill_loses_nothing_that_was_accepted() {
    let Busy {
        directory,
        process,
        finished,
        waiting,
    } = Busy::start().await;
    let mut follower = Stream::open(&process.url, &waiting[0], None).await.unwrap();
    while follower.next().await.expect("it runs").event != "iteration" {}
    process.kill();
    Busy::finishes_in(&directory, &finished, &waiting).await;
}

#[tokio::test]
async fn clients_that_stand_still_do_not_hold_up_the_end() {
    use std::io::Write;
    let directory = TempDir::new().unwrap();
    let process = Process::start(directory.path(), 1);
    let address = process.url.strip_prefix("http://").unwrap().to_string();
    let connect = || std::net::TcpStream::connect(&address).unwrap();
    let (idle, mut head, mut body) = (connect(), connect(), connect());
    head.write_all(b"GET /v1/jobs HTTP/1.1\r\nHost: x\r\n")
        .unwrap();
    body.write_all(
        b"POST /v1/maneuvers HTTP/1.1\r\nHost: x\r\nContent-Type: text/csv\r\nContent-Length: 999\r\n\r\nt[s],",
    )
    .unwrap();
    // the server is surely reading all three when it has answered a fourth
    assert_eq!(
        send(client().get(format!("{}/health/ready", process.url)))
            .await
            .status,
        200
    );
    let (status, took) = tokio::task::spawn_blocking(|| process.terminate())
        .await
        .unwrap();
    assert!(
        status.success() && took < Duration::from_secs(5),
        "{status} {took:?}"
    );
    drop((idle, head, body));
}

#[tokio::test]
async fn an_address_that_others_can_reach_is_refused() {
    let directory = TempDir::new().unwrap();
    let database = directory.path().join("test.db");
    for address in ["0.0.0.0:0", "[::]:0"] {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_trimtab"))
            .args(["serve", "--listen", address, "--database"])
            .arg(&database)
            .output()
            .unwrap();
        assert!(!output.status.success());
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(
            said.contains("refusing to listen") && said.contains("127.0.0.1"),
            "{said}"
        );
    }
    assert!(!database.exists(), "a refusal leaves nothing behind");
}

/// A job that workers were lost with shows whether it was its doing when nothing else runs beside it.
#[tokio::test]
async fn a_job_under_suspicion_runs_alone() {
    let server = Server::start_with(Config::default(), 2).await;
    let beside = running(&server).await;
    // both are in line before a worker looks again
    let maneuver = server.upload(&elevator()).await;
    let file = crate::common::server::database(server.directory.path());
    let url = format!("sqlite://{}", file.to_str().unwrap());
    let mut database = sqlx::AnyConnection::connect(&url).await.unwrap();
    let trigger = "CREATE TRIGGER suspicion AFTER INSERT ON jobs BEGIN UPDATE jobs SET lost = 2 WHERE id = NEW.id; END";
    sqlx::query(trigger).execute(&mut database).await.unwrap();
    let suspect = server.submit(&job(&maneuver)).await;
    sqlx::query("DROP TRIGGER suspicion")
        .execute(&mut database)
        .await
        .unwrap();
    let names = async |id: &str| -> Vec<String> {
        let page = server.get(&format!("/v1/jobs/{id}/events")).await.json();
        let events = page["events"].as_array().unwrap().iter();
        events
            .map(|event| event["type"].as_str().unwrap().to_string())
            .collect()
    };
    let innocent = server.submit(&job(&maneuver)).await;
    tokio::time::sleep(Duration::from_secs(2)).await;
    assert_eq!(names(&suspect).await, ["queued", "claimed"]);
    assert_eq!(names(&innocent).await, ["queued"]);
    let cancel = format!("/v1/jobs/{beside}/cancel");
    server.post(&cancel, "text/plain", "").await;
    for id in [&suspect, &innocent] {
        assert_eq!(server.wait(id).await["status"], "succeeded");
    }
    let times = async |id: &str| server.get(&format!("/v1/jobs/{id}")).await.json();
    let (suspect, innocent) = (times(&suspect).await, times(&innocent).await);
    assert!(suspect["finished"].as_str() <= innocent["started"].as_str());
}

/// It ran for ever, and two of one key held both workers.
#[tokio::test]
async fn a_job_that_takes_longer_than_it_may_ends_with_what_it_has() {
    let workers = trimtab::work::Workers {
        count: 1,
        longest_job: Some(Duration::from_secs(2)),
    };
    let server = Server::start_with(Config::default(), workers).await;
    let maneuver = server.upload(&elevator_of(4000.0, 3)).await;
    let began = Instant::now();
    let id = server.submit(&endless_job(&maneuver)).await;
    let done = server.wait(&id).await;
    assert!(
        began.elapsed() > Duration::from_secs(2),
        "{:?}",
        began.elapsed()
    );
    assert_eq!(done["status"], "succeeded", "{done:#}");
    assert_eq!(done["outcome"], "budget");
    let reason = done["reason"].as_str().unwrap();
    assert!(reason.contains("--max-job-seconds"), "{reason}");
    let estimate = server.get(&format!("/v1/jobs/{id}/estimate")).await.json();
    assert_eq!(estimate["outcome"], "budget");
    // a short one is none the worse for it
    let short = server.submit(&job(&server.upload(&elevator()).await)).await;
    assert_eq!(server.wait(&short).await["outcome"], "converged");
}
