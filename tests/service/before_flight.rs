//! Trim and design over HTTP and as commands.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::{Value, json};
use trimtab::design::Designs;
use trimtab::dynamics::{Trim, TrimOutcome};

use crate::common::server::Server;

fn trimtab(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_trimtab"));
    let directory = Path::new(env!("CARGO_MANIFEST_DIR"));
    let output = command.args(arguments).current_dir(directory).output();
    output.expect("the program runs")
}

fn value(trim: &Trim, name: &str) -> f64 {
    let mut all = trim.quantities.iter();
    all.find(|quantity| quantity.name == name)
        .expect(name)
        .value
}

#[tokio::test]
async fn a_model_and_an_estimate_are_trimmed() {
    let server = Server::start().await;
    let spec = json!({"model": "longitudinal-nonlinear", "constants": {"m": 7000.0}, "conditions": {"hold": {"V": 120, "thrust": 9000}}});
    let answer = server.post_json("/v1/trims", &spec).await;
    assert_eq!(answer.status, 200, "{}", answer.text());
    let light: Trim = serde_json::from_value(answer.json()).expect("a trim");
    let spec = json!({"model": "longitudinal-nonlinear", "conditions": {"hold": {"V": 120, "thrust": 9000}}});
    let heavy = server.post_json("/v1/trims", &spec).await.json();
    let heavy: Trim = serde_json::from_value(heavy).expect("a trim");
    assert_eq!(
        (light.outcome, heavy.outcome),
        (TrimOutcome::Trimmed, TrimOutcome::Trimmed)
    );
    assert!(value(&light, "alpha") < value(&heavy, "alpha"));

    let wrong = json!({"model": "longitudinal-nonlinear", "parameters": {"x": 1.0}});
    let refused = server.post_json("/v1/trims", &wrong).await;
    refused.problem(422, "invalid_trim");
    assert_eq!(refused.json()["errors"][0]["pointer"], "/parameters/x");
    let wrong = json!({"model": "longitudinal-nonlinear", "conditions": {"hold": {"x": 1}}});
    let refused = server.post_json("/v1/trims", &wrong).await;
    assert_eq!(refused.json()["errors"][0]["pointer"], "/conditions/hold/x");
    let unknown = server.post_json("/v1/trims", &json!({"model": "x"})).await;
    unknown.problem(404, "unknown_model");

    // the short period stands still where its parameters say
    let maneuver = server.upload(&crate::common::recordings::elevator()).await;
    let id = server.submit(&crate::common::jobs::job(&maneuver)).await;
    server.wait(&id).await;
    let hold = json!({"hold": {"q": 0}, "start": {"alpha": 0.05}});
    let answer = server
        .post_json(&format!("/v1/jobs/{id}/trim"), &hold)
        .await;
    assert_eq!(answer.status, 200, "{}", answer.text());
    let trim: Trim = serde_json::from_value(answer.json()).expect("a trim");
    let table = server
        .get(&format!("/v1/jobs/{id}/parameters"))
        .await
        .json();
    for (name, parameter) in [("alpha", "alpha_eq"), ("de", "de_eq")] {
        let rows = table["parameters"].as_array().expect("rows").iter();
        let row = rows
            .clone()
            .find(|row| row["name"] == parameter)
            .expect("a row");
        let quantity = trim.quantities.iter().find(|q| q.name == name).expect("it");
        let off = quantity.value - row["estimate"].as_f64().expect("a number");
        assert!(off.abs() < 1e-9, "{name}: {off}");
        let error = quantity.standard_error.expect("an error");
        let off = error / row["standard_error"].as_f64().expect("a number") - 1.0;
        assert!(off.abs() < 1e-6, "{name}: {error}");
    }
    let refused = server
        .post_json(&format!("/v1/jobs/{id}/trim?segment=x"), &hold)
        .await;
    refused.problem(422, "invalid_trim");
}

fn plan() -> Value {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/design/short-period.toml");
    let text = std::fs::read_to_string(file).expect("the plan");
    let plan: toml::Value = toml::from_str(&text).expect("TOML");
    let mut plan = serde_json::to_value(plan).expect("JSON");
    plan["maneuvers"][3]["design"]["simulations"] = json!(200);
    plan
}

