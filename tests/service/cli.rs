//! The commands, run as a person would.

use std::path::Path;
use std::process::{Command, Output};

use crate::common::process::Process;
use crate::common::swinging::swinging;
use serde_json::Value;
use trimtab::model::ModelDocument;

fn trimtab(arguments: &[&str]) -> Output {
    command(arguments).output().expect("the program runs")
}

fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_trimtab"));
    let directory = Path::new(env!("CARGO_MANIFEST_DIR"));
    command.args(arguments).current_dir(directory);
    command
}

fn said(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

#[track_caller]
fn succeeds(arguments: &[&str]) -> String {
    let output = trimtab(arguments);
    assert!(output.status.success(), "{}", said(&output.stderr));
    said(&output.stdout)
}

#[track_caller]
fn fails(arguments: &[&str]) -> String {
    let output = trimtab(arguments);
    assert_eq!(output.status.code(), Some(1), "{}", said(&output.stdout));
    said(&output.stderr)
}

/// A table of numbers, without a model: the term that is there is found, by both methods, and the one that is not is left.
#[test]
fn structure_finds_an_equation_from_channels() {
    let mut csv = "t[s],alpha[rad],de[rad],CL[-]\n".to_string();
    for k in 0..200 {
        let t = f64::from(k) * 0.05;
        let (alpha, de) = (0.08 + 0.06 * (0.9 * t).sin(), 0.05 * (1.3 * t).sin());
        let noise = 0.002 * (f64::from(k) * 12.9898).sin();
        csv += &format!("{t},{alpha},{de},{}\n", 0.2 + 4.5 * alpha + noise);
    }
    let file = std::env::temp_dir().join(format!("trimtab-structure-{}.csv", std::process::id()));
    std::fs::write(&file, csv).expect("written");
    let path = file.to_string_lossy();
    let common = [
        "structure",
        &path,
        "--output",
        "CL",
        "--variables",
        "alpha,de",
        "--order",
        "1",
    ];
    let table = succeeds(&common);
    assert!(table.contains("CL = CL_0 + CL_alpha*alpha\n"), "{table}");
    assert!(
        table.contains("PRESS") && table.contains("partial F"),
        "{table}"
    );
    let result: Value = serde_json::from_str(&succeeds(
        &[&common[..], &["--orthogonal", "--json"]].concat(),
    ))
    .expect("JSON");
    assert_eq!(result["structure"]["method"], "orthogonal");
    assert_eq!(result["structure"]["terms"][1]["term"], "alpha");
    let unread = fails(&[&common[..], &["--tolerance", "0.01"]].concat());
    assert!(
        unread.contains("--tolerance is of an estimation's solver, which structure has no use for"),
        "{unread}"
    );
    let refused = fails(&["structure", &path, "--output", "CD", "--variables", "alpha"]);
    assert!(refused.contains("no channel 'CD' is recorded"), "{refused}");
    std::fs::remove_file(&file).expect("removed");
}

/// The band alone asks for output error in the frequency domain.
#[test]
fn fit_works_in_the_frequency_domain() {
    let common = ["fit", "data/elevator.csv", "-m", "short-period", "--json"];
    let with = |more: &[&str]| -> Value {
        serde_json::from_str(&succeeds(&[&common[..], more].concat())).expect("JSON")
    };
    for (more, output) in [
        (&["--band", "0.1-1.5"][..], "alpha"),
        (
            &[
                "--band",
                "0.1-1.5",
                "--estimator",
                "equation_error_frequency",
            ],
            "d_alpha_dt",
        ),
    ] {
        let frequency = with(more)["estimate"]["frequency"].clone();
        assert_eq!(frequency["segments"][0]["frequencies"], 35, "{frequency}");
        assert_eq!(frequency["outputs"][0]["name"], output);
    }
    let refused = fails(&[
        "fit",
        "data/elevator.csv",
        "-m",
        "short-period",
        "--estimator",
        "output_error_frequency",
    ]);
    assert!(refused.contains("band_hz"), "{refused}");
}

#[test]
fn fit_works_without_a_server() {
    let table = succeeds(&["fit", "data/elevator.csv", "--model", "short-period"]);
    assert!(
        table.contains("Mde") && table.contains("alpha_0 [elevator]") && table.contains("R²"),
        "{table}"
    );
    let json = succeeds(&["fit", "data/elevator.csv", "-m", "short-period", "--json"]);
    let result: Value = serde_json::from_str(&json).expect("JSON");
    let rows = result["estimate"]["parameters"].as_array();
    for row in rows.expect("a list") {
        let (Some(value), Some(error)) = (row["estimate"].as_f64(), row["standard_error"].as_f64())
        else {
            continue;
        };
        // to the place of the error's second digit, found by scientific notation
        let text = format!("{error:.1e}");
        let (_, exponent) = text.split_once('e').expect("an exponent");
        let digits = usize::try_from(1 - exponent.parse::<i32>().expect("a number"));
        let digits = digits.expect("an error below 10");
        let name = row["name"].as_str().expect("a name");
        let cells = [
            name.to_string(),
            format!(" {value:.digits$} "),
            format!(" {error:.digits$} "),
        ];
        let has = |line: &str| cells.iter().all(|cell| line.contains(cell.as_str()));
        assert!(table.lines().any(has), "{cells:?}: {table}");
    }
    let file = std::env::temp_dir().join(format!("trimtab-{}.csv", std::process::id()));
    let path = file.to_string_lossy();
    succeeds(&[
        "fit",
        "data/elevator.csv",
        "-m",
        "short-period",
        "--trajectories",
        &path,
    ]);
    let written = std::fs::read_to_string(&file).expect("a table");
    std::fs::remove_file(&file).expect("removed");
    assert!(written.starts_with("segment,t[s],alpha[rad],alpha_standard_error[rad],q[rad/s]"));
    assert_eq!(written.lines().count(), 627);
    let json = succeeds(&[
        "fit",
        "data/elevator.csv",
        "-m",
        "short-period",
        "--fix",
        "q_bias",
        "--json",
    ]);
    let result: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(result["estimate"]["outcome"], "converged");
    let bias = result["estimate"]["parameters"]
        .as_array()
        .expect("a list")
        .iter()
        .find(|p| p["name"] == "q_bias");
    assert_eq!(bias.expect("the parameter")["fixed"], true);
}

#[test]
fn what_cannot_be_done_is_said_with_the_remedy() {
    let words = fails(&["fit", "data/elevator.csv", "--model", "short-periot"]);
    assert!(
        words.contains("no catalog model 'short-periot'; the catalog has short-period"),
        "{words}"
    );
    let words = fails(&[
        "fit",
        "data/elevator.csv",
        "--model",
        "lateral-directional-2",
    ]);
    assert!(
        words.contains("no channel 'da' is recorded for the model's input"),
        "{words}"
    );
    let words = fails(&["fit", "no-such-file.csv", "--model", "short-period"]);
    assert!(words.contains("no-such-file.csv: No such file"), "{words}");
    let words = fails(&[
        "fit",
        "data/elevator.csv",
        "-m",
        "short-period",
        "--start",
        "Ma",
    ]);
    assert!(
        words.contains("--start 'Ma' should read NAME=VALUE"),
        "{words}"
    );
    let words = fails(&[
        "submit",
        "data/elevator.csv",
        "-m",
        "short-period",
        "--server",
        "http://127.0.0.1:1",
    ]);
    assert!(
        words.contains("the server does not answer") && words.contains("trimtab serve"),
        "{words}"
    );
}

/// A mapping holds for a table that has a header of its own, and what is not used does not pass in silence.
#[test]
fn a_table_is_inspected_and_fitted_as_a_mapping_says() {
    let directory = tempfile::TempDir::new().expect("a directory");
    let at = |name: &str| directory.path().join(name).to_string_lossy().into_owned();
    let recorded = std::fs::read_to_string("data/elevator.csv").expect("a recording");
    let (_, rows) = recorded.split_once('\n').expect("a header");
    let header = recorded.lines().next().expect("a header");
    // other titles, no units, a preamble: nothing is said that a model could use
    let titles: Vec<String> = (0..header.split(',').count())
        .map(|k| format!("Channel {k}"))
        .collect();
    let file = at("logger.csv");
    std::fs::write(
        &file,
        format!("Logger: own making\n\n{}\n{rows}", titles.join(",")),
    )
    .expect("written");
    let refused = fails(&["fit", &file, "-m", "short-period"]);
    assert!(
        refused.contains("The draft of a mapping") && refused.contains("Channel 1"),
        "{refused}"
    );

    let inspected = succeeds(&["inspect", &file]);
    assert!(
        inspected.contains("cells separated by") && inspected.contains("from = \"Channel 1\""),
        "{inspected}"
    );

    let channel = |(k, title): (usize, &str)| {
        let (name, unit) = title.trim_end_matches(']').split_once('[').expect("a unit");
        (
            name.to_string(),
            format!("{{from = \"Channel {k}\", unit = \"{unit}\"}}"),
        )
    };
    let columns: Vec<(String, String)> = header.split(',').enumerate().map(channel).collect();
    let (_, time) = &columns[0];
    let others: Vec<String> = columns[1..]
        .iter()
        .map(|(name, from)| format!("{name} = {from}"))
        .collect();
    let mapping = at("mapping.toml");
    std::fs::write(
        &mapping,
        format!("time = {time}\n[channels]\n{}\n", others.join("\n")),
    )
    .expect("written");
    let mapped = succeeds(&[
        "fit",
        &file,
        "-m",
        "short-period",
        "--mapping",
        &mapping,
        "--json",
    ]);
    let plain = succeeds(&["fit", "data/elevator.csv", "-m", "short-period", "--json"]);
    let parameters = |text: &str| {
        let result: Value = serde_json::from_str(text).expect("JSON");
        result["estimate"]["parameters"]
            .as_array()
            .expect("a list")
            .iter()
            .map(|p| p["estimate"].clone())
            .collect::<Vec<_>>()
    };
    assert_eq!(parameters(&mapped), parameters(&plain));

    let json = at("recording.json");
    std::fs::write(&json, "{}").expect("written");
    let unused = fails(&["fit", &json, "-m", "short-period", "--mapping", &mapping]);
    assert!(unused.contains("leave the mapping out"), "{unused}");
}

#[test]
fn health_is_that_of_the_server() {
    let directory = tempfile::tempdir().expect("a directory");
    let server = Process::start(directory.path(), 0);
    let url = server.url.clone();
    assert_eq!(succeeds(&["health", "--server", &url]), "ready\n");
    server.kill();
    let words = fails(&["health", "--server", &url]);
    assert!(words.contains("the server does not answer"), "{words}");
}

#[test]
fn a_server_that_accepts_and_says_nothing_is_not_healthy() {
    let silent = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    let url = format!("http://{}", silent.local_addr().expect("an address"));
    let words = fails(&["health", "--server", &url]);
    assert!(words.contains("timed out"), "{words}");
}

#[test]
fn submit_and_watch_go_to_a_server() {
    let directory = tempfile::tempdir().expect("a directory");
    let server = Process::start(directory.path(), 1);
    let job = [
        "submit",
        "data/aileron.csv",
        "data/rudder.csv",
        "-m",
        "lateral-directional-4",
        "--server",
        &server.url,
    ];
    let id = succeeds(&job);
    let table = succeeds(&["watch", id.trim(), "--server", &server.url]);
    assert!(
        table.contains("Ndr") && table.contains("V_e [rudder]"),
        "{table}"
    );
    let words = fails(&["watch", "nonsense", "--server", &server.url]);
    assert!(
        words.contains("404") && words.contains("there is no job 'nonsense'"),
        "{words}"
    );
    let bad = [
        "submit",
        "data/elevator.csv",
        "-m",
        "short-period",
        "-c",
        "q=qq",
        "--watch",
        "--server",
        &server.url,
    ];
    let words = fails(&bad);
    assert!(
        words.contains("422") && words.contains("/channels/q") && words.contains("no channel 'qq'"),
        "{words}"
    );
}

#[test]
fn a_diagnosis_is_submitted_and_watched_to_its_conclusion() {
    let directory = tempfile::tempdir().expect("a directory");
    let server = Process::start(directory.path(), 1);
    let output = trimtab(&[
        "submit",
        "data/effects/elevator-backlash-fit.csv",
        "--validate",
        "data/effects/elevator-backlash-check.csv",
        "--final",
        "data/effects/elevator-backlash-final.csv",
        "-m",
        "short-period",
        "--diagnose",
        "--watch",
        "--server",
        &server.url,
    ]);
    let (table, steps) = (said(&output.stdout), said(&output.stderr));
    assert!(output.status.success(), "{steps}");
    assert!(
        steps.contains("candidates screened") && steps.contains("accepted backlash of de"),
        "{steps}"
    );
    let (id, table) = table.split_once('\n').expect("the id, then tables");
    let last = table.lines().last().expect("a line");
    assert!(
        last.starts_with("verdict: named") && last.contains("(de_backlash)"),
        "{last}"
    );
    assert!(
        last.contains("data that took no part in any decision: alpha "),
        "{last}"
    );
    assert_eq!(
        succeeds(&["watch", id, "--server", &server.url]).trim(),
        table.trim()
    );
}

#[test]
fn parts_of_a_recording_are_diagnosed_and_drawn() {
    let directory = tempfile::tempdir().expect("a directory");
    let figures = directory.path().join("new").join("figures");
    let flight = "data/effects/elevator-lag-fit.csv";
    let table = succeeds(&[
        "diagnose",
        &format!("{flight}:1-500"),
        "--validate",
        &format!("{flight}:501-626"),
        "-m",
        "short-period",
        "--figures",
        figures.to_str().expect("a path"),
    ]);
    assert!(table.contains("verdict: "), "{table}");
    let mut drawn: Vec<String> = (std::fs::read_dir(&figures).expect("a directory"))
        .map(|entry| entry.expect("a file").file_name().into_string().unwrap())
        .collect();
    drawn.sort();
    assert_eq!(
        drawn,
        [
            "1-elevator-lag-fit_1-500.svg",
            "2-elevator-lag-fit_501-626.svg"
        ]
    );
}

/// What no catalogue has: the equation in which it acts, its size and when it acts, in words and as pictures.
#[test]
fn a_force_that_no_catalogue_has_is_told_and_drawn() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = |name: &str| {
        let path = directory.path().join(name);
        path.to_str().expect("a path").to_string()
    };
    for (name, csv) in ["fit.csv", "check.csv"].iter().zip(swinging()) {
        std::fs::write(path(name), csv).expect("written");
    }
    let told = succeeds(&[
        "diagnose",
        &path("fit.csv"),
        "--validate",
        &path("check.csv"),
        "-m",
        "short-period",
        "--figures",
        &path("figures"),
    ]);
    assert!(told.contains("verdict: unexplained"), "{told}");
    for part in [
        "a force in the equation of q",
        "deg/s^2",
        "depends on nothing",
    ] {
        assert!(told.contains(part), "{part}: {told}");
    }
    let drawn = std::fs::read_to_string(directory.path().join("figures/unmodelled.svg"));
    assert!(drawn.expect("a figure").contains("force in q [deg/s^2]"));
}

