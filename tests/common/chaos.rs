//! Jobs while processes are killed and databases restarted: each accepted job ends once, with every event of it.

use std::collections::{BTreeMap, HashSet};
use std::fmt;
use std::process::Command;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tokio::task::JoinSet;
use tokio::time::sleep;

use super::jobs::job;
use super::process::{Process, own_address};
use super::recordings::{elevator, elevator_of};
use super::server::{Answer, client};
use super::sse::Stream;

pub(crate) struct Chaos<'a> {
    /// As an operator would give it.
    pub database: &'a str,
    /// At least; as many more as it takes until all kills were.
    pub jobs: usize,
    /// Processes that work; with none the server works itself, and is what is killed.
    pub workers: usize,
    /// One of them is killed (SIGKILL), and another started, this often or less: only while all of them are seen
    /// to work, or the chaos would be none.
    pub kill_every: Duration,
    /// So many are.
    pub kills: usize,
    /// How often the server is restarted on the way.
    pub server_restarts: usize,
    /// How often the database is, and the command that does it.
    pub database_restarts: usize,
    pub control: Option<String>,
}

#[derive(Debug, Default)]
pub(crate) struct Report {
    pub kills: usize,
    pub server_restarts: usize,
    pub database_restarts: usize,
    pub took: Duration,
    /// Jobs by how they ended.
    pub ended: BTreeMap<String, usize>,
    /// Jobs that had to be taken up again.
    pub taken_over: usize,
    pub events: usize,
    /// Times at which somebody who followed a job had to ask again.
    pub reconnects: usize,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (ending, jobs) in &self.ended {
            writeln!(f, "{jobs:6} jobs ended: {ending}")?;
        }
        writeln!(f, "{:6} of them taken over", self.taken_over)?;
        writeln!(f, "{:6} events, each seen once", self.events)?;
        writeln!(f, "{:6} times a follower had to ask again", self.reconnects)?;
        writeln!(f, "{:6} processes killed", self.kills)?;
        writeln!(f, "{:6} restarts of the server", self.server_restarts)?;
        writeln!(f, "{:6} restarts of the database", self.database_restarts)?;
        write!(f, "{:6.0} s in all", self.took.as_secs_f64())
    }
}

/// How long the whole may take before something is stuck.
const STUCK: Duration = Duration::from_secs(1800);

/// Jobs that are followed at a time.
const FOLLOWED: usize = 40;