#[tokio::test]
async fn maneuvers_are_designed_before_they_are_flown() {
    let server = Server::start().await;
    let answer = server
        .post_json("/v1/designs", &json!({"plan": plan()}))
        .await;
    assert_eq!(answer.status, 200, "{}", answer.text());
    let designs: Designs = serde_json::from_value(answer.json()).expect("designs");
    let names: Vec<&str> = designs.maneuvers.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["3-2-1-1", "doublet", "multisine", "optimal"]);
    let bound = |maneuver: usize| designs.maneuvers[maneuver].ln_det_covariance.expect("all");
    assert!(
        bound(3) < bound(0) && bound(0) < bound(1),
        "{} {} {}",
        bound(3),
        bound(0),
        bound(1)
    );
    assert!(designs.together.iter().all(|row| row.best.is_some()));

    let path = "/v1/designs?format=csv&maneuver=doublet";
    let table = server.post_json(path, &json!({"plan": plan()})).await;
    assert!(table.header("content-type").starts_with("text/csv"));
    let text = table.text();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("t[s],de[deg]"));
    assert_eq!(lines.clone().count(), designs.maneuvers[1].time.len());
    // as a recording it can be read
    assert_eq!(server.upload(&text).await.len(), 64);

    for (query, code) in [
        ("?format=csv", 400),
        ("?format=csv&maneuver=x", 400),
        ("?maneuver=doublet", 400),
    ] {
        let refused = server
            .post_json(&format!("/v1/designs{query}"), &json!({"plan": plan()}))
            .await;
        assert_eq!(refused.status.as_u16(), code, "{query}: {}", refused.text());
    }
    let mut wrong = plan();
    wrong["maneuvers"][0]["design"]["input"] = json!("da");
    let refused = server
        .post_json("/v1/designs", &json!({"plan": wrong}))
        .await;
    refused.problem(422, "invalid_design");
    assert_eq!(
        refused.json()["errors"][0]["pointer"],
        "/plan/maneuvers/0/design/input"
    );
    let mut long = plan();
    long["scenario"]["step"] = json!(0.0005);
    long["maneuvers"][3]["design"]["simulations"] = json!(20_000);
    let refused = server
        .post_json("/v1/designs", &json!({"plan": long}))
        .await;
    assert_eq!(refused.json()["errors"][0]["code"], "too_large");
}

/// Faults point into what was sent.
#[tokio::test]
async fn faults_of_a_model_are_told_where_it_stands() {
    let server = Server::start().await;
    let document = trimtab::model::catalog::find("short-period").expect("a model");
    let sound = serde_json::to_value(document).expect("JSON");
    let mut broken = sound.clone();
    broken["states"]["q"]["derivative"] = json!("alpha*nothing");
    let pointer =
        |refused: &crate::common::server::Answer| refused.json()["errors"][0]["pointer"].clone();
    let spec = json!({"model": broken, "plan": plan()});
    let refused = server.post_json("/v1/designs", &spec).await;
    refused.problem(422, "invalid_model");
    assert_eq!(pointer(&refused), "/model/states/q/derivative");
    let refused = server
        .post_json("/v1/trims", &json!({"model": broken}))
        .await;
    refused.problem(422, "invalid_trim");
    assert_eq!(pointer(&refused), "/model/states/q/derivative");
    // a value beyond the bounds of the document stands beside it
    let mut bounded = sound;
    bounded["parameters"]["Ma"]["upper"] = json!(0.0);
    let spec = json!({"model": bounded, "parameters": {"Ma": 1.0}});
    let refused = server.post_json("/v1/trims", &spec).await;
    assert_eq!(pointer(&refused), "/parameters/Ma", "{}", refused.text());
}

/// A plan that is sent in has no files beside it.
#[tokio::test]
async fn recorded_inputs_of_a_plan_are_not_read_over_http() {
    let server = Server::start().await;
    let mut from_file = plan();
    from_file["scenario"]["inputs"]["de"]["design"] =
        json!({"shape": "recorded", "file": "elevator.csv"});
    let refused = server
        .post_json("/v1/designs", &json!({"plan": from_file}))
        .await;
    refused.problem(422, "invalid_design");
    assert_eq!(refused.json()["errors"][0]["pointer"], "/plan/scenario");
    let text = refused.text();
    assert!(text.contains("files are not read here"), "{text}");
}

