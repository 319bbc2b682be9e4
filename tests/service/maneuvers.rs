//! Recordings over HTTP: good ones, the same again, and every bad one.

use crate::common::recordings::elevator;
use crate::common::server::{Answer, Server, send};
use futures_util::stream;
use reqwest::{Body, Method, Url};
use serde_json::json;
use trimtab::http::Config;

const SMALL: &str = "t[s],alpha[deg],q[deg/s]\n0,1.5,2\n0.1,,3\n0.2,2.5,4\n";

/// [`SMALL`] and 5000 ones, packed with gzip.
const PACKED: &[u8] =
    b"\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\x03\x2b\x89\x2e\x8e\xd5\x49\xcc\x29\xc8\x48\x8c\x4e\x49\x4d\x8f\xd5\x29\x04\x51\xfa\xc5\xb1\x5c\x06\x3a\x86\x7a\xa6\x3a\x46\x5c\x06\x7a\x86\x3a\x3a\xc6\x40\xca\x48\xc7\x08\x28\x60\xc2\x05\x00\x95\x3d\x46\xe8\x32\x00\x00\x00";
const BOMB: &[u8] =
    b"\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\x03\xed\xc1\x31\x01\x00\x00\x00\xc2\xa0\x4c\xeb\x5f\xce\x14\x7e\x40\x01\x00\x00\x00\x00\x6f\x03\x82\x0d\xdf\xdc\x88\x13\x00\x00";

async fn csv(server: &Server, body: impl Into<Body>) -> Answer {
    server.post("/v1/maneuvers", "text/csv", body).await
}

#[tokio::test]
async fn the_same_content_is_the_same_maneuver() {
    let server = Server::start_with(Config::default(), 0).await;
    let first = server
        .post("/v1/maneuvers?name=first%20flight", "text/csv", SMALL)
        .await;
    assert_eq!(first.status, 201, "{}", first.text());
    let maneuver = first.json();
    assert_eq!(maneuver["name"], "first flight");
    assert_eq!(maneuver["summary"]["samples"], 3);
    assert_eq!(maneuver["summary"]["channels"][0]["unit"], "deg");
    let id = maneuver["id"].as_str().unwrap();
    assert_eq!(id.len(), 64);
    assert_eq!(first.header("location"), format!("/v1/maneuvers/{id}"));

    let again = server
        .post("/v1/maneuvers?name=other", "text/csv; charset=utf-8", SMALL)
        .await;
    assert_eq!(again.status, 200);
    assert_eq!(again.json(), maneuver, "it keeps its first name");

    let as_json = json!({
        "time": {"unit": "s", "values": [0, 0.1, 0.2]},
        "channels": {
            "alpha": {"unit": "deg", "values": [1.5, null, 2.5]},
            "q": {"unit": "deg/s", "values": [2, 3, 4]},
        },
    });
    let same = server.post_json("/v1/maneuvers", &as_json).await;
    assert_eq!(same.status, 200, "however it is written: {}", same.text());
    assert_eq!(same.json()["id"], id);
    assert_eq!(
        server.get(&format!("/v1/maneuvers/{id}")).await.json(),
        maneuver
    );
    let unknown = server.get("/v1/maneuvers/abc").await;
    assert_eq!(unknown.problem(404, "unknown_maneuver"), []);
}

/// It was dropped on the way, and the encoding found out by what the bytes look like.
#[tokio::test]
async fn the_charset_of_an_upload_holds() {
    let server = Server::start().await;
    let refused = server
        .post("/v1/maneuvers", "text/csv; charset=klingon", SMALL)
        .await;
    let faults = refused.problem(422, "invalid_maneuver");
    assert!(faults[0].1.contains("not_utf8"), "{faults:?}");
    let titled = |title: &str| format!("time [s],{title} [deg]\n0,1\n0.1,2\n0.2,3\n0.3,5\n");
    let utf16: Vec<u8> = (titled("alpha").encode_utf16())
        .flat_map(u16::to_be_bytes)
        .collect();
    let read = server
        .post("/v1/maneuvers", "Text/CSV; Charset=\"UTF-16BE\"", utf16)
        .await;
    assert!(read.status.is_success(), "{}", read.text());
    assert!(read.text().contains("alpha"), "{}", read.text());
}

