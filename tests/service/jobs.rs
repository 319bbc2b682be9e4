//! A job from its submission to its results, over HTTP.

use crate::common::jobs::job;
use crate::common::recordings::{elevator, elevator_of};
use crate::common::server::{Server, send};
use reqwest::Method;
use serde_json::{Value, json};
use trimtab::estimate::Estimate;
use trimtab::http::Config;
use trimtab::job::JobSpec;
use trimtab::model::ModelDocument;

#[tokio::test]
async fn a_maneuver_becomes_a_parameter_table() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let answer = server.post_json("/v1/jobs", &job(&maneuver)).await;
    assert_eq!(answer.status, 202, "{}", answer.text());
    let accepted = answer.json();
    assert_eq!(answer.header("location"), accepted["links"]["self"]);
    assert_eq!(accepted["kind"], "estimate");
    let id = accepted["id"].as_str().unwrap();

    let done = server.wait(id).await;
    assert_eq!(done["status"], "succeeded", "{done:#}");
    assert_eq!(done["outcome"], "converged");
    assert_eq!(done["has_result"], true);
    assert_eq!(done["attempt"], 1);
    assert!(done["created"].as_str() <= done["started"].as_str());
    assert!(done["started"].as_str() <= done["finished"].as_str());

    // the truth of the scenario, within the bounds that come with the estimate
    let table = server
        .get(done["links"]["parameters"].as_str().unwrap())
        .await
        .json();
    let truth = [("Za", -0.85), ("Ma", -3.4), ("Mq", -1.6), ("Mde", -4.8)];
    for (name, truth) in truth {
        let rows = table["parameters"].as_array().unwrap();
        let row = rows.iter().find(|row| row["name"] == name).unwrap();
        let error = (row["estimate"].as_f64().unwrap() - truth).abs();
        assert!(
            error < 4.0 * row["standard_error"].as_f64().unwrap(),
            "{row}"
        );
    }
}

#[tokio::test]
async fn every_result_has_its_forms() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let id = server.submit(&job(&maneuver)).await;
    server.wait(&id).await;
    let at = |name: &str| format!("/v1/jobs/{id}/{name}");

    let estimate: Estimate =
        serde_json::from_value(server.get(&at("estimate")).await.json()).unwrap();
    assert_eq!(estimate.samples, 626);

    let csv = server.get_as(&at("parameters"), "text/csv").await;
    assert_eq!(
        csv.header("content-type"),
        "text/csv; charset=utf-8; header=present"
    );
    let lines: Vec<String> = csv.text().lines().map(str::to_string).collect();
    assert_eq!(
        lines[0],
        "name,segment,unit,start,estimate,standard_error,fixed,at_bound,conventional_standard_error,provisional"
    );
    assert_eq!(lines.len(), 1 + estimate.parameters.len());
    assert_eq!(
        server.get(&at("parameters?format=csv")).await.text(),
        csv.text()
    );
    assert_eq!(
        server
            .get_as(&at("parameters"), "image/png")
            .await
            .problem(406, "not_acceptable"),
        []
    );

    let residuals = server.get(&at("residuals")).await.json();
    let segment = &residuals["segments"][0];
    assert_eq!(segment["samples"], 626);
    assert_eq!(
        segment["outputs"][0]["values"].as_array().unwrap().len(),
        626
    );
    let rms = |values: &Value| {
        let values: Vec<f64> = values
            .as_array()
            .unwrap()
            .iter()
            .map(|v| v.as_f64().unwrap())
            .collect();
        (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
    };
    let found = rms(&segment["outputs"][0]["values"]);
    assert!(
        (found / estimate.outputs[0].rms - 1.0).abs() < 1e-12,
        "the residuals are those of the estimate"
    );

    let analysis = server.get(&at("residual-analysis")).await.json();
    let alpha = &analysis["outputs"][0];
    assert_eq!(
        (&alpha["output"], &alpha["samples"]),
        (&json!("alpha"), &json!(626))
    );
    let rms = alpha["rms"].as_f64().unwrap();
    assert!((rms / estimate.outputs[0].rms - 1.0).abs() < 1e-12);
    // simulated with white noise
    assert!(
        alpha["portmanteau"]["probability"].as_f64().unwrap() > 1e-4,
        "{alpha}"
    );

    let csv = server
        .get_as(&at("time-histories"), "text/csv")
        .await
        .text();
    let header = csv.lines().next().unwrap();
    assert!(
        header.starts_with("segment,t[s],de[rad],alpha_measured[rad],alpha_model[rad],"),
        "{header}"
    );
    assert_eq!(csv.lines().count(), 627);
    let thinned = server
        .get(&at("time-histories?max_points=100"))
        .await
        .json();
    let segment = &thinned["segments"][0];
    assert_eq!(segment["samples"], 626);
    assert!(segment["time"].as_array().unwrap().len() <= 100);
    for resource in ["time-histories", "residuals", "trajectories"] {
        for (query, named) in [
            ("from=20&to=5", "from: 20 s is after to: 5 s"),
            ("to=NaN", "to: NaN"),
        ] {
            let refused = server.get(&at(&format!("{resource}?{query}"))).await;
            refused.problem(400, "invalid_query");
            assert!(refused.text().contains(named), "{}", refused.text());
        }
    }
    // a stretch without samples has the same columns
    let none = server
        .get_as(&at("time-histories?from=1e6"), "text/csv")
        .await
        .text();
    assert_eq!(none.trim_end(), header);

    let model: ModelDocument =
        serde_json::from_value(server.get(&at("model")).await.json()).unwrap();
    let toml = server.get_as(&at("model"), "application/toml").await.text();
    assert_eq!(toml::from_str::<ModelDocument>(&toml).unwrap(), model);

    let spec: JobSpec = serde_json::from_value(server.get(&at("spec")).await.json()).unwrap();
    assert_eq!(spec.maneuvers[0].id, maneuver);

    let iterations = server.get(&at("iterations")).await.json();
    let iterations = iterations["iterations"].as_array().unwrap();
    assert_eq!(iterations.len(), estimate.iterations + 1);
    assert_eq!(iterations[0]["number"], 0);
    assert!(iterations[0].get("type").is_none());
}