impl Chaos<'_> {
    /// # Panics
    /// A promise was broken.
    pub(crate) async fn run(&self) -> Report {
        let began = Instant::now();
        let in_server = if self.workers == 0 { 2 } else { 0 };
        let server = Process::serve(self.database, &own_address(), in_server);
        let url = server.url.clone();
        let listen = url.strip_prefix("http://").expect("a URL").to_string();
        let server = Mutex::new(Some(server));
        let restart = || {
            let old = server.lock().unwrap().take();
            drop(old);
            // the port may be in use by a connection that is closing
            let new = Process::serve(self.database, &listen, in_server);
            *server.lock().unwrap() = Some(new);
        };
        let short = upload(&url, elevator()).await;
        let long = upload(&url, elevator_of(300.0, 5)).await;
        let over = AtomicBool::new(false);
        let kills = AtomicUsize::new(0);
        let seen = Arc::new(Seen::default());

        let submit_and_follow = async {
            let mut followed = JoinSet::new();
            let mut jobs = Vec::new();
            let mut number = 0;
            while number < self.jobs || kills.load(Ordering::Relaxed) < self.kills {
                let maneuver = if number % 5 == 0 { &long } else { &short };
                let id = submit(&url, number, &job(maneuver)).await;
                followed.spawn(follow(url.clone(), id, seen.clone()));
                number += 1;
                if followed.len() >= FOLLOWED {
                    jobs.extend(followed.join_next().await);
                }
            }
            while let Some(job) = followed.join_next().await {
                jobs.push(job);
            }
            let jobs: Vec<Followed> = (jobs.into_iter())
                .map(|job| job.expect("somebody who followed"))
                .collect();
            over.store(true, Ordering::Relaxed);
            jobs
        };
        let kill = async {
            let mut workers: Vec<Process> = (0..self.workers)
                .map(|_| Process::work(self.database, 1))
                .collect();
            for number in 0..self.kills {
                sleep(self.kill_every).await;
                seen.at_work.lock().unwrap().clear();
                while seen.at_work.lock().unwrap().len() < self.workers.max(1) {
                    sleep(Duration::from_millis(2)).await;
                }
                if workers.is_empty() {
                    restart();
                } else {
                    workers.remove(number % self.workers).kill();
                    workers.push(Process::work(self.database, 1));
                }
                kills.fetch_add(1, Ordering::Relaxed);
            }
            while !over.load(Ordering::Relaxed) {
                sleep(Duration::from_millis(50)).await;
            }
        };
        let restarts = async {
            let (mut of_server, mut of_database) = (0, 0);
            let all = self.server_restarts + self.database_restarts;
            for number in 0..all {
                // spread over the whole
                let share = self.jobs * (number + 1) / (all + 1);
                while seen.ended.load(Ordering::Relaxed) < share && began.elapsed() < STUCK {
                    sleep(Duration::from_millis(50)).await;
                }
                if (number % 2 == 0 && of_database < self.database_restarts)
                    || of_server == self.server_restarts
                {
                    of_database += 1;
                    let control = self.control.as_deref().expect("a command");
                    let command = format!("{control} restart");
                    let done = tokio::task::spawn_blocking(move || {
                        Command::new("sh").args(["-c", &command]).status()
                    });
                    assert!(done.await.unwrap().unwrap().success());
                } else {
                    of_server += 1;
                    restart();
                }
            }
            (of_server, of_database)
        };
        let all = async { tokio::join!(submit_and_follow, kill, restarts) };
        let (jobs, (), (server_restarts, database_restarts)) = tokio::time::timeout(STUCK, all)
            .await
            .expect("nothing is stuck");
        let mut report = Report {
            kills: kills.into_inner(),
            server_restarts,
            database_restarts,
            took: began.elapsed(),
            reconnects: seen.reconnects.load(Ordering::Relaxed),
            ..Report::default()
        };
        check(&url, &jobs, &mut report).await;
        report
    }
}

/// Asks until there is an answer that is neither of a fault nor of haste.
async fn until_answered(ask: impl Fn() -> reqwest::RequestBuilder) -> Answer {
    loop {
        if let Ok(response) = ask().send().await {
            let (status, headers) = (response.status(), response.headers().clone());
            let again =
                status.is_server_error() || (status == 409 && headers.contains_key("retry-after"));
            if let (false, Ok(bytes)) = (again, response.bytes().await) {
                let bytes = bytes.to_vec();
                return Answer {
                    status,
                    headers,
                    bytes,
                };
            }
        }
        sleep(Duration::from_millis(100)).await;
    }
}

async fn get(url: String) -> Value {
    let client = client();
    let answer = until_answered(|| client.get(&url)).await;
    assert_eq!(answer.status, 200, "{url}: {}", answer.text());
    answer.json()
}

async fn upload(url: &str, csv: String) -> String {
    let client = client();
    let ask = || {
        client
            .post(format!("{url}/v1/maneuvers"))
            .header("content-type", "text/csv")
            .body(csv.clone())
    };
    let answer = until_answered(ask).await;
    answer.json()["id"].as_str().expect("an id").to_string()
}

async fn submit(url: &str, number: usize, spec: &Value) -> String {
    let client = client();
    let mut spec = spec.clone();
    spec["name"] = json!(format!("{number}"));
    let ask = || {
        client
            .post(format!("{url}/v1/jobs"))
            .header("content-type", "application/json")
            .header("idempotency-key", format!("chaos-{number}"))
            .body(spec.to_string())
    };
    let answer = until_answered(ask).await;
    assert_eq!(answer.status, 202, "{}", answer.text());
    answer.json()["id"].as_str().expect("an id").to_string()
}