#[tokio::test]
async fn a_file_is_what_its_first_bytes_tell() {
    let config = Config {
        max_maneuver_body: 2000,
        ..Config::default()
    };
    let server = Server::start_with(config, 0).await;
    let id = server.upload(SMALL).await;
    for media_type in ["text/csv", "application/gzip", "application/octet-stream"] {
        let packed = server.post("/v1/maneuvers", media_type, PACKED).await;
        assert_eq!(packed.status, 200, "{media_type}: {}", packed.text());
        assert_eq!(packed.json()["id"], id, "{media_type}");
    }
    for (body, code) in [
        (BOMB, "unpacked_too_large"),
        (&b"PAR1\0\0\0\0PAR1"[..], "damaged_file"),
        (&b"TDSm\x0e\0\0\0"[..], "damaged_file"),
        (&b"ULog\x01\x12\x35\x01\0\0\0\0\0\0\0\0"[..], "damaged_file"),
    ] {
        let refused = server.post("/v1/maneuvers", "text/csv", body).await;
        let errors = refused.problem(422, "invalid_maneuver");
        assert_eq!(errors, [(String::new(), code.to_string())]);
    }
}

#[tokio::test]
async fn samples_come_back_as_they_were_recorded() {
    let server = Server::start_with(Config::default(), 0).await;
    let id = server.upload(SMALL).await;
    let path = format!("/v1/maneuvers/{id}/data");
    let data = server.get(&path).await.json();
    assert_eq!(data["time"]["values"], json!([0.0, 0.1, 0.2]));
    let alpha = &data["channels"]["alpha"];
    assert_eq!(alpha["unit"], "rad");
    assert_eq!(alpha["values"][0].as_f64().unwrap(), 1.5f64.to_radians());
    assert!(alpha["values"][1].is_null());

    let csv = server
        .get_as(&format!("{path}?channels=q"), "text/csv")
        .await
        .text();
    assert_eq!(csv.lines().next().unwrap(), "t[s],q[rad/s]");
    assert_eq!(csv.lines().count(), 4);
    let faults = server
        .get(&format!("{path}?channels=q,p,r"))
        .await
        .problem(400, "invalid_query");
    assert_eq!(faults.len(), 2);

    let long = server.upload(&elevator()).await;
    let thinned = server
        .get(&format!(
            "/v1/maneuvers/{long}/data?max_points=50&channels=q"
        ))
        .await;
    assert_eq!(thinned.header("x-trimtab-samples"), "626");
    let count = thinned.json()["time"]["values"].as_array().unwrap().len();
    assert!((20..=50).contains(&count), "{count}");
    // what is no stretch of time, and what is no length of one
    for (query, named) in [
        ("data?from=20&to=5", "from: 20 s is after to: 5 s"),
        ("data?from=NaN", "from: NaN"),
        ("data?to=inf", "to: inf"),
        ("segments?quiet=NaN", "quiet: NaN"),
    ] {
        let refused = server.get(&format!("/v1/maneuvers/{long}/{query}")).await;
        refused.problem(400, "invalid_query");
        assert!(refused.text().contains(named), "{}", refused.text());
    }
}

#[tokio::test]
async fn lists_page_newest_first() {
    let server = Server::start_with(Config::default(), 0).await;
    let mut ids = Vec::new();
    for number in 0..5 {
        ids.insert(
            0,
            server.upload(&format!("t[s],q\n0,{number}\n1,2\n")).await,
        );
    }
    let (mut seen, mut query) = (Vec::new(), String::new());
    loop {
        let page = server
            .get(&format!("/v1/maneuvers?limit=2{query}"))
            .await
            .json();
        let entries = page["maneuvers"].as_array().unwrap();
        seen.extend(
            entries
                .iter()
                .map(|entry| entry["id"].as_str().unwrap().to_string()),
        );
        match page["next_cursor"].as_str() {
            Some(cursor) => query = format!("&cursor={cursor}"),
            None => break,
        }
    }
    // several may have been stored within a millisecond: then their ids decide
    let sorted = |mut ids: Vec<String>| {
        ids.sort();
        ids
    };
    assert_eq!(sorted(seen), sorted(ids));
    assert_eq!(
        server
            .get("/v1/maneuvers?cursor=x")
            .await
            .problem(400, "invalid_cursor"),
        []
    );
}