#[tokio::test]
async fn states_and_definitions_are_had_along_the_trajectory() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let id = server.submit(&job(&maneuver)).await;
    server.wait(&id).await;
    let at = |query: &str| format!("/v1/jobs/{id}/trajectories{query}");
    let segment = server.get(&at("?max_points=100")).await.json()["segments"][0].take();
    assert_eq!(segment["segment"], "1");
    let samples = segment["time"].as_array().unwrap().len();
    assert!((30..=100).contains(&samples), "{samples}");
    let names: Vec<(&str, &str)> = (segment["quantities"].as_array().unwrap().iter())
        .map(|series| {
            (
                series["name"].as_str().unwrap(),
                series["kind"].as_str().unwrap(),
            )
        })
        .collect();
    let expected = [
        ("alpha", "state"),
        ("q", "state"),
        ("alpha", "output"),
        ("q", "output"),
    ];
    assert_eq!(names, expected);
    let errors = segment["quantities"][0]["standard_errors"]
        .as_array()
        .unwrap();
    assert_eq!(errors.len(), samples);
    // the first sample is the initial state, which may be held
    let behind = errors.iter().skip(1);
    assert!(
        behind.clone().all(|error| error.as_f64().unwrap() > 0.0),
        "{errors:?}"
    );
    let csv = server.get(&at("?names=q&format=csv")).await.text();
    let titles = "segment,t[s],q[rad/s],q_standard_error[rad/s],q_model[rad/s],q_model_standard_error[rad/s]";
    assert_eq!(csv.lines().next(), Some(titles));
    let refused = server.get(&at("?names=Cm")).await;
    refused.problem(400, "invalid_query");
    assert!(
        refused.text().contains("it has alpha, q"),
        "{}",
        refused.text()
    );
}

