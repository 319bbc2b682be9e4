//! The command line as a client of a server: lists, results, and what is taken away.

use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

use crate::common::process::Process;

/// A server of its own, and commands that speak to it.
struct Client {
    _directory: TempDir,
    server: Process,
}

impl Client {
    fn start(workers: usize) -> Self {
        let directory = TempDir::new().expect("a directory");
        let server = Process::start(directory.path(), workers);
        Self {
            _directory: directory,
            server,
        }
    }

    fn output(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trimtab"));
        command.args(arguments).args(["--server", &self.server.url]);
        command.current_dir(Path::new(env!("CARGO_MANIFEST_DIR")));
        command.output().expect("the program runs")
    }

    #[track_caller]
    fn says(&self, arguments: &[&str]) -> String {
        let output = self.output(arguments);
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stdout)
    }

    #[track_caller]
    fn refuses(&self, arguments: &[&str]) -> String {
        let output = self.output(arguments);
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stdout));
        text(&output.stderr)
    }

    #[track_caller]
    fn json(&self, arguments: &[&str]) -> Value {
        serde_json::from_str(&self.says(arguments)).expect("JSON")
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

fn rows(csv: &str) -> Vec<Vec<&str>> {
    csv.lines().map(|line| line.split(',').collect()).collect()
}

#[test]
fn recordings_are_uploaded_by_themselves() {
    let client = Client::start(0);
    let ids = client.says(&["upload", "data/elevator.csv", "data/rudder.csv"]);
    let ids: Vec<&str> = ids.lines().collect();
    assert_eq!(ids.len(), 2);
    let listed = client.says(&["maneuver", "list"]);
    assert!(ids.iter().all(|id| listed.contains(id)), "{listed}");
    let again = client.json(&["upload", "data/elevator.csv", "--json"]);
    assert_eq!(
        (&again[0]["id"], &again[0]["name"]),
        (&Value::from(ids[0]), &Value::from("elevator"))
    );
    let table = client.says(&["upload", "data/rudder.csv", "--name", "other", "--csv"]);
    assert_eq!(rows(&table)[0], ["id", "name", "s", "samples"]);
    assert_eq!(rows(&table)[1][0], ids[1]);
    let refused = client.refuses(&[
        "upload",
        "data/elevator.csv",
        "data/rudder.csv",
        "--name",
        "x",
    ]);
    assert!(refused.contains("--name is for one file"), "{refused}");
    let refused = client.refuses(&["upload", "Cargo.toml"]);
    assert!(
        refused.contains("Cargo.toml") && refused.contains("422"),
        "{refused}"
    );
}

#[test]
fn results_are_tables_csv_and_json() {
    let client = Client::start(1);
    let job = [
        "submit",
        "data/elevator.csv",
        "-m",
        "short-period",
        "--watch",
    ];
    let watched = client.says(&job);
    let (job, _) = watched.split_once('\n').expect("the id");
    let shown = client.says(&["results", job]);
    assert!(shown.contains("Mde") && shown.contains("Theil"), "{shown}");

    let json = client.json(&["results", job, "--json"]);
    let csv = client.says(&["results", job, "--csv"]);
    let (head, body) = (rows(&csv)[0].clone(), &rows(&csv)[1..]);
    let at = |title: &str| {
        head.iter()
            .position(|known| *known == title)
            .expect("a column")
    };
    let parameters = json["parameters"].as_array().expect("a list");
    assert_eq!(body.len(), parameters.len());
    for (row, parameter) in body.iter().zip(parameters) {
        assert_eq!(row[at("name")], parameter["name"].as_str().expect("a name"));
        let estimate: f64 = row[at("estimate")].parse().expect("a number");
        assert_eq!(Some(estimate), parameter["estimate"].as_f64());
    }

    let histories = client.says(&[
        "results",
        job,
        "time-histories",
        "--from",
        "5",
        "--to",
        "10",
    ]);
    // 0.04 s a row, both ends included, and the header
    assert_eq!(histories.lines().count(), 127, "{histories}");
    let file = std::env::temp_dir().join(format!("trimtab-results-{}.csv", std::process::id()));
    let path = file.to_str().expect("a path");
    assert_eq!(
        client.says(&["results", job, "residuals", "--csv", "-o", path]),
        ""
    );
    let written = std::fs::read_to_string(&file).expect("written");
    std::fs::remove_file(&file).expect("removed");
    assert_eq!(written.lines().count(), 627);
    let model = client.says(&["results", job, "model"]);
    assert!(model.contains("[parameters.Ma]"), "{model}");
    assert_eq!(
        client.json(&["results", job, "spec"])["model"],
        "short-period"
    );
    for (what, words) in [
        (&["diagnosis"][..], "404"),
        (
            &["estimate", "--csv"],
            "estimate is not a table; use --json",
        ),
        (
            &["spec", "--max-points", "7"],
            "--max-points is for time-histories",
        ),
    ] {
        let refused = client.refuses(&[&["results", job], what].concat());
        assert!(refused.contains(words), "{refused}");
    }
    assert!(
        client
            .refuses(&["results", "a/../b"])
            .contains("there is no job 'a/../b'")
    );
}

#[test]
fn jobs_are_listed_cancelled_and_deleted() {
    let client = Client::start(0);
    let submitted = ["aileron", "rudder"].map(|name| {
        let file = format!("data/{name}.csv");
        let id = client.says(&["submit", &file, "-m", "lateral-directional-4"]);
        id.trim().to_string()
    });
    let [first, second] = &submitted;
    let listed = client.json(&["jobs", "--json"]);
    let ids = |listed: &Value| -> Vec<String> {
        let jobs = listed.as_array().expect("a list").iter();
        jobs.map(|job| job["id"].as_str().expect("an id").to_string())
            .collect()
    };
    assert_eq!(ids(&listed), [second.clone(), first.clone()]);
    assert_eq!(
        ids(&client.json(&["jobs", "--json", "--search", "rudder"])),
        std::slice::from_ref(second)
    );
    assert_eq!(
        ids(&client.json(&["jobs", "--json", "--limit", "1"])).len(),
        1
    );
    let csv = client.says(&["jobs", "--csv", "--status", "queued"]);
    assert_eq!(rows(&csv)[0][..4], ["id", "title", "kind", "status"]);
    assert_eq!(rows(&csv)[1][2..4], ["estimate", "queued"]);
    let refused = client.refuses(&["jobs", "--status", "lost"]);
    assert!(
        refused.contains("lost") && refused.contains("queued"),
        "{refused}"
    );

    assert_eq!(
        client.says(&["cancel", first, second]),
        format!("{first} cancelled\n{second} cancelled\n")
    );
    assert!(client.refuses(&["cancel", first]).contains("409"));
    let table = client.says(&["jobs"]);
    // status and outcome of both
    assert_eq!(table.matches("cancelled").count(), 4, "{table}");
    assert_eq!(
        client.says(&["delete", "job", first]),
        format!("{first} deleted\n")
    );
    assert_eq!(
        ids(&client.json(&["jobs", "--json"])),
        std::slice::from_ref(second)
    );
    assert!(
        client
            .refuses(&["delete", "job", first])
            .contains("there is no job")
    );

    // what the server says is said once
    let refused = client.refuses(&["submit", "data/rudder.csv", "-m", "short-period"]);
    assert!(refused.contains("alpha"), "{refused}");
    for line in refused.lines().map(str::trim) {
        assert_eq!(refused.matches(line).count(), 1, "{line}: {refused}");
    }

    let maneuver = client.says(&["upload", "data/rudder.csv"]);
    let in_use = client.refuses(&["delete", "maneuver", maneuver.trim()]);
    assert!(in_use.contains("409"), "{in_use}");
    client.says(&["delete", "job", second]);
    client.says(&["delete", "maneuver", maneuver.trim()]);
    assert!(!client.says(&["maneuver", "list"]).contains(maneuver.trim()));
}

#[test]
fn lists_go_on_over_pages() {
    let client = Client::start(0);
    let spec = r#"{"job": {"model": "short-period"}, "maneuvers": ["#;
    let id = client.says(&["upload", "data/elevator.csv"]);
    let uses = vec![format!("{{\"id\": \"{}\"}}", id.trim()); 210].join(",");
    let runtime = tokio::runtime::Runtime::new().expect("a runtime");
    let submitted = runtime.block_on(async {
        let request =
            crate::common::server::client().post(format!("{}/v1/jobs/bulk", client.server.url));
        let request = request.header("content-type", "application/json");
        crate::common::server::send(request.body(format!("{spec}{uses}]}}"))).await
    });
    assert_eq!(submitted.status, 202, "{}", submitted.text());
    let listed = client.json(&["jobs", "--json", "--limit", "1000"]);
    let mut ids: Vec<&str> = listed
        .as_array()
        .expect("a list")
        .iter()
        .map(|job| job["id"].as_str().expect("an id"))
        .collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), 210);
    assert_eq!(
        client
            .json(&["jobs", "--json", "--limit", "203"])
            .as_array()
            .map(Vec::len),
        Some(203)
    );
}