#[tokio::test]
async fn bad_recordings_are_refused_with_their_places() {
    let server = Server::start_with(Config::default(), 0).await;
    let cases: [(&[u8], &str, &str); 9] = [
        (b"", "", "empty_body"),
        (b"t[s],q\n0,1\n", "", "too_few_samples"),
        (
            b"t[s],alpha[furlong]\n0,1\n1,2\n",
            "/columns/alpha",
            "unknown_unit",
        ),
        (
            b"t[s],q\n0,1\n1,2\n0.5,3\n",
            "/rows/3",
            "time_not_increasing",
        ),
        (b"t[s],q\n0,1\n,2\n", "/rows/2", "time_missing"),
        (b"t[s],q\n0,1\n1,two\n", "/rows/2/q", "not_a_number"),
        (b"t[s],q\n0,1\n1\n", "/rows/2", "row_length"),
        (b"alpha,q\n0,1\n1,2\n", "", "no_time_column"),
        (b"t[s],q\n0,1\n1,\xe2\x82", "", "not_utf8"),
    ];
    for (body, pointer, code) in cases {
        let faults = csv(&server, body.to_vec())
            .await
            .problem(422, "invalid_maneuver");
        let said = faults
            .iter()
            .any(|(at, what)| at.starts_with(pointer) && what == code);
        assert!(said, "{:?}: {faults:?}", String::from_utf8_lossy(body));
    }
    let wrong =
        json!({"time": {"unit": "s", "values": [0, 1]}, "channels": {"q": {"values": [1, "two"]}}});
    let faults = server
        .post_json("/v1/maneuvers", &wrong)
        .await
        .problem(422, "invalid_maneuver");
    assert_eq!(faults[0].0, "/channels/q/values/1", "{faults:?}");
    let answer = server.post("/v1/maneuvers", "image/png", "x").await;
    assert_eq!(answer.problem(415, "unsupported_media_type"), []);
    let answer = send(server.request(Method::POST, "/v1/maneuvers").body("x")).await;
    assert_eq!(answer.problem(415, "unsupported_media_type"), []);
    let name = "x".repeat(201);
    let answer = server
        .post(&format!("/v1/maneuvers?name={name}"), "text/csv", SMALL)
        .await;
    assert_eq!(answer.problem(400, "invalid_query"), []);
    assert_eq!(
        server.get("/v1/maneuvers").await.json()["maneuvers"],
        json!([]),
        "nothing was kept"
    );
}

#[tokio::test]
async fn files_without_names_are_read_with_a_mapping() {
    let server = Server::start_with(Config::default(), 0).await;
    let upload = async |mapping: Option<&str>, media_type: &str, body: &[u8]| {
        let mut url = format!("{}/v1/maneuvers", server.url)
            .parse::<Url>()
            .unwrap();
        if let Some(mapping) = mapping {
            url.query_pairs_mut().append_pair("mapping", mapping);
        }
        let path = url.as_str().strip_prefix(&server.url).unwrap().to_string();
        server.post(&path, media_type, body.to_vec()).await
    };
    let mat = include_bytes!("../ingest/recordings/compressed.mat");
    let mapping = r#"{"time": {"from": "data(:,1)", "unit": "s"}, "channels": {"alpha": {"from": "rec.alpha", "unit": "deg"}}}"#;
    let first = upload(Some(mapping), "application/x-matlab-data", mat).await;
    assert_eq!(first.status, 201, "{}", first.text());
    assert_eq!(first.json()["summary"]["samples"], 5);

    let text = b"0 1.5 10\n0.04 2 -20\n0.08 nan 30\n0.12 2.5 -40\n0.16 -1 50\n";
    let mapping = mapping.replace("rec.alpha", "data(:,2)");
    let same = upload(Some(&mapping), "text/plain", text).await;
    assert_eq!(same.status, 200, "however it is written: {}", same.text());

    let unmapped = upload(None, "application/x-matlab-data", mat).await;
    let faults = unmapped.problem(422, "invalid_maneuver");
    assert_eq!(faults, [(String::new(), "mapping_needed".to_string())]);
    let missing = upload(Some("sidpac"), "application/x-matlab-data", mat).await;
    let faults = missing.problem(422, "invalid_maneuver");
    assert_eq!(
        faults[0],
        ("/time/from".to_string(), "unknown_source".to_string())
    );
    let unknown = upload(Some("sidpack"), "text/plain", text).await;
    let faults = unknown.problem(400, "invalid_query");
    assert_eq!(faults, [(String::new(), "invalid_mapping".to_string())]);
}