/// The attitude from the rate, and a bias of both.
fn kinematics() -> Value {
    json!({
        "name": "pitching",
        "inputs": {"q": {"unit": "rad/s", "quantity": "pitch_rate"}},
        "parameters": {
            "q_bias": {"unit": "rad/s", "start": 0.0},
            "theta_0": {"unit": "rad", "start": "first(alpha)"},
        },
        "definitions": {"q_true": {"unit": "rad/s", "quantity": "pitch_rate", "equation": "q - q_bias"}},
        "states": {"theta": {"unit": "rad", "quantity": "pitch_angle", "initial": "theta_0", "derivative": "q_true"}},
        "outputs": {"alpha": {"unit": "rad", "equation": "theta"}},
    })
}

#[tokio::test]
async fn a_corrected_recording_is_one_like_others() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let said =
        json!({"flown": {"registration": "D-ADAM", "mass": {"value": 17600.0, "unit": "kg"}}});
    let own = format!("/v1/maneuvers/{maneuver}");
    let request = server.request(reqwest::Method::PATCH, &own);
    let request = request.header("content-type", "application/json");
    let patched = crate::common::server::send(request.body(said.to_string())).await;
    assert_eq!(patched.status, 200, "{}", patched.text());
    let of = |model: Value, id: &str| json!({"model": model, "maneuvers": [{"id": id}]});
    let id = server.submit(&of(kinematics(), &maneuver)).await;
    server.wait(&id).await;
    let path = format!("/v1/jobs/{id}/corrected-maneuvers");
    let answer = server.post_json(&path, &json!({})).await;
    assert_eq!(answer.status, 201, "{}", answer.text());
    let corrected = answer.json()[0].take();
    let name = corrected["name"].as_str().unwrap();
    assert_eq!(name, format!("1, corrected by job {id}"));
    assert_ne!(corrected["id"], maneuver);
    // it says what it was made of, and what was said of the flight
    let from = json!({"job": id, "maneuver": maneuver, "segment": "1"});
    assert_eq!(corrected["flown"]["derived_from"], from);
    assert_eq!(corrected["flown"]["registration"], "D-ADAM");
    let channels = corrected["summary"]["channels"].as_array().unwrap();
    let names: Vec<&str> = (channels.iter())
        .map(|channel| channel["name"].as_str().unwrap())
        .collect();
    for name in ["q", "theta", "alpha", "de", "V"] {
        assert!(names.contains(&name), "{names:?}");
    }
    let again = server.post_json(&path, &json!({})).await.json()[0].take();
    assert_eq!(again["id"], corrected["id"]);
    assert_eq!(again["flown"], corrected["flown"]);
    // the bias is out of it
    let id = server
        .submit(&of(kinematics(), corrected["id"].as_str().unwrap()))
        .await;
    server.wait(&id).await;
    let table = server
        .get(&format!("/v1/jobs/{id}/parameters"))
        .await
        .json();
    let bias = table["parameters"][0]["estimate"].as_f64().unwrap();
    assert!(bias.abs() < 1e-9, "{table:#}");
    let nobody = format!("/v1/jobs/{}/corrected-maneuvers", uuid::Uuid::nil());
    assert_eq!(
        server
            .post_json(&nobody, &json!({}))
            .await
            .problem(404, "unknown_job"),
        []
    );
    // aerodynamics are no correction
    let id = server.submit(&job(&maneuver)).await;
    server.wait(&id).await;
    let refused = server
        .post_json(&format!("/v1/jobs/{id}/corrected-maneuvers"), &json!({}))
        .await;
    refused.problem(409, "no_trajectory");
    assert!(
        refused.text().contains("a control, de"),
        "{}",
        refused.text()
    );
}

#[tokio::test]
async fn results_are_not_sent_twice() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let id = server.submit(&job(&maneuver)).await;
    server.wait(&id).await;
    for name in [
        "estimate",
        "parameters",
        "residuals",
        "residual-analysis",
        "time-histories",
        "trajectories",
        "model",
        "spec",
    ] {
        let path = format!("/v1/jobs/{id}/{name}");
        let first = server.get(&path).await;
        let etag = first.header("etag").to_string();
        assert!(!etag.is_empty(), "{name}");
        let again = server
            .request(Method::GET, &path)
            .header("if-none-match", &etag);
        let again = send(again).await;
        assert_eq!(
            (again.status.as_u16(), again.bytes.len()),
            (304, 0),
            "{name}"
        );
    }
}

