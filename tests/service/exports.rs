//! What leaves for other programs: MAT files, source code, campaigns as tables.

use crate::common::server::Server;
use serde_json::{Value, json};

/// The matrices of a MAT file of version 4 (little-endian doubles), by name: rows, columns, numbers by columns.
fn matrices(file: &[u8]) -> Vec<(String, usize, usize, Vec<f64>)> {
    let mut all = Vec::new();
    let mut rest = file;
    while !rest.is_empty() {
        let word = |at: usize| {
            let bytes = rest[4 * at..4 * at + 4].try_into().expect("four bytes");
            u32::from_le_bytes(bytes) as usize
        };
        let (rows, columns, name) = (word(1), word(2), word(4));
        let text = String::from_utf8(rest[20..20 + name - 1].to_vec()).expect("a name");
        let numbers = &rest[20 + name..20 + name + 8 * rows * columns];
        let numbers = numbers
            .chunks(8)
            .map(|b| f64::from_le_bytes(b.try_into().expect("eight")));
        all.push((text, rows, columns, numbers.collect()));
        rest = &rest[20 + name + 8 * rows * columns..];
    }
    all
}

#[tokio::test]
async fn a_linear_system_is_a_mat_file_and_a_model_is_source_code() {
    let server = Server::start().await;
    let maneuver = server.upload(&crate::common::recordings::elevator()).await;
    let id = server.submit(&crate::common::jobs::job(&maneuver)).await;
    server.wait(&id).await;
    let system = server
        .get(&format!("/v1/jobs/{id}/linear-system"))
        .await
        .json();
    let answer = server
        .get(&format!("/v1/jobs/{id}/linear-system?format=mat"))
        .await;
    assert_eq!(answer.header("content-type"), "application/x-matlab-data");
    let all = matrices(&answer.bytes);
    let of = |name: &str| {
        all.iter()
            .find(|matrix| matrix.0 == name)
            .expect("the matrix")
    };
    let (_, rows, columns, numbers) = of("A");
    assert_eq!((*rows, *columns), (2, 2));
    for (place, (i, j)) in [(0, 0), (1, 0), (0, 1), (1, 1)].into_iter().enumerate() {
        assert_eq!(json!(numbers[place]), system["a"]["values"][i][j]);
    }
    let names: String = of("states")
        .3
        .iter()
        .map(|code| char::from(*code as u8))
        .collect();
    // by columns: "alpha" over "q"
    assert_eq!(names, "aql p h a ");

    let c = server
        .get(&format!("/v1/jobs/{id}/source-code?language=c"))
        .await
        .text();
    assert!(
        c.contains("void model_derivative(const double *x") && c.contains("x[0] = alpha [rad]"),
        "{c}"
    );
    let python = server
        .get(&format!("/v1/jobs/{id}/source-code?language=python"))
        .await
        .text();
    assert!(python.contains("def derivative(x, u, t):"), "{python}");
    let matlab = server
        .get(&format!("/v1/jobs/{id}/source-code?language=matlab"))
        .await
        .text();
    assert!(
        matlab.starts_with("function [dx, y, x0] = short_period(x, u, t)"),
        "{matlab}"
    );
    let unit = server
        .get(&format!("/v1/jobs/{id}/simulator-model?format=fmu"))
        .await;
    assert_eq!(unit.header("content-type"), "application/zip");
    assert!(unit.bytes.starts_with(b"PK\x03\x04"));
    let none = server
        .get(&format!("/v1/jobs/{id}/simulator-model?format=jsbsim"))
        .await;
    none.problem(409, "no_aerodynamics");
    for wrong in ["?format=dll", "?format=fmu&segment=x"] {
        let path = format!("/v1/jobs/{id}/simulator-model{wrong}");
        let refused = server.get(&path).await;
        assert_eq!(refused.status, 400, "{wrong}: {}", refused.text());
    }
    for wrong in ["language=fortran", "language=c&segment=x"] {
        let refused = server
            .get(&format!("/v1/jobs/{id}/source-code?{wrong}"))
            .await;
        assert_eq!(refused.status, 400, "{wrong}: {}", refused.text());
    }
}