/// A job as somebody saw it who followed its events, resuming where the line was cut.
struct Followed {
    id: String,
    events: Vec<(u64, String)>,
}

/// What those who follow jobs have seen, all together.
#[derive(Default)]
struct Seen {
    /// Jobs of which a sign of work was seen, and no end.
    at_work: Mutex<HashSet<String>>,
    ended: AtomicUsize,
    reconnects: AtomicUsize,
}

async fn follow(url: String, id: String, seen: Arc<Seen>) -> Followed {
    let mut events: Vec<(u64, String)> = Vec::new();
    let is_last = |name: &str| ["succeeded", "failed", "cancelled"].contains(&name);
    while !events.last().is_some_and(|(_, name)| is_last(name)) {
        let after = events.last().map_or(0, |(number, _)| *number);
        if let Some(mut stream) = Stream::try_open(&url, &id, after).await {
            while let Some(event) = stream.next().await {
                let mut at_work = seen.at_work.lock().unwrap();
                if is_last(&event.event) {
                    at_work.remove(&id);
                } else if event.event != "queued" {
                    at_work.insert(id.clone());
                }
                events.push((event.id, event.event));
            }
        }
        if !events.last().is_some_and(|(_, name)| is_last(name)) {
            seen.reconnects.fetch_add(1, Ordering::Relaxed);
            sleep(Duration::from_millis(100)).await;
        }
    }
    seen.ended.fetch_add(1, Ordering::Relaxed);
    Followed { id, events }
}

/// What was promised, by what the server has now.
async fn check(url: &str, jobs: &[Followed], report: &mut Report) {
    let distinct: HashSet<&str> = jobs.iter().map(|job| job.id.as_str()).collect();
    assert_eq!(distinct.len(), jobs.len(), "each was accepted once");
    let (mut listed, mut cursor) = (0, String::new());
    loop {
        let page = get(format!("{url}/v1/jobs?limit=200{cursor}")).await;
        listed += page["jobs"].as_array().expect("a list").len();
        let Some(next) = page["next_cursor"].as_str() else {
            break;
        };
        cursor = format!("&cursor={next}");
    }
    assert_eq!(listed, jobs.len(), "nothing was submitted twice");
    for Followed { id, events } in jobs {
        let numbers: Vec<u64> = events.iter().map(|(number, _)| *number).collect();
        let all: Vec<u64> = (1..=events.len() as u64).collect();
        assert_eq!(numbers, all, "{id}: no event missing, none twice");
        let kept = get(format!("{url}/v1/jobs/{id}/events?limit=1000")).await;
        let kept: Vec<(u64, String)> = (kept["events"].as_array().expect("a list").iter())
            .map(|event| {
                let name = event["type"].as_str().expect("a type").to_string();
                (event["seq"].as_u64().expect("a number"), name)
            })
            .collect();
        assert_eq!(&kept, events, "{id}");
        let of = |names: &[&str]| {
            let same = kept
                .iter()
                .filter(|(_, name)| names.contains(&name.as_str()));
            same.count()
        };
        assert_eq!(
            of(&["succeeded", "failed", "cancelled"]),
            1,
            "{id} ended once"
        );
        let record = get(format!("{url}/v1/jobs/{id}")).await;
        assert_eq!(record["attempt"], of(&["claimed"]), "{id}");
        report.taken_over += usize::from(of(&["claimed"]) > 1);
        report.events += kept.len();
        let ending = match record["status"].as_str().expect("a status") {
            "succeeded" => {
                assert_eq!(record["outcome"], "converged", "{id}");
                let estimate = get(format!("{url}/v1/jobs/{id}/estimate")).await;
                assert_eq!(estimate["outcome"], "converged", "{id}");
                "succeeded".to_string()
            }
            // workers were killed with it, some that ran nothing else: it is not tried for ever
            "failed" => {
                assert_eq!(record["faults"][0]["code"], "workers_lost", "{record:#}");
                "workers lost".to_string()
            }
            other => panic!("{id} is {other}"),
        };
        *report.ended.entry(ending).or_default() += 1;
    }
}