#[test]
fn models_are_stored_shown_and_deleted() {
    let client = Client::start(0);
    let file = std::env::temp_dir().join(format!("trimtab-model-{}.toml", std::process::id()));
    let document = client.says(&["models", "short-period"]);
    std::fs::write(&file, document.replacen("short-period", "mine", 1)).expect("written");
    let id = client.says(&["models", "--add", file.to_str().expect("a path")]);
    std::fs::remove_file(&file).expect("removed");
    let id = id.trim();
    let listed = client.json(&["models", "--json", "--search", "mine"]);
    assert_eq!(
        (&listed[0]["id"], &listed[0]["origin"]),
        (&Value::from(id), &Value::from("stored"))
    );
    assert!(client.says(&["models", id]).contains("name = \"mine\""));
    assert_eq!(client.json(&["models", id, "--json"])["name"], "mine");
    let table = client.says(&["models"]);
    assert!(
        table.contains(id) && table.contains("six-degrees-of-freedom"),
        "{table}"
    );
    // what a table has no room for is in CSV
    assert!(
        table.lines().all(|line| line.chars().count() < 140),
        "{table}"
    );
    assert!(
        client
            .says(&["models", "--csv"])
            .starts_with("id,origin,name,title,inputs,outputs,created\n")
    );
    for both in [
        [id, "--csv"],
        [id, "--limit=3"],
        ["--add=x.toml", "--json"],
        ["--add=x.toml", "--search=x"],
    ] {
        let refused = client.output(&["models", both[0], both[1]]);
        assert_eq!(refused.status.code(), Some(2), "{both:?}");
    }
    client.says(&["delete", "model", id]);
    assert!(!client.says(&["models", "--csv"]).contains(id));
    assert!(
        client
            .refuses(&["delete", "model", "short-period"])
            .contains("catalog")
    );
}

/// `trimtab ... | head` reads a line and closes the pipe.
#[test]
fn a_reader_that_has_seen_enough_is_no_fault() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_trimtab"))
        .args(["model", "six-degrees-of-freedom"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert!(
        !text(&output.stderr).contains("panicked"),
        "{}",
        text(&output.stderr)
    );
}
