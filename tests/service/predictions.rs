//! Predictions of a finished job over HTTP and on the command line, and simulations of own models.

use std::path::Path;
use std::process::{Command, Output};

use crate::common::server::Server;
use serde_json::{Value, json};

/// An elevator input, and nothing else.
const INPUT: &str =
    "t[s],de[deg]\n0,-1.15\n0.1,-1.15\n0.2,-0.5\n0.3,-0.2\n0.4,-0.2\n0.5,-1.0\n0.6,-1.15\n";

#[tokio::test]
async fn a_finished_job_predicts_from_inputs_alone() {
    let server = Server::start().await;
    let maneuver = server.upload(&crate::common::recordings::elevator()).await;
    let id = server.submit(&crate::common::jobs::job(&maneuver)).await;
    server.wait(&id).await;
    let input = server.upload(INPUT).await;
    let path = format!("/v1/jobs/{id}/predictions");
    let wanted = json!({
        "maneuvers": [{"id": input, "label": "push", "start": {"alpha_0": 0.06}}],
        "names": ["q"],
        "monte_carlo": {"draws": 100, "seed": 1},
    });
    let answer = server.post_json(&path, &wanted).await;
    assert_eq!(answer.status, 200, "{}", answer.text());
    let segment = &answer.json()["segments"][0];
    assert_eq!(segment["segment"], "push");
    assert_eq!(segment["draws_lost"], 0);
    let output = &segment["quantities"][1];
    assert_eq!(
        (&output["name"], &output["kind"]),
        (&json!("q"), &json!("output"))
    );
    for part in ["values", "standard_errors", "lower", "upper"] {
        assert_eq!(output[part].as_array().expect("a list").len(), 7, "{part}");
    }
    let csv = server
        .post_json(&format!("{path}?format=csv"), &wanted)
        .await
        .text();
    assert!(
        csv.starts_with("segment,t[s],q[rad/s],q_standard_error[rad/s],q_lower[rad/s]"),
        "{csv}"
    );
    assert_eq!(csv.lines().count(), 8);

    let open = json!({"maneuvers": [{"id": input}]});
    let faults = server
        .post_json(&path, &open)
        .await
        .problem(422, "invalid_prediction");
    assert!(
        faults[0].0.ends_with("/parameters/alpha_0/start"),
        "{faults:?}"
    );
    let unknown = json!({"maneuvers": [{"id": "nothing"}]});
    let faults = server
        .post_json(&path, &unknown)
        .await
        .problem(422, "invalid_prediction");
    assert_eq!(
        faults[0],
        (
            "/maneuvers/0/id".to_string(),
            "unknown_maneuver".to_string()
        )
    );
    server
        .post_json("/v1/jobs/nothing/predictions", &wanted)
        .await
        .problem(404, "unknown_job");
}

/// A roll of first order, and a flight of it.
fn own() -> (Value, Value) {
    let model = json!({
        "name": "first-order-roll",
        "inputs": {"da": {"unit": "rad"}},
        "parameters": {"Lp": {"unit": "1/s", "start": -2.0}, "Lda": {"unit": "1/s^2", "start": -5.0}},
        "states": {"p": {"unit": "rad/s", "initial": "0", "derivative": "Lp*p + Lda*da"}},
        "outputs": {"p": {"unit": "rad/s", "equation": "p"}},
    });
    let scenario = json!({
        "model": "roll.json", "seed": 1, "step": 0.1, "duration": 5.0,
        "truth": {"Lp": -2.0, "Lda": -4.0},
        "inputs": {"da": {"unit": "deg", "design": {"shape": "doublet", "start": 1.0, "unit_time": 1.0, "amplitude": 2.0}}},
        "outputs": {"p": {"unit": "deg/s", "noise": 0.0}},
    });
    (model, scenario)
}

#[tokio::test]
async fn own_models_are_simulated_over_http() {
    let server = Server::start().await;
    let (model, scenario) = own();
    let wanted = json!({"model": model, "scenario": scenario});
    let answer = server.post_json("/v1/simulations", &wanted).await;
    assert_eq!(answer.status, 200, "{}", answer.text());
    let csv = answer.text();
    assert_eq!(csv.lines().count(), 52);
    // a straight line from 0.9 s to 1 s, then 2 deg until 1.9 s, by hand
    let row = csv.lines().nth(20).expect("a row at 1.9 s");
    let p: f64 = row
        .split(',')
        .next_back()
        .expect("p")
        .parse()
        .expect("a number");
    let ramp = -8.0 * (0.05 - 0.25 * (1.0 - (-0.2_f64).exp())) / 0.1;
    let expected = ramp * (-1.8_f64).exp() - 4.0 * (1.0 - (-1.8_f64).exp());
    assert!((p - expected).abs() < 1e-4, "{row}: {expected}");

    let mut from_file = wanted.clone();
    from_file["scenario"]["inputs"]["da"]["design"] =
        json!({"shape": "recorded", "file": "/etc/passwd"});
    let refused = server.post_json("/v1/simulations", &from_file).await;
    assert_eq!(refused.json()["code"], "invalid_scenario");
    assert!(
        refused.text().contains("files are not read here"),
        "{}",
        refused.text()
    );
    let mut long = wanted.clone();
    long["scenario"]["step"] = json!(1e-6);
    let refused = server.post_json("/v1/simulations", &long).await;
    assert!(
        refused.text().contains("at most 200000 samples"),
        "{}",
        refused.text()
    );
    let unnamed = json!({"scenario": own().1});
    server
        .post_json("/v1/simulations", &unnamed)
        .await
        .problem(404, "unknown_model");
}

