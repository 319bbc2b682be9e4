//! Several files as one recording, over HTTP and on the command line.

use std::process::Command;

use crate::common::server::{Answer, Server};
use reqwest::Method;
use serde_json::json;
use trimtab::http::Config;
use trimtab::ingest::{Format, Limits, read};

const IMU: &str = "time,q[rad/s],T[K]\n12:00:00.00,1,300\n12:00:00.02,2,300\n12:00:00.04,3,300\n";
const AIR: &str = "time,alpha[rad],T[K]\n12:00:00.03,7,280\n12:00:00.13,8,281\n";
/// What the two are together, as one would write it by hand.
const BOTH: &str = "t[s],q[rad/s],T[K],alpha[rad],T_air[K]\n0,1,300,,\n0.02,2,300,,\n0.03,,,7,280\n0.04,3,300,,\n0.13,,,8,281\n";

async fn send(server: &Server, parts: &[(&str, &str, &str)]) -> Answer {
    let mut body = String::new();
    for (name, file, content) in parts {
        let file = match file.is_empty() {
            true => String::new(),
            false => format!("; filename=\"{file}\""),
        };
        body += &format!(
            "--x\r\nContent-Disposition: form-data; name=\"{name}\"{file}\r\n\r\n{content}\r\n"
        );
    }
    body += "--x--\r\n";
    server
        .post(
            "/v1/maneuvers?name=both",
            "multipart/form-data; boundary=x",
            body,
        )
        .await
}

/// A client makes a boundary anew each time it sends: with its key the request is the same.
#[tokio::test]
async fn sent_again_with_another_boundary_it_is_the_same_request() {
    let server = Server::start_with(Config::default(), 0).await;
    let sent = async |boundary: &str, content: &str| {
        let body = format!(
            "--{boundary}\r\nContent-Disposition: form-data; name=\"file\"; filename=\"imu.csv\"\r\n\r\n{content}\r\n--{boundary}--\r\n"
        );
        let request = server
            .request(Method::POST, "/v1/maneuvers")
            .header(
                "content-type",
                format!("multipart/form-data; boundary={boundary}"),
            )
            .header("idempotency-key", "several")
            .body(body);
        crate::common::server::send(request).await
    };
    let first = sent("x", IMU).await;
    assert_eq!(first.status, 201, "{}", first.text());
    let again = sent("----y1", IMU).await;
    assert_eq!(again.header("idempotency-replayed"), "true");
    assert_eq!(again.bytes, first.bytes);
    let other = sent("x", AIR).await;
    assert_eq!(other.problem(422, "idempotency_key_reused"), []);
}

fn digest_of_both() -> String {
    read(BOTH.as_bytes(), Format::Csv, &Limits::default())
        .unwrap()
        .digest()
}

#[tokio::test]
async fn several_files_are_one_recording() {
    let server = Server::start_with(Config::default(), 0).await;
    let files = [("file", "imu.csv", IMU), ("file", "air.csv", AIR)];
    let kept = send(&server, &files).await;
    assert_eq!(kept.status, 201, "{}", kept.text());
    assert_eq!(kept.json()["id"], digest_of_both());
    // another clock, a mapping of one file, and an offset
    let other = "x;7\n0.5;7\n0.6;8\n";
    let mapping = json!({"other.dat": {"delimiter": ";", "time": {"from": "x", "unit": "s"}, "channels": {"alpha": {"from": "7", "unit": "rad"}}}});
    let with = |offsets: &str| {
        vec![
            ("file".to_string(), "imu.csv".to_string(), IMU.to_string()),
            ("mappings".to_string(), String::new(), mapping.to_string()),
            (
                "file".to_string(),
                "other.dat".to_string(),
                other.to_string(),
            ),
            ("offsets".to_string(), String::new(), offsets.to_string()),
        ]
    };
    let sent = async |parts: Vec<(String, String, String)>| {
        let parts: Vec<(&str, &str, &str)> = (parts.iter())
            .map(|(name, file, content)| (name.as_str(), file.as_str(), content.as_str()))
            .collect();
        send(&server, &parts).await
    };
    let refused = sent(with("{}")).await.problem(422, "invalid_maneuver");
    assert_eq!(
        refused,
        [("/files/other.dat".to_string(), "other_clock".to_string())]
    );
    let kept = sent(with("{\"other.dat\": -0.5}")).await;
    assert_eq!(kept.status, 201, "{}", kept.text());
    let summary = &kept.json()["summary"];
    assert_eq!(summary["samples"], 4, "{summary}");
    sent(with("{\"air.csv\": 1}"))
        .await
        .problem(400, "invalid_multipart");
    sent(with("[]")).await.problem(422, "wrong_shape");
}