#[tokio::test]
async fn results_before_the_end_are_a_conflict() {
    let server = Server::start_with(Config::default(), 0).await;
    let maneuver = server.upload(&elevator()).await;
    let id = server.submit(&job(&maneuver)).await;
    for name in [
        "estimate",
        "parameters",
        "residuals",
        "residual-analysis",
        "time-histories",
        "trajectories",
        "model",
    ] {
        let answer = server.get(&format!("/v1/jobs/{id}/{name}")).await;
        assert_eq!(answer.problem(409, "not_finished"), []);
        assert!(
            answer.json()["detail"]
                .as_str()
                .unwrap()
                .contains("/events")
        );
        let nobody = format!("/v1/jobs/{}/{name}", uuid::Uuid::nil());
        assert_eq!(server.get(&nobody).await.problem(404, "unknown_job"), []);
    }
    assert_eq!(
        server
            .get(&format!("/v1/jobs/{id}/iterations"))
            .await
            .json(),
        json!({"iterations": []})
    );

    let cancelled = server
        .post(&format!("/v1/jobs/{id}/cancel"), "text/plain", "")
        .await;
    assert_eq!(cancelled.status, 202);
    assert_eq!(cancelled.json()["status"], "cancelled");
    let again = server
        .post(&format!("/v1/jobs/{id}/cancel"), "text/plain", "")
        .await;
    assert_eq!(again.problem(409, "already_over"), []);
    let answer = server.get(&format!("/v1/jobs/{id}/estimate")).await;
    assert_eq!(answer.problem(404, "no_result"), []);
}

#[tokio::test]
async fn validation_says_what_the_job_amounts_to() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let answer = server
        .post_json("/v1/jobs?validate_only=true", &job(&maneuver))
        .await;
    assert_eq!(answer.status, 200, "{}", answer.text());
    let prepared = answer.json();
    assert_eq!(prepared["samples"], 626);
    assert_eq!(prepared["outputs"], json!(["alpha", "q"]));
    assert_eq!(
        server.get("/v1/jobs").await.json()["jobs"],
        json!([]),
        "nothing was accepted"
    );
}

#[tokio::test]
async fn all_faults_of_a_job_are_said_at_once() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;

    let unknown = json!({"model": "long-period", "maneuvers": [{"id": maneuver}, {"id": "ab"}, {"id": "cd"}]});
    let mut faults = server
        .post_json("/v1/jobs", &unknown)
        .await
        .problem(422, "invalid_job");
    faults.sort();
    let expected = [
        ("/maneuvers/1/id", "unknown_maneuver"),
        ("/maneuvers/2/id", "unknown_maneuver"),
        ("/model", "unknown_model"),
    ];
    assert_eq!(
        faults,
        expected.map(|(pointer, code)| (pointer.to_string(), code.to_string()))
    );

    let mut wrong = job(&maneuver);
    wrong["tags"] = json!([""]);
    wrong["channels"] = json!({"nonsense": "alpha"});
    wrong["options"] = json!({"tolerance": -1.0});
    wrong["parameters"] = json!({"Mx": {"start": 1.0}});
    let faults = server
        .post_json("/v1/jobs", &wrong)
        .await
        .problem(422, "invalid_job");
    let pointers: Vec<&str> = faults.iter().map(|(pointer, _)| pointer.as_str()).collect();
    for pointer in [
        "/tags/0",
        "/channels/nonsense",
        "/options/tolerance",
        "/parameters/Mx",
    ] {
        assert!(pointers.contains(&pointer), "{pointer} in {pointers:?}");
    }

    // faults of an inline model are said even where the data are missing
    let mut document =
        serde_json::to_value(trimtab::model::catalog::find("short-period").unwrap()).unwrap();
    document["states"]["q"]["derivative"] = json!("Ma*nonsense");
    let spec = json!({"model": document, "maneuvers": [{"id": "ab"}]});
    let faults = server
        .post_json("/v1/jobs", &spec)
        .await
        .problem(422, "invalid_job");
    let pointers: Vec<&str> = faults.iter().map(|(pointer, _)| pointer.as_str()).collect();
    assert!(pointers.contains(&"/maneuvers/0/id"), "{faults:?}");
    assert!(
        pointers.contains(&"/model/states/q/derivative"),
        "{faults:?}"
    );
}

