//! Linear system, frequency response and flying qualities of a finished job, as a client sees them.

use crate::common::server::Server;
use serde_json::Value;

fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is a number"))
}

#[tokio::test]
async fn a_finished_job_has_a_linear_system_responses_and_flying_qualities() {
    let server = Server::start().await;
    let maneuver = server.upload(&crate::common::recordings::elevator()).await;
    let id = server.submit(&crate::common::jobs::job(&maneuver)).await;
    assert_eq!(server.wait(&id).await["outcome"], "converged");
    let base = format!("/v1/jobs/{id}");
    let estimate = server.get(&format!("{base}/estimate")).await.json();
    let parameters = estimate["parameters"].as_array().expect("a list");
    let value = |name: &str| {
        let row = parameters.iter().find(|row| row["name"] == name);
        number(&row.expect("a row")["estimate"])
    };
    let system = server.get(&format!("{base}/linear-system")).await.json();
    assert_eq!(number(&system["a"]["values"][1][0]), value("Ma"));
    assert_eq!(number(&system["b"]["values"][1][0]), value("Mde"));
    assert_eq!(system["modes"][0]["name"], "short_period");

    // the same in hertz and in radians per second, as CSV and as JSON
    let response = server
        .get(&format!(
            "{base}/frequency-response?output=q&from=2&to=2&points=1"
        ))
        .await
        .json();
    let response = &response["responses"][0];
    assert_eq!(response["unit"], "(rad/s)/rad");
    let hertz = 2.0 / std::f64::consts::TAU;
    let path = format!(
        "{base}/frequency-response?output=q&from={hertz}&to={hertz}&points=1&unit=Hz&format=csv"
    );
    let csv = server.get(&path).await.text();
    let mut lines = csv.lines();
    assert!(
        lines
            .next()
            .expect("a header")
            .starts_with("input,output,frequency[Hz],magnitude[dB]")
    );
    let cells: Vec<&str> = lines.next().expect("a row").split(',').collect();
    assert_eq!(cells[..2], ["de", "q"]);
    let magnitude: f64 = cells[3].parse().expect("a number");
    assert!(
        (magnitude - number(&response["magnitude_db"][0])).abs() < 1e-9,
        "{csv}"
    );
    assert!(number(&response["phase_deg_standard_error"][0]) > 0.0);

    let path = format!("{base}/flying-qualities?category=B&class=II&airspeed=130");
    let qualities = server.get(&path).await.json();
    assert_eq!(qualities["equivalent_systems"][0]["form"], "pitch_rate");
    let omega = number(&qualities["equivalent_systems"][0]["natural_frequency"]["value"]);
    assert!((omega - 2.16).abs() < 0.05, "{omega}");
    assert!(number(&qualities["control_anticipation_parameter"]["value"]) > 0.0);
    assert_eq!(qualities["levels"][0]["what"], "short period: damping");

    let page = server
        .get(&format!(
            "/jobs/{id}/dynamics?category=B&class=II&airspeed=130"
        ))
        .await
        .text();
    for part in [
        "short period (",
        "q over de",
        "<polygon",
        "MIL-F-8785C, 3.2.2.1.2, table IV",
        "bandwidth, rad/s",
    ] {
        assert!(page.contains(part), "no {part} in {page}");
    }

    for (path, detail) in [
        ("linear-system?segment=flight", "there is no 'flight'"),
        ("frequency-response?output=beta", "there is alpha, q"),
        ("frequency-response?from=0", "above 0"),
        ("frequency-response?points=0", "between 1 and"),
        ("flying-qualities?airspeed=-1", "in m/s"),
        ("flying-qualities?from=5&to=2", "the lower one first"),
        ("flying-qualities?category=D", "category"),
    ] {
        let refused = server.get(&format!("{base}/{path}")).await;
        assert_eq!(refused.status, 400, "{path}: {}", refused.text());
        let problem = refused.json();
        assert_eq!(problem["code"], "invalid_query");
        let found = problem["detail"].as_str().expect("a sentence");
        assert!(found.contains(detail), "{path}: {found}");
    }
}
