//! Pages of jobs: the list, a job, its report, and what is said of what is not there.

use crate::common::server::Server;
use serde_json::json;

async fn page(server: &Server, path: &str) -> String {
    let answer = server.get(path).await;
    assert_eq!(answer.status, 200, "{}", answer.text());
    answer.text()
}

#[tokio::test]
async fn a_report_has_everything_in_it() {
    let server = Server::start().await;
    let csv = include_str!("../../../data/elevator.csv");
    let maneuver = server.upload(csv).await;
    let hostile = "<img src=x onerror=alert(1)> & co";
    let job = json!({"name": hostile, "tags": ["<b>"], "model": "short-period", "maneuvers": [{"id": maneuver, "label": "<i>up</i>"}]});
    let id = server.submit(&job).await;
    let done = server.wait(&id).await;
    assert_eq!(done["status"], "succeeded");

    let report = page(&server, &format!("/jobs/{id}/report")).await;
    for (part, what) in [
        ("<svg", "figures"),
        ("Mde", "parameters"),
        ("short-period dynamics: pitch rate ±2 deg/s", "tolerances"),
        ("autocorrelation", "residuals"),
        (maneuver.as_str(), "the digest of the recording"),
        ("Prepared by", "signatures"),
        (
            &format!("/v1/jobs/{id}/parameters"),
            "where numbers come from",
        ),
    ] {
        assert!(report.contains(part), "no {what}");
    }
    for part in ["src=\"", "<script", "rel=\"stylesheet\"", "url("] {
        assert!(!report.contains(part), "it loads something: {part}");
    }
    for path in [
        format!("/jobs/{id}"),
        format!("/jobs/{id}/report"),
        "/".into(),
    ] {
        let page = page(&server, &path).await;
        assert!(!page.contains("<img") && page.contains("&lt;img"), "{path}");
        assert!(!page.contains("<b>") && !page.contains("<i>up"), "{path}");
    }
    // a job without a result has a report that says so
    let job = json!({"model": "short-period", "maneuvers": [{"id": maneuver}], "options": {"start": {"kind": "document"}},
        "parameters": {"Za": {"start": 1e9}}});
    let id = server.submit(&job).await;
    server.wait(&id).await;
    page(&server, &format!("/jobs/{id}/report")).await;
}

/// A value and its standard error to the place of the error's second digit: by scientific notation, apart from the program.
fn rounded(value: f64, error: f64) -> [String; 2] {
    let text = format!("{error:.1e}");
    let (_, exponent) = text.split_once('e').unwrap();
    let digits = usize::try_from(1 - exponent.parse::<i32>().unwrap()).unwrap();
    [format!("{value:.digits$}"), format!("{error:.digits$}")]
}

#[tokio::test]
async fn estimates_have_the_digits_that_their_errors_leave() {
    let server = Server::start().await;
    let maneuver = server
        .upload(include_str!("../../../data/elevator.csv"))
        .await;
    let job = json!({"model": "short-period", "maneuvers": [{"id": maneuver}]});
    let id = server.submit(&job).await;
    server.wait(&id).await;
    let table = server.get(&format!("/v1/jobs/{id}/parameters")).await;
    let table = table.json();
    let rows = table["parameters"].as_array().unwrap();
    let bounded: Vec<_> = (rows.iter())
        .filter(|row| row["standard_error"].is_number())
        .collect();
    assert!(bounded.len() > 4);
    for path in [format!("/jobs/{id}"), format!("/jobs/{id}/report")] {
        let page = page(&server, &path).await;
        for row in &bounded {
            let unit = row["unit"].as_str().unwrap();
            let scale = if unit.starts_with("rad") {
                180.0 / std::f64::consts::PI
            } else {
                1.0
            };
            let of = |field: &str| scale * row[field].as_f64().unwrap();
            let [value, error] = rounded(of("estimate"), of("standard_error"));
            let cells =
                format!("<td class=\"number\">{value}</td><td class=\"number\">{error}</td>");
            assert!(page.contains(&cells), "{row}: {cells}");
        }
    }
    let report = page(&server, &format!("/jobs/{id}/report")).await;
    let (_, said) = report.split_once("Ljung and Box, p ").expect("a p-value");
    let said = &said[..said.find(')').unwrap()];
    assert!(
        said == "&lt; 0.0001" || said.starts_with("= 0.") || said == "= 1.00",
        "{said}"
    );
}

