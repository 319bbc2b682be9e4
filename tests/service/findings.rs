//! What is odd is said everywhere it is read: the recording, the job, lists, the estimate, the table, pages.

use crate::common::jobs::job;
use crate::common::recordings::elevator;
use crate::common::server::Server;
use serde_json::{Value, json};

/// The elevator maneuver, its angle of attack new in every fifth row only.
fn held() -> String {
    let text = elevator();
    let mut lines = text.lines();
    let header = lines.next().expect("a header");
    let place = header
        .split(',')
        .position(|name| name.starts_with("alpha["));
    let place = place.expect("the channel");
    let mut kept = String::new();
    let mut written = format!("{header}\n");
    for (row, line) in lines.enumerate() {
        let mut cells: Vec<&str> = line.split(',').collect();
        if row % 5 == 0 {
            kept = cells[place].to_string();
        }
        cells[place] = &kept;
        written += &format!("{}\n", cells.join(","));
    }
    written
}

#[tokio::test]
async fn a_finding_is_read_wherever_the_numbers_are() {
    let server = Server::start().await;
    let maneuver = server.upload(&held()).await;
    let summary = server
        .get(&format!("/v1/maneuvers/{maneuver}"))
        .await
        .json();
    let found = &summary["summary"]["findings"][0];
    assert_eq!(
        (&found["code"], &found["channel"]),
        (&json!("held_channel"), &json!("alpha"))
    );
    assert!(
        found["rows"][0].is_u64() && found["time"][0].is_f64(),
        "{found}"
    );

    let id = server.submit(&job(&maneuver)).await;
    let over = server.wait(&id).await;
    assert!(
        over["warnings"]["codes"]
            .as_array()
            .expect("codes")
            .contains(&json!("held_channel")),
        "{over}"
    );
    assert!(over["warnings"]["warnings"].as_u64() >= Some(1));
    let listed = server.get("/v1/jobs").await.json();
    assert_eq!(listed["jobs"][0]["warnings"], over["warnings"]);
    let events = server
        .get(&format!("/v1/jobs/{id}/events?format=json"))
        .await
        .json();
    let last = events["events"]
        .as_array()
        .expect("events")
        .last()
        .expect("one")
        .clone();
    assert_eq!(last["findings"], over["warnings"]);

    let of = |answer: &Value| answer["findings"][0]["code"].clone();
    let estimate = server.get(&format!("/v1/jobs/{id}/estimate")).await.json();
    assert_eq!(of(&estimate), "held_channel");
    let table = server
        .get(&format!("/v1/jobs/{id}/parameters"))
        .await
        .json();
    assert_eq!(of(&table), "held_channel");
    let csv = server
        .get(&format!("/v1/jobs/{id}/parameters?format=csv"))
        .await
        .text();
    assert!(csv.starts_with("name,segment,unit"), "{csv}");
    let csv = server
        .get(&format!(
            "/v1/jobs/{id}/parameters?format=csv&comments=true"
        ))
        .await
        .text();
    assert!(
        csv.starts_with("# warning held_channel: 1, alpha: it is new in every 5th row only"),
        "{csv}"
    );
    assert!(csv.contains("\nname,segment,unit"), "{csv}");
    for page in ["", "/report"] {
        let page = server.get(&format!("/jobs/{id}{page}")).await.text();
        assert!(page.contains("it is new in every 5th row only"), "{page}");
    }

    let mut strict = job(&maneuver);
    strict["strict"] = json!(["held_channel"]);
    let faults = server
        .post_json("/v1/jobs", &strict)
        .await
        .problem(422, "invalid_job");
    assert_eq!(faults.len(), 1);
    strict["strict"] = json!(["held_chanel"]);
    let faults = server
        .post_json("/v1/jobs", &strict)
        .await
        .problem(422, "invalid_job");
    assert_eq!(faults[0].0, "/strict/0");
}

/// A finding of the fit ends a strict job; iterations come as CSV where that is asked for.
#[tokio::test]
async fn a_strict_job_fails_with_what_its_fit_has_found() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let mut spec = job(&maneuver);
    spec["options"] = json!({"max_iterations": 1});
    spec["strict"] = json!(true);
    let id = server.submit(&spec).await;
    let over = server.wait(&id).await;
    assert_eq!(over["status"], "failed", "{over}");
    assert_eq!(over["faults"][0]["code"], "not_converged");
    let csv = server
        .get(&format!("/v1/jobs/{id}/iterations?format=csv"))
        .await;
    assert!(
        csv.headers["content-type"]
            .to_str()
            .expect("text")
            .starts_with("text/csv")
    );
    let csv = csv.text();
    let rows: Vec<&str> = csv.lines().collect();
    assert!(
        rows[0].starts_with(
            "number,cost,det_r,gradient_norm,step,damping,halvings,variance alpha,variance q,Za,"
        ),
        "{csv}"
    );
    assert!(rows.len() >= 3 && rows[1].starts_with("0,"), "{csv}");
    let json = server
        .get(&format!("/v1/jobs/{id}/iterations"))
        .await
        .json();
    assert_eq!(
        json["iterations"].as_array().expect("a list").len(),
        rows.len() - 1
    );
    let table = server.get("/v1/problems").await.json();
    assert!(table["findings"].as_array().expect("a list").len() > 20);
}