#[tokio::test]
async fn what_cannot_be_one_recording_names_its_file() {
    let server = Server::start_with(Config::default(), 0).await;
    let bad = AIR.replace("12:00:00.13,8", "12:00:00.01,8");
    let files = [("file", "imu.csv", IMU), ("file", "air.csv", bad.as_str())];
    let refused = send(&server, &files).await.problem(422, "invalid_maneuver");
    assert!(
        refused[0].0.starts_with("/files/air.csv/rows/2"),
        "{refused:?}"
    );
    for parts in [
        &[][..],
        &[("offsets", "", "{}")],
        &[("file", "imu.csv", IMU), ("file", "imu.csv", AIR)],
        &[("file", "imu.csv", IMU), ("offset", "", "{}")],
        &[
            ("file", "imu.csv", IMU),
            ("mappings", "", "{\"air.csv\": \"px4\"}"),
        ],
        &[("file", "n".repeat(201).as_str(), IMU)],
        &[
            ("file", "imu.csv", IMU),
            ("offsets", "", "{}"),
            ("offsets", "", "{}"),
        ],
    ] {
        send(&server, parts).await.problem(400, "invalid_multipart");
    }
    let cut_off = server.post(
        "/v1/maneuvers",
        "multipart/form-data; boundary=x",
        "--x\r\nContent-Dis",
    );
    cut_off.await.problem(400, "invalid_multipart");
    server
        .post("/v1/maneuvers", "multipart/form-data", "")
        .await
        .problem(400, "invalid_multipart");
}

/// Files that are small one by one, and too much together; and many of them.
#[tokio::test]
async fn limits_hold_for_all_files_together() {
    let mut config = Config::default();
    config.recording.max_values = 30;
    let server = Server::start_with(config, 0).await;
    // ten rows of two channels
    let rows: String = (0..10).map(|k| format!("{k},1,2\n")).collect();
    let file = |number: usize| {
        (
            format!("{number}.csv"),
            format!("t[s],a{number}[-],b{number}[-]\n{rows}"),
        )
    };
    let sent = async |count: usize| {
        let files: Vec<(String, String)> = (0..count).map(file).collect();
        let parts = files.iter();
        let parts = parts.map(|(name, text)| ("file", name.as_str(), text.as_str()));
        send(&server, &parts.collect::<Vec<_>>()).await
    };
    assert_eq!(sent(1).await.status, 201);
    let refused = sent(2).await.problem(422, "invalid_maneuver");
    assert_eq!(refused[0].1, "too_many_values");
    sent(101).await.problem(400, "invalid_multipart");
}

/// What a part says of its charset, as the header of an upload of one file.
#[tokio::test]
async fn the_charset_of_a_part_holds() {
    let server = Server::start_with(Config::default(), 0).await;
    let sent = async |charset: &str| {
        let body = format!(
            "--x\r\nContent-Disposition: form-data; name=file; filename=a.csv\r\nContent-Type: text/csv; charset={charset}\r\n\r\nt[s],a[rad]\n0,1\n1,2\n\r\n--x--"
        );
        server
            .post("/v1/maneuvers", "multipart/form-data; boundary=x", body)
            .await
    };
    let unknown = sent("klingon").await.problem(422, "invalid_maneuver");
    assert!(unknown[0].0.starts_with("/files/a.csv"), "{unknown:?}");
    assert_eq!(sent("iso-8859-1").await.status, 201);
}

#[tokio::test]
async fn the_charset_of_a_table_holds() {
    let server = Server::start_with(Config::default(), 0).await;
    let table = "t[s],a[rad]\n0,1\n1,2\n";
    let unknown = server
        .post("/v1/maneuvers", "text/csv; charset=klingon", table)
        .await;
    assert_eq!(unknown.status, 422, "{}", unknown.text());
    let known = server
        .post("/v1/maneuvers", "text/csv; charset=iso-8859-1", table)
        .await;
    assert_eq!(known.status, 201, "{}", known.text());
}

#[test]
fn the_command_line_joins_files() {
    let directory = tempfile::tempdir().unwrap();
    let path = |name: &str| directory.path().join(name).to_string_lossy().into_owned();
    std::fs::write(path("imu.csv"), IMU).unwrap();
    std::fs::write(path("air.csv"), AIR).unwrap();
    let run = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trimtab"));
        let done = command
            .args(["join", &path("imu.csv"), &path("air.csv")])
            .args(more)
            .output()
            .unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (done.status.success(), text(done.stdout), text(done.stderr))
    };
    let (is_done, csv, error) = run(&[]);
    assert!(is_done && error.contains("T_air"), "{error}");
    let joined = read(csv.as_bytes(), Format::Csv, &Limits::default()).unwrap();
    assert_eq!(joined.digest(), digest_of_both());
    let (is_done, _, error) = run(&["--offset", &format!("{}=100", path("air.csv"))]);
    assert!(!is_done && error.contains("in common"), "{error}");
    let of_air = format!("{}=0", path("air.csv"));
    for (more, expected) in [
        (
            &["--offset", of_air.as_str(), "--offset", of_air.as_str()][..],
            "twice",
        ),
        (
            &["--output", path("air.csv").as_str()][..],
            "write to another",
        ),
        (&[path("imu.csv").as_str()][..], "is named twice"),
    ] {
        let (is_done, _, error) = run(more);
        assert!(!is_done && error.contains(expected), "{error}");
    }
    assert_eq!(std::fs::read_to_string(path("air.csv")).unwrap(), AIR);
    let (is_done, csv, error) = run(&["--output", &path("both.csv")]);
    assert!(is_done && csv.is_empty(), "{error}");
    let written = std::fs::read(path("both.csv")).unwrap();
    let written = read(&written, Format::Csv, &Limits::default()).unwrap();
    assert_eq!(written.digest(), digest_of_both());
    let (is_done, _, error) = run(&["--offset", "ear.csv=1"]);
    assert!(!is_done && error.contains("ear.csv"), "{error}");
}