fn said(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

/// All commands that take a model say which there are.
#[test]
fn a_model_that_is_not_there_is_told_with_those_that_are() {
    let commands: [&[&str]; 5] = [
        &["trim", "nothing"],
        &["design", "data/design/short-period.toml", "-m", "nothing"],
        &["simulate", "data/elevator.toml", "-m", "nothing"],
        &["fit", "data/elevator.csv", "-m", "nothing"],
        &[
            "fit",
            "data/elevator.csv",
            "-m",
            "short-period",
            "--reconstruct",
            "nothing",
        ],
    ];
    for arguments in commands {
        let refused = trimtab(arguments);
        let text = said(&refused.stderr);
        assert_eq!(refused.status.code(), Some(1), "{arguments:?}: {text}");
        assert!(
            text.contains("there is no catalog model 'nothing'; the catalog has ")
                && text.contains("short-period"),
            "{arguments:?}: {text}"
        );
    }
}

/// The plan with one maneuver as the scenario has it, whose elevator is in a file beside the plan.
#[test]
fn inputs_of_a_plan_are_read_from_files_beside_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let time: Vec<f64> = (0..=500).map(|k| f64::from(k) * 0.04).collect();
    let moved = |t: f64| if (2.0..3.0).contains(&t) { 1.5 } else { 0.25 };
    let rows: String = time
        .iter()
        .map(|&t| format!("{t},{}\n", moved(t)))
        .collect();
    let recording = format!("t[s],stick[deg]\n{rows}");
    std::fs::write(folder.path().join("flown.csv"), recording).expect("written");
    let mut plan = plan();
    plan["scenario"]["inputs"]["de"] = json!({"unit": "deg", "design": {"shape": "recorded", "file": "flown.csv", "channel": "stick"}});
    plan["maneuvers"] = json!([{"name": "as flown", "design": {"kind": "scenario"}}]);
    plan["rate_limits"] = json!({});
    let file = folder.path().join("plan.json");
    std::fs::write(&file, plan.to_string()).expect("written");
    let output = folder.path().join("designs/of/it");
    let (file, output) = (file.to_string_lossy(), output.to_string_lossy());
    let done = trimtab(&["design", &file, "--json", "-o", &output]);
    assert!(done.status.success(), "{}", said(&done.stderr));
    let designs: Designs = serde_json::from_slice(&done.stdout).expect("designs");
    let values = &designs.maneuvers[0].inputs[0].values;
    assert_eq!(values.len(), time.len());
    for (t, value) in time.iter().zip(values) {
        assert!((value - moved(*t)).abs() < 1e-9, "{t}: {value}");
    }
    // the scenario has them in itself
    let scenario = format!("{output}/as_flown.toml");
    let flown = trimtab(&["simulate", &scenario]);
    assert!(flown.status.success(), "{}", said(&flown.stderr));
}

#[test]
fn maneuvers_whose_files_would_be_the_same_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut plan = plan();
    plan["maneuvers"][0]["name"] = json!("a/b");
    plan["maneuvers"][1]["name"] = json!("a_b");
    let file = folder.path().join("plan.json");
    std::fs::write(&file, plan.to_string()).expect("written");
    let output = folder.path().join("designs");
    let refused = trimtab(&[
        "design",
        &file.to_string_lossy(),
        "-o",
        &output.to_string_lossy(),
    ]);
    let text = said(&refused.stderr);
    assert_eq!(refused.status.code(), Some(1), "{text}");
    assert!(text.contains("'a/b' and 'a_b'"), "{text}");
    assert!(!output.exists());
}

#[test]
fn trim_and_design_are_commands() {
    let arguments = [
        "trim",
        "six-degrees-of-freedom",
        "--hold",
        "V=60[m/s]",
        "--hold",
        "beta=0",
        "--rate",
        "psi=3[deg/s]",
    ];
    let done = trimtab(&arguments);
    let text = said(&done.stdout);
    assert!(done.status.success(), "{}", said(&done.stderr));
    assert!(
        text.contains("phi [rad]")
            && text.contains("undetermined: h")
            && text.contains("undetermined: psi"),
        "{text}"
    );
    let failed = trimtab(&[
        "trim",
        "longitudinal-nonlinear",
        "--hold",
        "V=120",
        "--limit",
        "thrust=0..2000",
        "--hold",
        "theta=10[deg]",
    ]);
    assert_eq!(failed.status.code(), Some(1));
    assert!(
        said(&failed.stderr).contains("no steady flight")
            && said(&failed.stdout).contains("rate of V")
    );

    let directory = std::env::temp_dir().join(format!("trimtab-design-{}", std::process::id()));
    let folder = directory.to_string_lossy().to_string();
    let done = trimtab(&["design", "data/design/short-period.toml", "-o", &folder]);
    let text = said(&done.stdout);
    assert!(done.status.success(), "{}", said(&done.stderr));
    assert!(
        text.contains("relative peak factor")
            && text.contains("together")
            && text.contains("Ma [1/s^2]"),
        "{text}"
    );
    let table = std::fs::read_to_string(directory.join("multisine.csv")).expect("a table");
    assert!(table.starts_with("t[s],de[deg]\n"), "{table}");
    // what was designed can be flown
    let scenario = directory.join("optimal.toml");
    let flown = trimtab(&["simulate", &scenario.to_string_lossy()]);
    assert!(
        flown.status.success() && said(&flown.stdout).starts_with("t[s]"),
        "{}",
        said(&flown.stderr)
    );
    std::fs::remove_dir_all(directory).expect("removed");
}