#[tokio::test]
async fn jobs_of_a_tag_are_a_campaign() {
    let server = Server::start().await;
    for seed in 1..4_u64 {
        let csv = crate::common::recordings::elevator_of(16.0, seed);
        let maneuver = server.upload(&csv).await;
        let mut job = crate::common::jobs::job(&maneuver);
        job["name"] = json!(format!("flight {seed}"));
        job["tags"] = json!(["campaign 7", format!("alpha={seed}")]);
        let id = server.submit(&job).await;
        server.wait(&id).await;
    }
    let path = "/v1/campaigns?tag=campaign%207&parameters=Ma";
    let mean = server.get(path).await.json();
    let curve = &mean["curves"][0];
    assert_eq!(
        (&curve["parameter"], &curve["degrees_of_freedom"]),
        (&json!("Ma"), &json!(2))
    );
    // the weighted mean by hand
    let points = curve["points"].as_array().expect("a list");
    let number = |value: &Value| value.as_f64().expect("a number");
    let weighted = |of: &dyn Fn(&Value) -> f64| -> f64 {
        points
            .iter()
            .map(|p| of(p) / number(&p["standard_error"]).powi(2))
            .sum()
    };
    let expected = weighted(&|p| number(&p["estimate"])) / weighted(&|_| 1.0);
    let found = number(&curve["terms"][0]["value"]);
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
    let line = server
        .get(&format!("{path}&by=alpha&degree=1&format=csv"))
        .await
        .text();
    assert!(
        line.starts_with("parameter,unit,alpha,job,name,estimate,standard_error,curve,"),
        "{line}"
    );
    assert_eq!(line.lines().count(), 4);
    // a rerun is the same observation once more
    let old = points[0]["job"].as_str().expect("an id");
    let again = server
        .post_json(&format!("/v1/jobs/{old}/rerun"), &json!({}))
        .await;
    assert_eq!(again.status, 202, "{}", again.text());
    let again = again.json()["id"].as_str().expect("an id").to_string();
    server.wait(&again).await;
    let rerun = server.get(path).await.json();
    assert_eq!(rerun["curves"][0]["degrees_of_freedom"], 2);
    assert_eq!(rerun["left_out"][0]["job"], old);
    let reason = rerun["left_out"][0]["reason"].as_str().expect("a reason");
    assert!(reason.contains(&again), "{reason}");
    let untagged = server.get(&format!("{path}&by=mach")).await.json();
    assert_eq!(untagged["left_out"][0]["reason"], "it has no tag mach=...");
    for wrong in [
        "tag=nothing",
        "tag=campaign%207&degree=7",
        "by=alpha",
        "tag=campaign%207&by=alpha,alpha",
        "tag=campaign%207&by=a,b,c,d,e",
        "tag=campaign%207&group=a,b,c,d,e,f,g,h,i",
        "tag=campaign%207&group=mean(alpha)",
    ] {
        let refused = server.get(&format!("/v1/campaigns?{wrong}")).await;
        assert_eq!(refused.status, 400, "{wrong}: {}", refused.text());
    }
}

/// A label that begins like a formula was one in a spreadsheet.
#[tokio::test]
async fn a_label_is_no_formula_in_a_table() {
    let server = Server::start().await;
    let mut job =
        crate::common::jobs::job(&server.upload(&crate::common::recordings::elevator()).await);
    job["maneuvers"][0]["label"] = json!("=HYPERLINK(\"http://evil.example\",1)");
    let id = server.submit(&job).await;
    assert_eq!(server.wait(&id).await["status"], "succeeded");
    let csv = server
        .get(&format!("/v1/jobs/{id}/time-histories?format=csv"))
        .await
        .text();
    let row = csv.lines().nth(1).unwrap();
    let expected = "\"'=HYPERLINK(\"\"http://evil.example\"\",1)\",0.0,";
    assert!(row.starts_with(expected), "{row}");
}