#[test]
fn a_server_is_not_put_where_others_can_reach_it() {
    let directory = tempfile::tempdir().expect("a directory");
    let database = directory.path().join("never.db");
    let database = database.to_str().expect("a path");
    let words = fails(&["serve", "--listen", "0.0.0.0:0", "--database", database]);
    assert!(words.contains("refusing to listen on 0.0.0.0:0"), "{words}");
    assert!(!Path::new(database).exists());
}

#[test]
fn with_a_key_it_is_and_who_has_the_key_comes_in() {
    let directory = tempfile::tempdir().expect("a directory");
    let database = directory.path().join("keys.db");
    let database = database.to_str().expect("a path");
    let key =
        |arguments: &[&str]| succeeds(&[&["key"], arguments, &["--database", database]].concat());
    let secret = key(&["new", "--project", "icing", "--name", "pipeline"]);
    let server = Process::serve(database, "0.0.0.0:0", 1);
    let url = server.url.replace("0.0.0.0", "127.0.0.1");
    let watch = |secret: &str| {
        let job = [
            "submit",
            "data/elevator.csv",
            "-m",
            "short-period",
            "--watch",
        ];
        command(&[&job[..], &["--server", &url]].concat())
            .env("TRIMTAB_KEY", secret)
            .output()
            .expect("the program")
    };
    let done = watch(secret.trim());
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    assert!(String::from_utf8_lossy(&done.stdout).contains("Mde"));
    let listed = key(&["list"]);
    assert!(
        listed.contains("pipeline") && listed.contains("icing") && !listed.contains(secret.trim())
    );
    let id = listed
        .lines()
        .find(|line| line.contains("pipeline"))
        .and_then(|line| line.split_whitespace().next());
    let next = key(&["rotate", id.expect("an id"), "--overlap", "0"]);
    key(&["list", "--project", "icing"]);
    let words = watch(secret.trim());
    let words = String::from_utf8_lossy(&words.stderr).to_string();
    assert!(words.contains("the key has expired"), "{words}");
    assert!(watch(next.trim()).status.success());
    let words = fails(&[
        "key",
        "new",
        "--project",
        "two words",
        "--database",
        database,
    ]);
    assert!(words.contains("is not a project name"), "{words}");
}