fn trimtab(arguments: &[&str]) -> Output {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_trimtab"));
    command.args(arguments).current_dir(directory);
    command.output().expect("the program runs")
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

#[test]
fn commands_simulate_own_models_fit_them_and_predict() {
    let folder = std::env::temp_dir().join(format!("trimtab-predict-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = |name: &str| folder.join(name).display().to_string();
    let (model, mut scenario) = own();
    scenario["outputs"]["p"]["noise"] = json!(0.1);
    std::fs::write(path("roll.json"), model.to_string()).expect("written");
    let toml = toml::to_string(&scenario).expect("TOML");
    std::fs::write(path("roll.toml"), toml).expect("written");
    // the model beside the scenario, and one that is named
    let csv = succeeds(&["simulate", &path("roll.toml")]);
    let named = succeeds(&[
        "simulate",
        &path("roll.toml"),
        "--model",
        &path("roll.json"),
    ]);
    assert_eq!(csv, named);
    std::fs::write(path("roll.csv"), &csv).expect("written");
    let fit = succeeds(&["fit", &path("roll.csv"), "-m", &path("roll.json"), "--json"]);
    std::fs::write(path("fit.json"), fit).expect("written");
    std::fs::write(
        path("input.csv"),
        "t[s],da[deg]\n0,0\n0.1,1\n0.2,1\n0.3,0\n",
    )
    .expect("written");
    let words = succeeds(&[
        "predict",
        &path("fit.json"),
        &path("input.csv"),
        "-o",
        &path("out.csv"),
    ]);
    assert!(words.contains("no output is recorded"), "{words}");
    let written = std::fs::read_to_string(path("out.csv")).expect("a table");
    assert_eq!(
        written.lines().next(),
        Some(
            "segment,t[s],p[rad/s],p_standard_error[rad/s],p_model[rad/s],p_model_standard_error[rad/s]"
        )
    );
    let compared = succeeds(&["predict", &path("fit.json"), &path("roll.csv")]);
    assert!(
        compared.contains("p [rad/s]") && compared.contains("14 CFR 60 A2A 2.d.2"),
        "{compared}"
    );
    let unread = trimtab(&["predict", &path("roll.csv"), &path("input.csv")]);
    assert!(said(&unread.stderr).contains("give what trimtab fit --json printed"));
    std::fs::remove_dir_all(&folder).expect("removed");
}

/// The options of a job that were only over HTTP: bounds, priors, edits, full R, starts.
#[test]
fn options_of_a_job_are_options_of_the_command() {
    let fit = |more: &[&str]| -> Value {
        let mut arguments = vec!["fit", "data/elevator.csv", "-m", "short-period", "--json"];
        arguments.extend(more);
        serde_json::from_str(&succeeds(&arguments)).expect("JSON")
    };
    let value = |result: &Value, name: &str, what: &str| {
        let rows = result["estimate"]["parameters"].as_array().expect("a list");
        let row = rows
            .iter()
            .find(|row| row["name"] == name)
            .expect("the parameter");
        row[what].clone()
    };
    let bounded = fit(&["--lower", "Ma=-3.0"]);
    assert_eq!(value(&bounded, "Ma", "at_bound"), "lower");
    let known = fit(&["--prior", "Mde=-4.0:0.001"]);
    let mde = value(&known, "Mde", "estimate").as_f64().expect("a number");
    assert!((mde + 4.0).abs() < 0.02, "{mde}");
    let edited = fit(&[
        "--edit",
        "sensor_delay:alpha",
        "--full-noise",
        "--start-method",
        "nelder_mead:300",
    ]);
    assert!(
        edited["model"]["outputs"]["alpha"]["delay"].is_string(),
        "{}",
        edited["model"]
    );
    let covariance = &edited["estimate"]["noise_covariance"];
    assert_ne!(covariance[0][1], 0.0);
    let unknown = trimtab(&[
        "fit",
        "data/elevator.csv",
        "-m",
        "short-period",
        "--edit",
        "sensor_delai:q",
    ]);
    assert!(
        said(&unknown.stderr).contains("choose one of"),
        "{}",
        said(&unknown.stderr)
    );
}
