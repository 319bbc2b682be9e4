//! What an operator reads: one line for each request and for each job that is over, and never a secret.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use crate::common::jobs::job;
use crate::common::recordings::elevator;
use crate::common::server::{client, database, send};
use serde_json::Value;
use tempfile::TempDir;

struct Logged(Child);

impl Drop for Logged {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn trimtab(arguments: &[&str], database: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_trimtab"));
    command.args(arguments).arg("--database").arg(database);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

#[tokio::test]
async fn a_request_and_a_job_are_a_line_each() {
    let directory = TempDir::new().unwrap();
    let file = database(directory.path());
    let key = trimtab(&["key", "new"], &file).output().unwrap();
    let key = String::from_utf8(key.stdout).unwrap().trim().to_string();
    let serve = [
        "serve",
        "--listen",
        "127.0.0.1:0",
        "--workers",
        "1",
        "--log-format",
        "json",
    ];
    let mut server = Logged(trimtab(&serve, &file).spawn().unwrap());
    // from the beginning: one that nobody reads would hold the server up
    let log = BufReader::new(server.0.stderr.take().unwrap());
    let log = std::thread::spawn(|| log.lines().map(Result::unwrap).collect::<Vec<String>>());
    let mut line = String::new();
    let mut told = BufReader::new(server.0.stdout.take().unwrap());
    told.read_line(&mut line).unwrap();
    let url = line
        .trim()
        .strip_prefix("listening on ")
        .unwrap()
        .to_string();
    let post = async |path: &str, kind: &str, body: String| {
        let request = client().post(format!("{url}{path}")).bearer_auth(&key);
        send(request.header("content-type", kind).body(body)).await
    };
    let uploaded = post("/v1/maneuvers?name=e", "text/csv", elevator()).await;
    let maneuver = uploaded.json()["id"].as_str().unwrap().to_string();
    let submitted = post("/v1/jobs", "application/json", job(&maneuver).to_string()).await;
    let request = submitted.header("x-request-id").to_string();
    let id = submitted.json()["id"].as_str().unwrap().to_string();
    for _ in 0..600 {
        let answer = client()
            .get(format!("{url}/v1/jobs/{id}"))
            .bearer_auth(&key);
        if !send(answer).await.json()["finished"].is_null() {
            break;
        }
        tokio::time::sleep(std::time::Duration::from_millis(100)).await;
    }
    send(client().get(format!("{url}/health/live"))).await;
    let process = server.0.id().to_string();
    Command::new("kill")
        .args(["-TERM", &process])
        .status()
        .unwrap();
    let log = log.join().unwrap();
    let read = log
        .iter()
        .filter_map(|line| serde_json::from_str(line).ok());
    let lines: Vec<Value> = read.collect();
    let of = |message: &str| -> Vec<&Value> {
        let same = |line: &&Value| line["fields"]["message"] == message;
        lines.iter().filter(same).collect()
    };
    let answered = of("answered");
    let mut of_submission = answered
        .iter()
        .filter(|line| line["span"]["id"] == request.as_str());
    let line = of_submission.next().expect("a line of the request");
    assert!(of_submission.next().is_none());
    let fields = &line["fields"];
    assert_eq!(
        (&fields["method"], &fields["route"], &fields["status"]),
        (&"POST".into(), &"/v1/jobs".into(), &202.into()),
        "{line}"
    );
    assert!(fields["ms"].as_f64().unwrap() > 0.0);
    assert_eq!(line["span"]["project"], "default");
    let routes = |line: &&&Value| line["fields"]["route"] == "/v1/jobs/{id}";
    assert!(answered.iter().any(|line| routes(&line)), "by its template");
    assert!(!log.iter().any(|line| line.contains("/health")));

    let over = of("job left");
    assert_eq!(over.len(), 1);
    let fields = &over[0]["fields"];
    assert_eq!(fields["job"], id.as_str(), "{fields}");
    assert_eq!(
        (&fields["how"], &fields["samples"]),
        (&"converged".into(), &626.into())
    );
    assert!(fields["seconds"].as_f64().unwrap() > 0.0);
    assert!(fields["worker"].as_str().unwrap().ends_with("/1"));
    assert!(
        !log.iter().any(|line| line.contains(&key)),
        "a secret is logged"
    );
}