#[test]
fn the_catalog_can_be_read() {
    assert!(
        succeeds(&["model"])
            .lines()
            .any(|line| line.starts_with("lateral-directional-4 "))
    );
    let document: ModelDocument =
        toml::from_str(&succeeds(&["model", "short-period"])).expect("a document");
    assert_eq!(document.name, "short-period");
}

#[test]
fn derivatives_become_coefficients_and_back() {
    let directory = tempfile::tempdir().expect("a directory");
    let file = |name: &str, text: &str| {
        let path = directory.path().join(name);
        std::fs::write(&path, text).expect("written");
        path.to_str().expect("a path").to_string()
    };
    let aircraft = file(
        "aircraft.toml",
        "m = 17600.0\nS = 64.0\nc = 3.16\nIy = 331000.0\nV = 130.0\nrho = 0.75\n",
    );
    let fit = succeeds(&["fit", "data/elevator.csv", "-m", "short-period", "--json"]);
    let fit_file = file("fit.json", &fit);
    let table = succeeds(&["derivatives", &fit_file, "--aircraft", &aircraft]);
    assert!(
        table.contains("Cmq") && table.contains("std. error"),
        "{table}"
    );
    let json = succeeds(&["derivatives", &fit_file, "-a", &aircraft, "--json"]);
    let coefficients: Value = serde_json::from_str(&json).expect("JSON");
    let lines: Vec<String> = (coefficients.as_array().expect("a list").iter())
        .map(|c| format!("{} = {}", c["name"].as_str().expect("a name"), c["value"]))
        .collect();
    let back_file = file("coefficients.toml", &lines.join("\n"));
    let back = succeeds(&[
        "derivatives",
        &back_file,
        "-a",
        &aircraft,
        "-m",
        "short-period",
        "--json",
    ]);
    let back: Value = serde_json::from_str(&back).expect("JSON");
    let fit: Value = serde_json::from_str(&fit).expect("JSON");
    let mut compared = 0;
    for row in fit["estimate"]["parameters"].as_array().expect("a list") {
        if let Some(found) = back[row["name"].as_str().expect("a name")].as_f64() {
            let expected = row["estimate"].as_f64().expect("a number");
            assert!((found / expected - 1.0).abs() < 1e-9, "{row}");
            compared += 1;
        }
    }
    assert_eq!(compared, 6);
    let useless = file("bad.toml", "m = 17600.0\nS = 64.0\nV = 130.0\nrho = 0.75\n");
    assert!(fails(&["derivatives", &fit_file, "-a", &useless]).contains("needs"));
}

