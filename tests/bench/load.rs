//! What the service adds to a job, how many it does, how many may follow it, and how fast a recording comes in:
//! `cargo bench --bench load [idle] [saturation] [followers] [upload]`, all of them if none is named.
//!
//! The server is the program itself, in a process of its own. With `LOAD_PYTHON`, the URL of a service as
//! `tests/bench/python` has it, the same load is put on that in the same run; with `PYTHON`, an interpreter that has
//! pandas, the upload is compared with its C parser.

#[path = "../common"]
#[allow(dead_code)] // the tests use the rest
mod common {
    pub(crate) mod jobs;
    pub(crate) mod process;
    pub(crate) mod recordings;
    pub(crate) mod server;
    pub(crate) mod sse;
}

use std::fmt::Write;
use std::process::Command;
use std::time::{Duration, Instant};

use common::jobs::job;
use common::process::Process;
use common::recordings::{elevator, maneuver};
use common::server::{self, client};
use common::sse;
use futures_util::StreamExt;
use reqwest::Client;
use serde_json::Value;
use tempfile::TempDir;
use trimtab::job::{self as jobs, JobSpec};
use trimtab::model::catalog;

const WORKERS: usize = 2;

#[tokio::main]
async fn main() {
    let wanted = |part: &str| {
        let parts = ["idle", "saturation", "followers", "upload"];
        let mut named = std::env::args()
            .filter(|word| parts.contains(&&**word))
            .peekable();
        named.peek().is_none() || named.any(|word| word == part)
    };
    let directory = TempDir::new().expect("a directory");
    let database = server::database(directory.path());
    let database = database.to_str().expect("a path");
    let more = [
        "--max-connections",
        "10000",
        "--max-queued-per-key",
        "100000",
        "--max-queued",
        "100000",
    ];
    let server = Process::serve_with(database, "127.0.0.1:0", WORKERS, &more);
    let ours = Ours::on(&server.url).await;
    let theirs = std::env::var("LOAD_PYTHON").ok().map(|url| Theirs {
        url,
        csv: elevator(),
    });
    println!(
        "the solver alone, in this process: {:.2} ms a job",
        solve_alone() * 1e3
    );
    if wanted("idle") {
        println!("\none job at a time, submission to result:");
        report_idle("Trimtab", idle(&ours).await);
        if let Some(theirs) = &theirs {
            report_idle("FastAPI + RQ + numba", idle(theirs).await);
        }
    }
    if wanted("saturation") {
        println!("\n1000 jobs at once, {WORKERS} workers:");
        report_rate("Trimtab", rate(&ours, 1000).await);
        if let Some(theirs) = &theirs {
            report_rate("FastAPI + RQ + numba", rate(theirs, 1000).await);
        }
    }
    if wanted("followers") {
        followers(&ours, 2000, 100).await;
    }
    if wanted("upload") {
        upload(&ours.url).await;
    }
}

