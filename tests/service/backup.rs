//! Databases carried away while they are worked with, and put back.

use std::path::Path;
use std::process::{Command, Output};

use crate::common::jobs::job;
use crate::common::process::Process;
use crate::common::recordings::elevator;
use crate::common::server::{client, database, send, wait};
use serde_json::Value;
use tempfile::TempDir;

fn trimtab(arguments: &[&str], database: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_trimtab"))
        .args(arguments)
        .arg("--database")
        .arg(database)
        .output()
        .unwrap()
}

#[track_caller]
fn said(output: &Output, is_good: bool) -> String {
    let text = [&output.stdout[..], &output.stderr[..]].concat();
    let text = String::from_utf8(text).unwrap();
    assert_eq!(output.status.success(), is_good, "{text}");
    text
}

async fn get(url: &str) -> Value {
    send(client().get(url)).await.json()
}

/// Uploads and submits; the job's id.
async fn submitted(url: &str) -> String {
    let upload = client().post(format!("{url}/v1/maneuvers"));
    let upload = upload.header("content-type", "text/csv").body(elevator());
    let maneuver = send(upload).await.json()["id"]
        .as_str()
        .unwrap()
        .to_string();
    let submit = client().post(format!("{url}/v1/jobs"));
    let submit = submit.header("content-type", "application/json");
    let answer = send(submit.body(job(&maneuver).to_string())).await;
    answer.json()["id"].as_str().unwrap().to_string()
}

#[tokio::test]
async fn a_running_service_is_backed_up_and_restored_elsewhere() {
    let [here, there] = [(); 2].map(|()| TempDir::new().unwrap());
    let server = Process::start(here.path(), 1);
    let id = submitted(&server.url).await;
    wait(&server.url, &id).await;
    let parameters = get(&format!("{}/v1/jobs/{id}/parameters", server.url)).await;
    let file = there.path().join("backup.db");
    let name = file.to_str().unwrap();
    let backup = trimtab(&["backup", name], &database(here.path()));
    let text = said(&backup, true);
    assert!(
        text.contains("whole: 1 jobs, 1 results, 1 maneuvers, 0 models"),
        "{text}"
    );
    // what comes behind it is not in it, and the service goes on
    let later = submitted(&server.url).await;
    wait(&server.url, &later).await;
    // a file is not written over
    let again = trimtab(&["backup", name], &database(here.path()));
    assert!(said(&again, false).contains("there is a file of this name"));

    let restored = trimtab(&["restore", name], &database(there.path()));
    assert_eq!(said(&restored, true), text);
    let again = trimtab(&["restore", name], &database(there.path()));
    assert!(said(&again, false).contains("there is a database already"));
    assert_eq!(
        said(&trimtab(&["check"], &database(there.path())), true),
        text
    );
    let copy = Process::start(there.path(), 1);
    assert_eq!(
        get(&format!("{}/v1/jobs/{id}/parameters", copy.url)).await,
        parameters
    );
    let jobs = get(&format!("{}/v1/jobs", copy.url)).await;
    assert_eq!(jobs["jobs"].as_array().unwrap().len(), 1);
    let next = submitted(&copy.url).await;
    assert_eq!(wait(&copy.url, &next).await["status"], "succeeded");
}

#[tokio::test]
async fn a_file_that_is_damaged_is_no_backup() {
    let directory = TempDir::new().unwrap();
    let server = Process::start(directory.path(), 1);
    let id = submitted(&server.url).await;
    wait(&server.url, &id).await;
    let file = directory.path().join("backup.db");
    let name = file.to_str().unwrap();
    said(
        &trimtab(&["backup", name], &database(directory.path())),
        true,
    );
    let mut bytes = std::fs::read(&file).unwrap();
    let middle = bytes.len() / 2 / 4096 * 4096;
    bytes[middle..middle + 4096].fill(0xa5);
    std::fs::write(&file, bytes).unwrap();
    let refused = trimtab(&["check"], &file);
    assert!(said(&refused, false).contains("it is damaged"));
    let elsewhere = TempDir::new().unwrap();
    said(
        &trimtab(&["restore", name], &database(elsewhere.path())),
        false,
    );
    assert!(!database(elsewhere.path()).exists());
    let other = directory.path().join("notes.txt");
    std::fs::write(&other, "no database".repeat(100)).unwrap();
    let refused = said(&trimtab(&["check"], &other), false);
    assert!(
        refused.contains("notes.txt") && refused.contains("not a database"),
        "{refused}"
    );
    let missing = said(
        &trimtab(&["check"], &directory.path().join("missing.db")),
        false,
    );
    assert!(missing.contains("there is no such file"), "{missing}");
    let postgres = trimtab(
        &["backup", name],
        Path::new("postgres://lab:s3cret@host/trimtab"),
    );
    let refused = said(&postgres, false);
    assert!(
        refused.contains("pg_dump") && !refused.contains("s3cret"),
        "{refused}"
    );
}