#[test]
fn a_recording_can_be_predicted_instead_of_fitted() {
    let table = succeeds(&[
        "fit",
        "data/aileron.csv",
        "--validate",
        "data/rudder.csv",
        "--model",
        "lateral-directional-4",
    ]);
    let (fitted, predicted) = table.split_once("prediction of rudder:").expect("both");
    assert!(
        fitted.contains("Theil") && predicted.contains("Theil"),
        "{table}"
    );
}

/// The same numbers as tests/numbers/recursive has from elsewhere, as a table and as CSV, and refusals before anything is read.
#[test]
fn track_follows_a_recording_sample_by_sample() {
    let common = [
        "track",
        "data/elevator.csv",
        "-m",
        "short-period",
        "--method",
    ];
    let with = |more: &[&str]| succeeds(&[&common[..], more].concat());
    let table = with(&["rls"]);
    let last = table.lines().rev().nth(1).expect("a line");
    assert!(
        last.contains("25.00") && last.contains("-3.395 ± 0.026"),
        "{table}"
    );
    assert!(table.lines().any(|line| line.contains(" - ")), "{table}");

    let csv = with(&["rft", "--band", "0.1-1.5", "--csv"]);
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0][..3], ["t[s]", "Za[1/s]", "Za_error[1/s]"]);
    assert_eq!(rows.len(), 1 + 626, "a line for each sample");
    let at = rows[0]
        .iter()
        .position(|title| *title == "Ma[1/s^2]")
        .expect("Ma");
    let ma: f64 = rows[626][at].parse().expect("a number");
    assert!((ma + 3.393_759).abs() < 1e-5, "{ma}");
    assert_eq!(
        (rows[1][0], rows[1][at]),
        ("0", ""),
        "nothing is known of one sample"
    );
    assert_eq!(
        with(&["rls", "--csv", "--every", "5"]).lines().count(),
        1 + 4 + 1
    );

    let noise = [
        "ekf",
        "--noise",
        "alpha=0.05deg,q=0.08deg/s",
        "--uncertainty",
        "q_bias=0.005",
    ];
    let output = trimtab(&[&common[..], &noise].concat());
    assert!(said(&output.stdout).contains("q_bias, rad/s"));
    let note = said(&output.stderr);
    assert!(
        note.contains("more than a quarter from where the filter started") && note.contains("Ma"),
        "{note}"
    );

    let refused = |more: &[&str]| fails(&[&common[..], more].concat());
    assert!(refused(&["rft"]).contains("rft needs a band"));
    assert!(
        refused(&["rls", "--filter-error"]).contains("--filter-error is of an estimation's solver")
    );
    assert!(refused(&["rls", "--band", "0.1-1.5"]).contains("use rft"));
    assert!(refused(&["rls", "--forgetting", "2"]).contains("at most 1"));
    assert!(refused(&["ekf"]).contains("standard deviation of the noise of alpha"));
    assert!(refused(&["ekf", "--noise", "alpha=0.05m"]).contains("m where the model has -"));
    assert!(refused(&["ekf", "--noise", "beta=1"]).contains("it has alpha, q"));
    assert!(refused(&["ekf", "--noise", "q=often"]).contains("should be a number"));
}
