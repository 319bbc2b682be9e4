//! Confidence intervals by refits, asked for over HTTP and on the command line, and shown on pages.

use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

use crate::common::jobs::job;
use crate::common::recordings::elevator;
use crate::common::server::Server;

const METHODS: [&str; 6] = [
    "conventional",
    "corrected",
    "bootstrap",
    "profile",
    "profile_corrected",
    "monte_carlo",
];

#[tokio::test]
async fn intervals_are_in_the_estimate_on_the_page_and_in_the_report() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let mut spec = job(&maneuver);
    spec["options"]["confidence_intervals"] = json!({"bootstrap": 100, "monte_carlo": 100});
    let id = server.submit(&spec).await;
    let done = server.wait(&id).await;
    assert_eq!(done["status"], "succeeded", "{done:#}");

    let estimate = server.get(&format!("/v1/jobs/{id}/estimate")).await.json();
    let found = &estimate["confidence_intervals"];
    assert_eq!(found["bootstrap"]["replicates"], 100, "{found:#}");
    let of = |name: &str| -> &Value {
        let mut all = found["parameters"].as_array().expect("parameters").iter();
        all.find(|parameter| parameter["name"] == name)
            .expect("the parameter")
    };
    let ma = of("Ma");
    let methods: Vec<&str> = (ma["intervals"].as_array().expect("intervals").iter())
        .map(|interval| interval["method"].as_str().expect("a name"))
        .collect();
    assert_eq!(methods, METHODS);
    for interval in ma["intervals"].as_array().expect("intervals") {
        let end = |name: &str| interval[name].as_f64().expect("a number");
        let estimate = ma["estimate"].as_f64().expect("a number");
        assert!(
            end("lower") < estimate && estimate < end("upper"),
            "{interval}"
        );
    }

    // how far it was, as events
    let events = server.get(&format!("/v1/jobs/{id}/events")).await;
    let text = events.text();
    for told in [
        "profile likelihood: 9 parameters",
        "bootstrap: 100 of 100 fits",
        "Monte Carlo: 50 of 100 fits",
    ] {
        assert!(text.contains(told), "no '{told}' in {text}");
    }

    for path in [format!("/jobs/{id}"), format!("/jobs/{id}/report")] {
        let page = server.get(&path).await.text();
        for part in [
            "95 % confidence intervals",
            "block bootstrap",
            "profile likelihood",
            "Ma in 1/s^2 with its interval by each method",
            "s.d. ",
            "asymmetry ",
            ">method</text>",
        ] {
            assert!(page.contains(part), "{path}: no {part}");
        }
    }
}

#[tokio::test]
async fn bad_intervals_are_refused_with_their_place() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let mut spec = job(&maneuver);
    spec["options"]["confidence_intervals"] = json!({"bootstrap": 7});
    let answer = server.post_json("/v1/jobs", &spec).await;
    assert_eq!(answer.status, 422, "{}", answer.text());
    let place = "/options/confidence_intervals/bootstrap";
    assert!(answer.text().contains(place), "{}", answer.text());
}

#[test]
fn the_command_prints_all_methods() {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR"));
    let run = |intervals: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trimtab"));
        command.args(["fit", "data/elevator.csv", "-m", "short-period", intervals]);
        let ran = command.current_dir(directory).output().expect("it runs");
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        (ran.status.success(), text(&ran.stdout), text(&ran.stderr))
    };
    let (ran, table, said) = run("--intervals=bootstrap:100,block:5,profile:Ma,monte_carlo:100");
    assert!(ran, "{said}");
    for part in [
        "conventional bound",
        "corrected bound",
        "block bootstrap",
        "profile, corrected",
        "Monte Carlo",
        "bootstrap: 100 replicates, blocks of 5 samples; Monte Carlo: 100 recordings, noise as the corrected bounds have it",
    ] {
        assert!(table.contains(part), "no {part} in {table}");
    }
    // profiled of one parameter alone: itself and corrected
    assert_eq!(table.matches("profile").count(), 2, "{table}");
    let (ran, _, said) = run("--intervals=jackknife");
    assert!(!ran && said.contains("bootstrap[:COUNT]"), "{said}");
}