#[tokio::test]
async fn a_report_says_in_what_a_renamed_channel_was_recorded() {
    let server = Server::start().await;
    let csv = include_str!("../../../data/elevator.csv").replacen("de[", "stick[", 1);
    assert!(csv.lines().next().unwrap().contains("stick[deg]"), "{csv}");
    let maneuver = server.upload(&csv).await;
    let mut job = json!({"model": "short-period", "maneuvers": [{"id": maneuver}], "channels": {"de": "stick"}});
    for (formula, recorded) in [("stick", "deg"), ("2*stick", "")] {
        job["channels"]["de"] = json!(formula);
        let id = server.submit(&job).await;
        assert_eq!(server.wait(&id).await["status"], "succeeded");
        let report = page(&server, &format!("/jobs/{id}/report")).await;
        let row = format!("<code>{formula}</code></td><td class=\"soft\">{recorded}</td>");
        assert!(report.contains(&row), "{row}");
    }
}

#[tokio::test]
async fn the_list_shows_what_is_asked_for() {
    let server = Server::start_with(trimtab::http::Config::default(), 0).await;
    let first = page(&server, "/").await;
    assert!(first.contains("Nothing has been estimated here yet"));
    let maneuver = server
        .upload(include_str!("../../../data/elevator.csv"))
        .await;
    let mut ids = Vec::new();
    for (kind, tag) in [("estimate", "one"), ("diagnose", "two")] {
        let job = json!({"kind": kind, "tags": [tag], "model": "short-period", "maneuvers": [{"id": maneuver}]});
        ids.push(server.submit(&job).await);
    }
    for (query, shown) in [
        ("", [true, true]),
        ("?status=&kind=&tag=", [true, true]),
        ("?kind=diagnose", [false, true]),
        ("?tag=one", [true, false]),
        ("?status=queued&kind=estimate&tag=one", [true, false]),
        ("?q=ONE+short", [true, false]),
        ("?q=elevator&tag=two", [false, false]),
        ("?status=failed", [false, false]),
    ] {
        let list = page(&server, &format!("/{query}")).await;
        let has = |id: &String| list.contains(&format!("/jobs/{id}"));
        assert_eq!([has(&ids[0]), has(&ids[1])], shown, "{query}");
    }
    let list = page(&server, "/?q=%22%3E%3Cb%3E").await;
    assert!(list.contains("No job matches") && list.contains("value=\"&quot;&gt;&lt;b&gt;\""));
    let list = page(&server, "/").await;
    let title = format!(">short-period: {}</a>", &maneuver[..12]);
    assert_eq!(list.matches(&title).count(), 2, "{list}");
    assert!(!list.contains(&format!(">{}<", ids[0])), "{list}");
    let answer = server.get("/?status=done").await;
    assert_eq!(answer.problem(400, "invalid_query").len(), 0);
}

#[tokio::test]
async fn people_are_told_on_a_page_what_is_not_there() {
    let server = Server::start_with(trimtab::http::Config::default(), 0).await;
    let missing = "/jobs/01950000-0000-7000-8000-000000000000";
    let browsers = "text/html,application/xhtml+xml,*/*;q=0.8";
    for path in [missing, "/nowhere", "/models/none", "/maneuvers/none"] {
        let answer = server.get_as(path, browsers).await;
        assert_eq!(answer.status, 404, "{path}");
        assert!(answer.header("content-type").starts_with("text/html"));
        let text = answer.text();
        assert!(
            text.contains("To the jobs") && text.contains("class=\"note\""),
            "{text}"
        );
    }
    // the API answers programs, whoever asks
    for (path, accept) in [(missing, "*/*"), ("/v1/nowhere", browsers)] {
        let answer = server.get_as(path, accept).await;
        assert_eq!(answer.header("content-type"), "application/problem+json");
    }
}