#[tokio::test]
async fn a_million_columns_are_refused_by_the_limit() {
    let server = Server::start_with(Config::default(), 0).await;
    let header: Vec<String> = (0..1_000_000).map(|number| format!("c{number}")).collect();
    let row = vec!["1"; 1_000_000].join(",");
    let body = format!("t[s],{}\n0,{row}\n1,{row}\n", header.join(","));
    let faults = csv(&server, body).await.problem(422, "invalid_maneuver");
    assert_eq!(faults, [(String::new(), "too_many_columns".to_string())]);
}

fn megabytes(count: usize) -> impl Iterator<Item = Result<Vec<u8>, std::io::Error>> {
    (0..count).map(|_| Ok(vec![b'1'; 1_000_000]))
}

#[tokio::test]
async fn two_hundred_megabytes_are_refused_by_the_limit() {
    let server = Server::start_with(Config::default(), 0).await;
    // without a length in advance, and with one
    let streamed = csv(&server, Body::wrap_stream(stream::iter(megabytes(200)))).await;
    let announced = csv(&server, vec![b'1'; 200_000_000]).await;
    for answer in [streamed, announced] {
        assert_eq!(answer.problem(413, "body_too_large"), []);
        let detail = answer.json()["detail"].as_str().unwrap().to_string();
        assert!(
            detail.contains("100000000") && detail.contains("--max-maneuver-body"),
            "{detail}"
        );
    }
    assert_eq!(
        csv(&server, SMALL).await.status,
        201,
        "and the server goes on"
    );
}

#[tokio::test]
async fn a_body_that_breaks_off_keeps_nothing() {
    let server = Server::start_with(Config::default(), 0).await;
    let broken = megabytes(3).chain([Err(std::io::Error::other("cut"))]);
    let request = server
        .request(Method::POST, "/v1/maneuvers")
        .header("content-type", "text/csv");
    let sent = request
        .body(Body::wrap_stream(stream::iter(broken)))
        .send()
        .await;
    assert!(sent.is_err() || sent.unwrap().status().is_client_error());
    assert_eq!(
        server.get("/v1/maneuvers").await.json()["maneuvers"],
        json!([])
    );
}

/// Of the elevator maneuver: a short-period response where the motion is, and faults by their place.
#[tokio::test]
async fn a_recording_has_frequency_responses() {
    let server = Server::start().await;
    let id = server.upload(&elevator()).await;
    let path = format!("/v1/maneuvers/{id}/frequency-responses");
    let asked = json!({"inputs": ["de"], "outputs": ["q", "alpha"], "band_hz": [0.25, 1.0], "points": 10, "windows": [8.0]});
    let answer = server.post_json(&path, &asked).await;
    assert_eq!(answer.status, 200, "{}", answer.text());
    let found = answer.json();
    assert_eq!(found["frequency_hz"].as_array().unwrap().len(), 10);
    assert_eq!(found["responses"][1]["output"], "alpha");
    assert!(
        found["responses"][0]["coherence"][3].as_f64().unwrap() > 0.9,
        "{found}"
    );
    let mut long = asked.clone();
    long["windows"] = json!([20.0]);
    let long = server.post_json(&path, &long).await;
    assert_eq!(long.json()["errors"][0]["code"], "too_few_windows");
    let refused = server
        .post_json(
            &path,
            &json!({"inputs": ["dr"], "outputs": ["q"], "band_hz": [0.1, 1.0]}),
        )
        .await;
    assert_eq!(refused.status, 422);
    assert_eq!(refused.json()["errors"][0]["pointer"], "/inputs");
    let nowhere = server
        .post_json("/v1/maneuvers/none/frequency-responses", &asked)
        .await;
    assert_eq!(nowhere.status, 404);
}