#[tokio::test]
async fn wrong_shapes_are_pointed_at() {
    let server = Server::start().await;
    let at = async |body: &str| {
        let answer = server
            .post("/v1/jobs", "application/json", body.to_string())
            .await;
        let faults = answer.problem(422, "wrong_shape");
        assert_eq!(faults.len(), 1, "{faults:?}");
        assert_eq!(faults[0].1, "wrong_shape");
        faults[0].0.clone()
    };
    assert_eq!(at(r#"[]"#).await, "");
    assert_eq!(at(r#"{"model": "m"}"#).await, "");
    assert_eq!(at(r#"{"model": 7, "maneuvers": []}"#).await, "/model");
    assert_eq!(
        at(r#"{"model": "m", "maneuvers": [{"id": 7}]}"#).await,
        "/maneuvers/0/id"
    );
    assert_eq!(
        at(r#"{"model": "m", "maneuvers": [], "optoins": {}}"#).await,
        "/optoins"
    );
    let number = r#"{"model": "m", "maneuvers": [], "options": {"method": 5}}"#;
    assert_eq!(at(number).await, "/options/method");
    let closed = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
    let deep = format!(r#"{{"model": "m", "maneuvers": [], "options": {{"method": {closed}}}}}"#);
    assert_eq!(at(&deep).await, "/options/method");
    let model = r#"{"model": {"name": "m", "states": {"a/b": {"initial": 0, "derivative": "0"}}}, "maneuvers": []}"#;
    assert_eq!(at(model).await, "/model/states/a~1b/initial");
}

#[tokio::test]
async fn what_is_no_json_is_said_to_be_none() {
    let server = Server::start().await;
    let deep = "[".repeat(100_000);
    let nested = format!(r#"{{"model": "m", "maneuvers": [], "options": {{"method": {deep}"#);
    let two_documents = r#"{"model": "m", "maneuvers": []} {}"#;
    for body in ["", "{", r#"{"model": nope}"#, two_documents, &nested] {
        let answer = server
            .post("/v1/jobs", "application/json", body.to_string())
            .await;
        assert_eq!(answer.problem(400, "invalid_json"), [], "{body:.80}");
    }
    let models = "{\"model\": ".repeat(50_000);
    let answer = server.post("/v1/jobs", "application/json", models).await;
    assert_eq!(answer.problem(422, "wrong_shape")[0].0, "/model/model");
    let truncated = b"{\"model\": \"\xe2\x82".to_vec();
    let answer = server.post("/v1/jobs", "application/json", truncated).await;
    assert_eq!(answer.problem(400, "invalid_json"), []);
    let answer = server.post("/v1/jobs", "text/plain", "{}").await;
    assert_eq!(answer.problem(415, "unsupported_media_type"), []);
    let config = Config {
        max_json_body: 1000,
        ..Config::default()
    };
    let small = Server::start_with(config, 0).await;
    let answer = small
        .post("/v1/jobs", "application/json", " ".repeat(1001))
        .await;
    assert_eq!(answer.problem(413, "body_too_large"), []);
    let detail = answer.json()["detail"].as_str().unwrap().to_string();
    assert!(
        detail.contains("1000") && detail.contains("--max-json-body"),
        "{detail}"
    );
}

#[tokio::test]
async fn a_start_that_leads_nowhere_fails_with_its_reason() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let mut spec = job(&maneuver);
    spec["parameters"] = json!({"Ma": {"start": 1e9}, "Za": {"start": 1e9}});
    spec["options"] = json!({"start": {"kind": "document"}});
    let id = server.submit(&spec).await;
    let done = server.wait(&id).await;
    assert_eq!(done["status"], "failed", "{done:#}");
    assert_eq!(done["faults"][0]["code"], "diverged_at_start");
    assert_eq!(done["has_result"], false);
    let faults = server
        .get(&format!("/v1/jobs/{id}/estimate"))
        .await
        .problem(404, "no_result");
    assert_eq!(faults[0].1, "diverged_at_start");
}

#[tokio::test]
async fn lists_are_filtered_and_paged() {
    let server = Server::start_with(Config::default(), 0).await;
    let maneuver = server.upload(&elevator()).await;
    let mut ids = Vec::new();
    for number in 0..5 {
        let mut spec = job(&maneuver);
        spec["tags"] = json!([if number % 2 == 0 { "even" } else { "odd" }, "all"]);
        spec["name"] = json!(format!("number {number}"));
        ids.push(server.submit(&spec).await);
    }
    server
        .post(&format!("/v1/jobs/{}/cancel", ids[0]), "text/plain", "")
        .await;
    let listed = async |query: &str| {
        let mut seen = Vec::new();
        let mut cursor = String::new();
        loop {
            let page = server
                .get(&format!("/v1/jobs?limit=2{query}{cursor}"))
                .await
                .json();
            let jobs = page["jobs"].as_array().unwrap();
            seen.extend(
                jobs.iter()
                    .map(|job| job["id"].as_str().unwrap().to_string()),
            );
            match page["next_cursor"].as_str() {
                Some(next) => cursor = format!("&cursor={next}"),
                None => return seen,
            }
        }
    };
    let newest_first: Vec<String> = ids.iter().rev().cloned().collect();
    assert_eq!(listed("").await, newest_first);
    assert_eq!(listed("&tag=all&kind=estimate").await, newest_first);
    assert_eq!(listed("&tag=odd").await, [ids[3].clone(), ids[1].clone()]);
    assert_eq!(listed("&status=cancelled").await, [ids[0].clone()]);
    assert_eq!(
        listed("&status=queued&tag=even").await,
        [ids[4].clone(), ids[2].clone()]
    );
    assert_eq!(
        server
            .get("/v1/jobs?cursor=nonsense")
            .await
            .problem(400, "invalid_cursor"),
        []
    );
    for query in ["limit=0", "limit=201", "limit=x", "status=done", "tags=x"] {
        assert_eq!(
            server
                .get(&format!("/v1/jobs?{query}"))
                .await
                .problem(400, "invalid_query"),
            []
        );
    }
}

#[tokio::test]
async fn two_clients_at_once_get_their_own_answers() {
    let server = Server::start().await;
    let fit = async |seed: u64| {
        let maneuver = server.upload(&elevator_of(20.0 + seed as f64, seed)).await;
        let mut spec = job(&maneuver);
        spec["tags"] = json!([format!("client {seed}")]);
        let id = server.submit(&spec).await;
        let done = server.wait(&id).await;
        assert_eq!(done["status"], "succeeded", "{done:#}");
        let estimate = server.get(&format!("/v1/jobs/{id}/estimate")).await.json();
        assert_eq!(estimate["samples"], 501 + 25 * seed);
    };
    tokio::join!(fit(1), fit(2), fit(3), fit(4), fit(5), fit(6));
}

#[tokio::test]
async fn a_validation_maneuver_has_its_prediction_and_its_histories() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let mut spec = job(&maneuver);
    spec["maneuvers"] = json!([
        {"id": maneuver, "label": "fitted", "rows": [1, 400]},
        {"id": maneuver, "label": "predicted", "rows": [100, 626], "role": "validation"},
    ]);
    let id = server.submit(&spec).await;
    let done = server.wait(&id).await;
    assert_eq!(done["status"], "succeeded", "{done:#}");
    let estimate = server.get(&format!("/v1/jobs/{id}/estimate")).await.json();
    assert_eq!(estimate["samples"], 400);
    let prediction = &estimate["prediction"][0];
    assert_eq!(
        (&prediction["segment"], &prediction["samples"]),
        (&json!("predicted"), &json!(527))
    );
    assert!(prediction["outputs"][0]["theil_shares"]["covariance"].is_number());
    for endpoint in ["time-histories", "residuals"] {
        let segments = server
            .get(&format!("/v1/jobs/{id}/{endpoint}"))
            .await
            .json();
        let roles = [
            &segments["segments"][0]["role"],
            &segments["segments"][1]["role"],
        ];
        assert_eq!(roles, [&json!("estimation"), &json!("validation")]);
    }
    let page = server.get(&format!("/jobs/{id}")).await.text();
    assert!(page.contains("Prediction of predicted"), "{page}");
}
