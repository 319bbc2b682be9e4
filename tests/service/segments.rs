//! Segments that are proposed, over HTTP and on the command line.

use std::process::Command;

use crate::common::recordings::elevator;
use crate::common::server::Server;
use serde_json::{Value, json};
use trimtab::http::Config;

#[tokio::test]
async fn segments_are_proposed_and_go_into_a_job() {
    let server = Server::start_with(Config::default(), 1).await;
    let id = server.upload(&elevator()).await;
    let answer = server.get(&format!("/v1/maneuvers/{id}/segments")).await;
    assert_eq!(answer.status, 200, "{}", answer.text());
    let proposal = answer.json();
    assert_eq!(proposal["inputs"], json!(["de"]));
    let segments = proposal["segments"].as_array().unwrap();
    let flown = segments
        .iter()
        .find(|one| one["kind"] == "maneuver")
        .unwrap();
    assert_eq!(flown["name"], "elevator 1");
    let from = flown["seconds"][0].as_f64().unwrap();
    assert!((from - 4.0).abs() < 0.3, "{flown}");
    let job = json!({
        "model": "short-period",
        "maneuvers": [{"id": id, "label": flown["name"], "seconds": flown["seconds"]}],
    });
    let job = server.submit(&job).await;
    assert_eq!(server.wait(&job).await["outcome"], "converged");
    let none = server
        .get(&format!(
            "/v1/maneuvers/{id}/segments?quiet=0&lead=0&response=0"
        ))
        .await
        .json();
    let count = |proposal: &Value| proposal["segments"].as_array().unwrap().len();
    assert!(
        count(&none) > count(&proposal),
        "each pulse by itself: {none}"
    );
    for query in ["inputs=q2", "quiet=-1", "quiet=x", "lead=1e9", "other=1"] {
        let answer = server
            .get(&format!("/v1/maneuvers/{id}/segments?{query}"))
            .await;
        answer.problem(400, "invalid_query");
    }
    server
        .get("/v1/maneuvers/abc/segments")
        .await
        .problem(404, "unknown_maneuver");
}

#[test]
fn the_command_line_proposes_what_other_commands_take() {
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trimtab"));
        let done = command
            .args(arguments)
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (done.status.success(), text(done.stdout), text(done.stderr))
    };
    let (is_done, table, error) = run(&["segments", "data/elevator.csv"]);
    assert!(is_done && table.contains("elevator 1"), "{table}{error}");
    let part = table.split_whitespace().find(|word| {
        let seconds = word.strip_prefix("data/elevator.csv:");
        seconds.is_some_and(|seconds| !seconds.starts_with("0s"))
    });
    let (is_done, fitted, error) = run(&["fit", part.expect("a part"), "-m", "short-period"]);
    assert!(is_done && fitted.contains("Mde"), "{fitted}{error}");
    let (_, text, _) = run(&["segments", "data/elevator.csv", "--json", "--inputs", "de"]);
    let proposal: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(proposal["segments"][0]["name"], "trim 1");
    let (is_done, _, error) = run(&["segments", "data/elevator.csv", "--inputs", "stick"]);
    assert!(
        !is_done && error.contains("there is no channel 'stick'"),
        "{error}"
    );
}