/// Seconds that a job takes without a service: the data in memory, the plan made anew each time.
fn solve_alone() -> f64 {
    let maneuver = maneuver(elevator().as_bytes());
    let spec: JobSpec = serde_json::from_value(job("x")).expect("a job");
    let model = catalog::find("short-period").expect("a model");
    let mut times: Vec<f64> = (0..101)
        .map(|_| {
            let began = Instant::now();
            let plan =
                jobs::prepare(&spec, &model, std::slice::from_ref(&maneuver)).expect("a plan");
            jobs::run(&plan, &mut |_| std::ops::ControlFlow::Continue(())).expect("a result");
            began.elapsed().as_secs_f64()
        })
        .collect();
    median(&mut times)
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// A service that takes jobs.
trait Target {
    async fn submit(&self, client: &Client) -> String;
    async fn is_done(&self, client: &Client, job: &str) -> bool;
}

struct Ours {
    url: String,
    spec: String,
}

impl Ours {
    async fn on(url: &str) -> Self {
        let request = client().post(format!("{url}/v1/maneuvers"));
        let request = request.header("content-type", "text/csv").body(elevator());
        let stored = json(request).await;
        Self {
            url: url.to_string(),
            spec: job(stored["id"].as_str().expect("an id")).to_string(),
        }
    }
}

impl Target for Ours {
    async fn submit(&self, client: &Client) -> String {
        let request = client.post(format!("{}/v1/jobs", self.url));
        let request = request.header("content-type", "application/json");
        let job = json(request.body(self.spec.clone())).await;
        job["id"].as_str().expect("an id").to_string()
    }

    async fn is_done(&self, client: &Client, job: &str) -> bool {
        let job = json(client.get(format!("{}/v1/jobs/{job}", self.url))).await;
        assert_ne!(job["status"], "failed", "{job:#}");
        !job["finished"].is_null()
    }
}

struct Theirs {
    url: String,
    csv: String,
}

impl Target for Theirs {
    async fn submit(&self, client: &Client) -> String {
        let request = client.post(format!("{}/jobs", self.url));
        let job = json(request.body(self.csv.clone())).await;
        job["id"].as_str().expect("an id").to_string()
    }

    async fn is_done(&self, client: &Client, job: &str) -> bool {
        let job = json(client.get(format!("{}/jobs/{job}", self.url))).await;
        assert_ne!(job["status"], "failed", "{job:#}");
        job["status"] == "finished"
    }
}

async fn json(request: reqwest::RequestBuilder) -> Value {
    let answer = server::send(request).await;
    assert!(answer.status.is_success(), "{}", answer.text());
    answer.json()
}

async fn wait(target: &impl Target, client: &Client, job: &str) {
    while !target.is_done(client, job).await {
        tokio::time::sleep(Duration::from_millis(1)).await;
    }
}

/// Median and 95th percentile of 100 jobs, s.
async fn idle(target: &impl Target) -> (f64, f64) {
    let client = client();
    let mut times = Vec::new();
    for number in 0..105 {
        let began = Instant::now();
        let job = target.submit(&client).await;
        wait(target, &client, &job).await;
        // the first ones warm up
        if number >= 5 {
            times.push(began.elapsed().as_secs_f64());
        }
    }
    let middle = median(&mut times);
    (middle, times[times.len() * 95 / 100])
}

fn report_idle(name: &str, (median, most): (f64, f64)) {
    println!(
        "{name:22} median {:8.2} ms, 95 % within {:8.2} ms",
        median * 1e3,
        most * 1e3
    );
}

/// Seconds until all of them are done; they are submitted by 16 at a time.
async fn rate(target: &impl Target, count: usize) -> (usize, f64) {
    let client = client();
    let began = Instant::now();
    let submitted = futures_util::stream::iter(0..count).map(|_| target.submit(&client));
    let jobs: Vec<String> = submitted.buffer_unordered(16).collect().await;
    for job in jobs.iter().rev() {
        while !target.is_done(&client, job).await {
            tokio::time::sleep(Duration::from_millis(20)).await;
        }
    }
    (count, began.elapsed().as_secs_f64())
}

fn report_rate(name: &str, (count, seconds): (usize, f64)) {
    let each = seconds * WORKERS as f64 / count as f64;
    println!(
        "{name:22} {:8.1} jobs/s, {:6.2} ms of a worker each",
        count as f64 / seconds,
        each * 1e3
    );
}

/// Many follow a few jobs at once: each sees all events of its job, in order.
async fn followers(ours: &Ours, followers: usize, jobs: usize) {
    let client = client();
    let mut ids = Vec::new();
    for _ in 0..jobs {
        ids.push(ours.submit(&client).await);
    }
    let began = Instant::now();
    let all = (0..followers).map(|number| {
        let (url, job) = (ours.url.clone(), ids[number % jobs].clone());
        tokio::spawn(async move {
            let stream = sse::Stream::open(&url, &job, Some(0)).await;
            let events = match stream {
                Some(stream) => stream.rest().await,
                None => panic!("nothing to follow"),
            };
            (job, events)
        })
    });
    let all = futures_util::future::join_all(all).await;
    let seconds = began.elapsed().as_secs_f64();
    let (mut events, mut complete) = (0, 0);
    for followed in all {
        let (job, seen) = followed.expect("a follower");
        let kept = json(client.get(format!("{}/v1/jobs/{job}/events?limit=1000", ours.url))).await;
        let kept = kept["events"].as_array().expect("a list").len() as u64;
        events += seen.len();
        complete += usize::from(seen.iter().map(|event| event.id).eq(1..=kept));
    }
    println!(
        "\n{followers} clients follow {jobs} jobs: {complete} saw every event once and in order, {events} events in {seconds:.1} s"
    );
    assert_eq!(complete, followers);
}

/// A recording of just under 100 MB: 14 channels of 12 digits.
fn recording() -> String {
    let names = (0..14).fold(String::from("t[s]"), |text, number| {
        format!("{text},c{number}[m/s]")
    });
    let mut text = names;
    let mut row = 0_u32;
    while text.len() < 99_000_000 {
        write!(text, "\n{:.2}", f64::from(row) * 0.01).expect("text");
        for channel in 0..14 {
            let value = (f64::from(row) * 1e-3 + f64::from(channel)).sin() * 100.0;
            write!(text, ",{value:.9}").expect("text");
        }
        row += 1;
    }
    text
}

async fn upload(url: &str) {
    let text = recording();
    let (bytes, rows) = (text.len() as f64 / 1e6, text.lines().count() - 1);
    println!("\na CSV of {bytes:.0} MB, {rows} rows of 15 columns:");
    let client = client();
    let mut best = f64::MAX;
    for number in 0..4 {
        // each is new: what is known already is answered without being kept again
        let body = text.replacen("c0", &format!("d{number}"), 1);
        let request = client.post(format!("{url}/v1/maneuvers"));
        let request = request.header("content-type", "text/csv").body(body);
        let began = Instant::now();
        json(request).await;
        best = f64::min(best, began.elapsed().as_secs_f64());
    }
    println!(
        "Trimtab, sent, read, checked, summarised and stored: {best:.2} s, {:.0} MB/s",
        bytes / best
    );
    let mut best = f64::MAX;
    for _ in 0..3 {
        let began = Instant::now();
        maneuver(text.as_bytes());
        best = f64::min(best, began.elapsed().as_secs_f64());
    }
    println!(
        "of that, reading and checking:                       {best:.2} s, {:.0} MB/s",
        bytes / best
    );
    let Ok(python) = std::env::var("PYTHON") else {
        return;
    };
    let directory = TempDir::new().expect("a directory");
    let file = directory.path().join("recording.csv");
    std::fs::write(&file, text).expect("a file");
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/bench/python/upload.py");
    let said = Command::new(python)
        .arg(script)
        .arg(file)
        .output()
        .expect("python");
    let text = String::from_utf8_lossy(&said.stdout);
    let theirs: f64 = text.trim().parse().expect("seconds");
    println!(
        "pandas, C parser, from a file in memory:             {theirs:.2} s, {:.0} MB/s",
        bytes / theirs
    );
}
