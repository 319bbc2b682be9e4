//! Jobs side by side, and parameters over the mean of a channel.

use crate::common::jobs::job;
use crate::common::recordings::elevator_of;
use crate::common::server::Server;
use serde_json::{Value, json};
use std::process::Command;

/// What the program prints on success: results, and all else.
fn run(arguments: &[&str]) -> (String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_trimtab"));
    let done = command.args(arguments).output().expect("the program runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("text");
    let said = text(done.stderr);
    assert!(done.status.success(), "{said}");
    (text(done.stdout), said)
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// Finished jobs on two recordings, and a third on the first once more.
async fn three(server: &Server) -> [String; 3] {
    let first = server.upload(&elevator_of(16.0, 1)).await;
    let second = server.upload(&elevator_of(16.0, 2)).await;
    let mut ids = Vec::new();
    for maneuver in [&first, &second, &first] {
        let id = server.submit(&job(maneuver)).await;
        assert_eq!(server.wait(&id).await["status"], "succeeded");
        ids.push(id);
    }
    ids.try_into().expect("three")
}

#[tokio::test(flavor = "multi_thread")]
async fn differences_are_in_standard_errors_of_independent_estimates() {
    let server = Server::start().await;
    let ids = three(&server).await;
    let path = format!("/v1/compare?jobs={}", ids.join(","));
    let found = server.get(&path).await.json();
    let mut rows = Vec::new();
    for id in &ids {
        let table = server.get(&format!("/v1/jobs/{id}/parameters")).await;
        rows.push(table.json()["parameters"].as_array().unwrap().clone());
    }
    let mut held = 0;
    for parameter in found["parameters"].as_array().unwrap() {
        // as the jobs' own tables have it
        let of = |rows: &Vec<Value>| {
            let named =
                |row: &&Value| row["name"] == parameter["parameter"] && row["segment"].is_null();
            rows.iter().find(named).unwrap().clone()
        };
        let [one, two] = [of(&rows[0]), of(&rows[1])];
        let values = &parameter["values"];
        assert_eq!(values[0]["estimate"], one["estimate"]);
        assert!(values[0].get("deviation").is_none(), "{parameter}");
        if one["standard_error"].is_null() {
            continue;
        }
        let difference = number(&two["estimate"]) - number(&one["estimate"]);
        let errors =
            number(&one["standard_error"]).powi(2) + number(&two["standard_error"]).powi(2);
        let apart = number(&values[1]["deviation"]);
        assert!(
            (apart - difference / errors.sqrt()).abs() < 1e-9,
            "{parameter}"
        );
        assert_eq!(values[1]["is_independent"], true);
        assert_eq!(
            (
                number(&values[2]["deviation"]),
                &values[2]["is_independent"]
            ),
            (0.0, &json!(false))
        );
        held += 1;
    }
    assert!(held > 3, "{found}");
    let shared = |at: usize| found["jobs"][at]["shares_data_with"].clone();
    assert_eq!(
        [shared(0), shared(1), shared(2)],
        [json!([ids[2]]), json!([]), json!([ids[0]])]
    );
    let csv = server.get(&format!("{path}&format=csv")).await.text();
    let header =
        "parameter,unit,job,name,estimate,standard_error,remark,difference,deviation,independent\n";
    assert!(csv.starts_with(header), "{csv}");
    assert_eq!(
        csv.lines().count(),
        1 + 3 * found["parameters"].as_array().unwrap().len()
    );
    // on the command line the same, with a word on what is not independent
    let (table, said) = run(&["compare", &ids[0], &ids[2], "--server", &server.url]);
    assert!(table.contains("Ma") && table.contains("+0.0*"), "{table}");
    assert!(
        said.contains("jobs 1 and 2 were fitted to samples of the same recording"),
        "{said}"
    );
}

#[tokio::test]
async fn what_cannot_be_compared_is_said() {
    let server = Server::start().await;
    let ids = three(&server).await;
    let unknown = "01950000-0000-7000-8000-000000000000";
    for (jobs, status, code) in [
        (String::new(), 400, "invalid_query"),
        (ids[0].clone(), 400, "invalid_query"),
        (format!("{0},{0}", ids[0]), 400, "invalid_query"),
        (format!("{},{unknown}", ids[0]), 404, "unknown_job"),
        (format!("{},x", ids[0]), 404, "unknown_job"),
    ] {
        let refused = server.get(&format!("/v1/compare?jobs={jobs}")).await;
        assert_eq!(refused.problem(status, code).len(), 0, "{jobs}");
    }
    let both = format!("/v1/campaigns?tag=a&jobs={}", ids[0]);
    server.get(&both).await.problem(400, "invalid_query");
}

#[tokio::test]
async fn a_parameter_is_seen_over_the_mean_of_a_channel() {
    let server = Server::start().await;
    let ids = three(&server).await;
    let path = format!(
        "/v1/campaigns?jobs={},{}&by=mean(alpha)&parameters=Ma",
        ids[0], ids[1]
    );
    let found = server.get(&path).await.json();
    let points = found["curves"][0]["points"].as_array().unwrap().clone();
    for (point, seed) in points.iter().zip([1, 2]) {
        // by hand from the file
        let csv = elevator_of(16.0, seed);
        let mut lines = csv.lines();
        let header: Vec<&str> = lines.next().unwrap().split(',').collect();
        let column = header
            .iter()
            .position(|name| name.starts_with("alpha["))
            .unwrap();
        let values: Vec<f64> = lines
            .map(|line| line.split(',').nth(column).unwrap().parse().unwrap())
            .collect();
        let scale = if header[column].contains("deg") {
            1f64.to_radians()
        } else {
            1.0
        };
        let mean = scale * values.iter().sum::<f64>() / values.len() as f64;
        let told = number(&point["conditions"]["mean(alpha)"]);
        assert!((told - mean).abs() < 1e-12, "{told} {mean}");
    }
    assert_eq!(points.len(), 2);
    let nothing = server.get(&path.replace("alpha", "Mach")).await.json();
    let reason = nothing["left_out"][0]["reason"].as_str().unwrap();
    assert!(reason.contains("no channel Mach"), "{reason}");
}
