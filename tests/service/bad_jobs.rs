//! Jobs that cannot be run, each refused with its status, code and place; and what was stored before
//! is there after all of them.

use crate::common::jobs::job;
use crate::common::recordings::elevator;
use crate::common::server::Server;
use serde_json::{Value, json};
use trimtab::model::catalog;

/// A short-period job with its model written out, to be spoilt.
fn inline_job(maneuver: &str) -> Value {
    let mut spec = job(maneuver);
    spec["model"] = serde_json::to_value(catalog::find("short-period").unwrap()).unwrap();
    spec
}

struct Case {
    what: &'static str,
    spoil: fn(&mut Value),
    pointer: &'static str,
    code: &'static str,
}

const CASES: &[Case] = &[
    Case {
        what: "unknown unit",
        spoil: |spec| spec["model"]["parameters"]["Za"]["unit"] = json!("1/fortnight"),
        pointer: "/model/parameters/Za/unit",
        code: "unknown_unit",
    },
    Case {
        what: "unit mismatch in an equation",
        spoil: |spec| spec["model"]["outputs"]["q"]["equation"] = json!("q + alpha"),
        pointer: "/model/outputs/q/equation",
        code: "unit_mismatch",
    },
    Case {
        what: "unknown symbol",
        spoil: |spec| spec["model"]["states"]["q"]["derivative"] = json!("Ma*alhpa"),
        pointer: "/model/states/q/derivative",
        code: "unknown_symbol",
    },
    Case {
        what: "cyclic definition",
        spoil: |spec| {
            spec["model"]["definitions"] = json!({"a": {"equation": "b"}, "b": {"equation": "a"}});
        },
        pointer: "/model/definitions/a/equation",
        code: "cyclic_definition",
    },
    Case {
        what: "expression that cannot be read",
        spoil: |spec| spec["model"]["states"]["q"]["derivative"] = json!("Ma*(alpha"),
        pointer: "/model/states/q/derivative",
        code: "syntax_error",
    },
    Case {
        what: "expression nested 10^5 deep",
        spoil: |spec| {
            let (open, close) = ("(".repeat(100_000), ")".repeat(100_000));
            spec["model"]["states"]["q"]["derivative"] = json!(format!("{open}q{close}"));
        },
        pointer: "/model/states/q/derivative",
        code: "",
    },
    Case {
        what: "500 states",
        spoil: |spec| {
            for number in 0..500 {
                let state = json!({"initial": "0", "derivative": "0"});
                spec["model"]["states"][format!("x{number}")] = state;
            }
        },
        pointer: "/model/states",
        code: "model_too_large",
    },
    Case {
        what: "unknown channel",
        spoil: |spec| spec["channels"] = json!({"de": "elevator_left"}),
        pointer: "/channels/de",
        code: "unknown_channel",
    },
    Case {
        what: "rows that are not there",
        spoil: |spec| spec["maneuvers"][0]["rows"] = json!([600, 700]),
        pointer: "/maneuvers/0/rows",
        code: "bad_rows",
    },
    Case {
        what: "unknown parameter",
        spoil: |spec| spec["parameters"] = json!({"Mx": {"start": 1.0}}),
        pointer: "/parameters/Mx",
        code: "unknown_parameter",
    },
    Case {
        what: "a maneuver that does not exist",
        spoil: |spec| spec["maneuvers"][0]["id"] = json!("0".repeat(64)),
        pointer: "/maneuvers/0/id",
        code: "unknown_maneuver",
    },
    Case {
        what: "no maneuver at all",
        spoil: |spec| spec["maneuvers"] = json!([]),
        pointer: "/maneuvers",
        code: "no_maneuvers",
    },
    Case {
        what: "too many maneuvers",
        spoil: |spec| {
            let one = spec["maneuvers"][0].clone();
            spec["maneuvers"] = Value::Array(vec![one; 300]);
        },
        pointer: "/maneuvers",
        code: "too_many_maneuvers",
    },
    Case {
        what: "an effect on what is not there",
        spoil: |spec| spec["edits"] = json!([{"kind": "sensor_bias", "target": "beta"}]),
        pointer: "/edits/0",
        code: "unknown_target",
    },
    Case {
        what: "more edits than a model can have effects",
        spoil: |spec| {
            let edit = json!({"kind": "sensor_bias", "target": "q"});
            spec["edits"] = Value::Array(vec![edit; 10_000]);
        },
        pointer: "/edits",
        code: "too_many_edits",
    },
    Case {
        what: "an effect on the same output ten thousand times over",
        spoil: |spec| {
            let target = vec!["q"; 10_000].join("+");
            spec["edits"] = json!([{"kind": "sensor_delay", "target": target}]);
        },
        pointer: "/edits/0",
        code: "too_long",
    },
];

#[tokio::test]
async fn each_fault_has_its_place_and_code() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let good = server.submit(&inline_job(&maneuver)).await;
    assert_eq!(server.wait(&good).await["outcome"], "converged");
    let table = server.get(&format!("/v1/jobs/{good}/parameters")).await;

    for Case {
        what,
        spoil,
        pointer,
        code,
    } in CASES
    {
        let mut spec = inline_job(&maneuver);
        spoil(&mut spec);
        let answer = server.post_json("/v1/jobs", &spec).await;
        let faults = answer.problem(422, "invalid_job");
        let said =
            |(at, word): &(String, String)| at == pointer && (code.is_empty() || word == code);
        assert!(faults.iter().any(said), "{what}: {faults:?}");
        let validated = server.post_json("/v1/jobs?validate_only=true", &spec).await;
        assert_eq!(validated.problem(422, "invalid_job"), faults, "{what}");
    }

    assert_eq!(
        server.get("/v1/jobs").await.json()["jobs"]
            .as_array()
            .unwrap()
            .len(),
        1
    );
    let after = server.get(&format!("/v1/jobs/{good}/parameters")).await;
    assert_eq!((after.status, after.bytes), (table.status, table.bytes));
}

#[tokio::test]
async fn missing_values_of_an_input_are_refused() {
    let server = Server::start().await;
    let recording = elevator();
    let mut lines: Vec<String> = recording.lines().map(str::to_string).collect();
    for (row, gap) in [(100, ""), (200, "NaN")] {
        let mut cells: Vec<&str> = lines[row].split(',').collect();
        cells[1] = gap;
        let spoilt = cells.join(",");
        lines[row] = spoilt;
    }
    let maneuver = server.upload(&lines.join("\n")).await;
    let stored = server
        .get(&format!("/v1/maneuvers/{maneuver}"))
        .await
        .json();
    assert_eq!(stored["summary"]["channels"][0]["missing"], 2);
    assert_eq!(stored["summary"]["findings"][0]["code"], "missing_values");
    let faults = server
        .post_json("/v1/jobs", &job(&maneuver))
        .await
        .problem(422, "invalid_job");
    assert!(
        faults.iter().any(|(_, code)| code == "missing_values"),
        "{faults:?}"
    );
}

#[tokio::test]
async fn missing_values_of_an_output_do_not_count_and_stay_missing() {
    let server = Server::start().await;
    let recording = elevator();
    let mut lines: Vec<String> = recording.lines().map(str::to_string).collect();
    let header: Vec<&str> = recording.lines().next().unwrap().split(',').collect();
    let q = header
        .iter()
        .position(|name| name.starts_with("q["))
        .unwrap();
    for (row, line) in lines.iter_mut().enumerate().skip(1) {
        if row % 10 != 1 {
            let mut cells: Vec<&str> = line.split(',').collect();
            cells[q] = "";
            *line = cells.join(",");
        }
    }
    let maneuver = server.upload(&lines.join("\n")).await;
    let id = server.submit(&job(&maneuver)).await;
    let done = server.wait(&id).await;
    assert_eq!(done["outcome"], "converged", "{done:#}");
    let events = server.get(&format!("/v1/jobs/{id}/events")).await.text();
    assert!(
        events.contains("no value in 563 of 626 samples"),
        "{events}"
    );
    let path = format!("/v1/jobs/{id}/time-histories");
    let history = server.get(&path).await.json();
    let output = &history["segments"][0]["outputs"][1];
    for (row, missing) in [(0, false), (1, true), (9, true), (10, false)] {
        assert_eq!(output["measured"][row].is_null(), missing, "{row}");
        assert_eq!(output["residual"][row].is_null(), missing, "{row}");
        assert!(output["model"][row].is_number());
    }
    let csv = server.get(&format!("{path}?format=csv")).await.text();
    let second = csv.lines().nth(2).unwrap();
    assert!(second.split(',').any(str::is_empty), "{second}");
    let fit = server.get(&format!("/v1/jobs/{id}/estimate")).await.json();
    assert_eq!(fit["outputs"][1]["samples"], 63);
    assert_eq!(fit["outputs"][0]["samples"], 626);
}

#[tokio::test]
async fn a_singular_problem_is_a_result_that_says_so() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let mut spec = inline_job(&maneuver);
    // two parameters that only appear as a sum
    let parameters = &mut spec["model"]["parameters"];
    parameters["Mq1"] = json!({"unit": "1/s", "start": -0.5});
    let derivative = "Ma*(alpha - alpha_eq) + (Mq + Mq1)*q + Mde*(de - de_eq)";
    spec["model"]["states"]["q"]["derivative"] = json!(derivative);
    let id = server.submit(&spec).await;
    let done = server.wait(&id).await;
    assert_eq!(
        (&done["status"], &done["outcome"]),
        (&json!("succeeded"), &json!("singular")),
        "{done:#}"
    );
    let table = server
        .get(&format!("/v1/jobs/{id}/parameters"))
        .await
        .json();
    let set = &table["collinear"][0]["parameters"];
    assert_eq!(set, &json!(["Mq", "Mq1"]), "{table:#}");
}
