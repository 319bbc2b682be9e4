//! What was flown: said of recordings over HTTP and on the command line, and used by jobs.

use std::process::Command;

use crate::common::recordings::{elevator, elevator_of};
use crate::common::server::{Answer, Server, send};
use reqwest::Method;
use serde_json::{Value, json};
use trimtab::http::Config;

pub(crate) async fn patch(server: &Server, id: &str, change: &Value) -> Answer {
    let request = server.request(Method::PATCH, &format!("/v1/maneuvers/{id}"));
    send(
        request
            .header("content-type", "application/merge-patch+json")
            .body(change.to_string()),
    )
    .await
}

fn attas() -> Value {
    json!({"flown": {
        "aircraft": "VFW 614", "registration": "D-ADAM", "date": "2026-11-21", "gear": "up",
        "mass": {"value": 38801.0, "unit": "lb"},
        "inertia": {"Iy": {"value": 320000.0, "unit": "kg*m^2"}},
        "quantities": {"wing_area": {"value": 64.0, "unit": "m^2"}},
        "tags": ["campaign 3"],
    }})
}

#[tokio::test]
async fn what_was_flown_is_said_changed_and_found_by() {
    let server = Server::start_with(Config::default(), 0).await;
    let id = server.upload(&elevator()).await;
    let before = server.get(&format!("/v1/maneuvers/{id}")).await.json();
    assert_eq!(before["flown"], json!({}));
    let said = patch(&server, &id, &attas()).await;
    assert_eq!(said.status, 200, "{}", said.text());
    let after = said.json();
    assert_eq!(after["flown"], attas()["flown"]);
    assert_eq!(
        (&after["id"], &after["summary"]),
        (&before["id"], &before["summary"])
    );
    assert_eq!(
        server.get(&format!("/v1/maneuvers/{id}")).await.json(),
        after
    );
    let change = json!({"name": "run 1", "flown": {"gear": null, "flaps": "14 deg", "inertia": {"Iy": null, "Ix": {"value": 1, "unit": "kg*m^2"}}}});
    let changed = patch(&server, &id, &change).await.json();
    assert_eq!(changed["name"], "run 1");
    assert_eq!(changed["flown"]["gear"], Value::Null);
    assert_eq!(
        changed["flown"]["inertia"],
        json!({"Ix": {"value": 1.0, "unit": "kg*m^2"}})
    );
    assert_eq!(changed["flown"]["registration"], "D-ADAM");
    for (query, expected) in [
        ("tag=campaign%203", 1),
        ("registration=D-ADAM&aircraft=VFW%20614", 1),
        ("registration=D-ADAX", 0),
        ("flight=1", 0),
    ] {
        let listed = server.get(&format!("/v1/maneuvers?{query}")).await.json();
        assert_eq!(
            listed["maneuvers"].as_array().unwrap().len(),
            expected,
            "{query}"
        );
    }
    let page = server.get(&format!("/maneuvers/{id}")).await.text();
    assert!(
        page.contains("What was flown") && page.contains("D-ADAM") && page.contains("38801 lb"),
        "{page}"
    );
}

#[tokio::test]
async fn what_cannot_be_said_names_its_place() {
    let server = Server::start_with(Config::default(), 0).await;
    let id = server.upload(&elevator()).await;
    for (change, code, place) in [
        (
            json!({"flown": {"mass": {"value": 1, "unit": "m"}}}),
            "invalid_flown",
            "/flown/mass",
        ),
        (
            json!({"flown": {"mass": {"value": -1, "unit": "kg"}}}),
            "invalid_flown",
            "/flown/mass",
        ),
        (
            json!({"flown": {"date": "21.11.2026"}}),
            "invalid_flown",
            "/flown/date",
        ),
        (
            json!({"flown": {"tags": ["a", "a"]}}),
            "invalid_flown",
            "/flown/tags/1",
        ),
        (json!({"name": "n".repeat(201)}), "invalid_flown", "/name"),
        (
            json!({"flown": {"mass": 17600}}),
            "wrong_shape",
            "/flown/mass",
        ),
        (json!({"flown": {"wings": 2}}), "wrong_shape", "/flown"),
        (json!({"flow": {}}), "wrong_shape", ""),
    ] {
        let faults = patch(&server, &id, &change).await.problem(422, code);
        assert!(faults[0].0.starts_with(place), "{change}: {faults:?}");
    }
    assert_eq!(
        server.get(&format!("/v1/maneuvers/{id}")).await.json()["flown"],
        json!({})
    );
    patch(&server, "abc", &attas())
        .await
        .problem(404, "unknown_maneuver");
    let text = server.request(Method::PATCH, &format!("/v1/maneuvers/{id}"));
    send(text.header("content-type", "text/plain").body("{}"))
        .await
        .problem(415, "unsupported_media_type");
}

/// RFC 7396: a member that is `null` goes, one that is absent stays.
#[tokio::test]
async fn null_takes_away_and_an_empty_group_says_nothing() {
    let server = Server::start_with(Config::default(), 0).await;
    let id = server.upload(&elevator()).await;
    let flown = async |change: Value| {
        let changed = patch(&server, &id, &change).await;
        assert_eq!(changed.status, 200, "{}", changed.text());
        let changed = changed.json();
        (changed["name"].clone(), changed["flown"].clone())
    };
    let (name, said) = flown(json!({"name": "run 1", "flown": attas()["flown"]})).await;
    assert_eq!((&name, &said), (&json!("run 1"), &attas()["flown"]));
    assert_eq!(flown(json!({})).await, (name.clone(), said.clone()));
    assert_eq!(flown(json!({"flown": {}})).await, (name.clone(), said));
    let nothing = json!({});
    assert_eq!(flown(json!({"flown": null})).await, (name, nothing.clone()));
    let metre = json!({"value": 1.0, "unit": "m"});
    let x = json!({"flown": {"centre_of_gravity": {"x": metre}}});
    assert_eq!(flown(x.clone()).await.1, x["flown"]);
    // what is in a group may be changed, too
    let feet = json!({"flown": {"centre_of_gravity": {"x": {"unit": "ft"}}}});
    let expected = json!({"centre_of_gravity": {"x": {"value": 1.0, "unit": "ft"}}});
    assert_eq!(flown(feet).await.1, expected);
    for empty in [
        json!({"flown": {"centre_of_gravity": {"x": null}}}),
        json!({"flown": {"inertia": {"Iy": null}}}),
        json!({"flown": {"inertia": {}, "quantities": {}, "tags": []}}),
    ] {
        assert_eq!(flown(empty).await.1, nothing);
    }
    let (name, _) = flown(json!({"name": null})).await;
    assert_eq!(name, "");
}

#[tokio::test]
async fn a_change_of_what_was_changed_meanwhile_is_refused() {
    let server = Server::start_with(Config::default(), 0).await;
    let id = server.upload(&elevator()).await;
    let path = format!("/v1/maneuvers/{id}");
    let change = async |flight: &str, etag: &str| {
        let request = server.request(Method::PATCH, &path);
        let body = json!({"flown": {"flight": flight}}).to_string();
        let request = request
            .header("content-type", "application/json")
            .body(body);
        send(request.header("if-match", etag)).await
    };
    let etag = |answer: &Answer| answer.headers["etag"].to_str().unwrap().to_string();
    let first = etag(&server.get(&path).await);
    let changed = change("F1", &first).await;
    assert_eq!(changed.status, 200, "{}", changed.text());
    let second = etag(&changed);
    assert_ne!(first, second);
    assert_eq!(etag(&server.get(&path).await), second);
    for stale in [first.as_str(), "\"nonsense\"", "nonsense"] {
        let refused = change("F2", stale).await;
        refused.problem(412, "precondition_failed");
    }
    let flight = server.get(&path).await.json()["flown"]["flight"].clone();
    assert_eq!(flight, "F1");
    for good in [second.as_str(), "*"] {
        assert_eq!(change("F1", good).await.status, 200);
    }
}

/// Of many faults as many are told as a message can hold.
#[tokio::test]
async fn what_is_wrong_a_thousand_times_is_told_in_short() {
    let server = Server::start_with(Config::default(), 0).await;
    let id = server.upload(&elevator()).await;
    let many = (0..20_000).map(|k| (format!("k{k} "), json!({"value": 1.0, "unit": "warp"})));
    let many: serde_json::Map<String, Value> = many.collect();
    let refused = patch(&server, &id, &json!({"flown": {"quantities": many}})).await;
    let length = refused.text().len();
    assert!(length < 200_000, "{length} bytes");
    let faults = refused.problem(422, "invalid_flown");
    assert!(faults.iter().any(|(place, _)| place == "/flown/quantities"));
}

/// y = m a u, of which the job says that m is the recording's mass.
fn job(id: &str) -> Value {
    json!({
        "model": {
            "name": "of-mass", "inputs": {"de": {"unit": "rad"}},
            "constants": {"m": {"value": 1.0, "unit": "kg"}},
            "parameters": {"a": {"start": -1.0, "unit": "1/(kg*s)"}},
            "outputs": {"q": {"equation": "m*a*de", "unit": "rad/s"}},
        },
        "maneuvers": [{"id": id}],
        "constants": {"m": "recording.mass"},
    })
}

fn estimated(parameters: &Value) -> f64 {
    let rows = parameters["parameters"].as_array().unwrap();
    let row = rows.iter().find(|row| row["name"] == "a").unwrap();
    row["estimate"].as_f64().unwrap()
}

#[tokio::test]
async fn constants_of_a_job_come_from_its_recordings() {
    let server = Server::start_with(Config::default(), 1).await;
    let id = server.upload(&elevator()).await;
    let refused = server.post_json("/v1/jobs", &job(&id)).await;
    let told = refused.text();
    assert!(told.contains("PATCH /v1/maneuvers"), "{told}");
    let expected = ("/constants/m".to_string(), "unknown_quantity".to_string());
    assert_eq!(refused.problem(422, "invalid_job"), [expected]);
    let mut product = Vec::new();
    for (value, unit, kilograms) in [(2.0, "kg", 2.0), (5.0, "lb", 5.0 * 0.453_592_37)] {
        let change = json!({"flown": {"mass": {"value": value, "unit": unit}}});
        assert_eq!(patch(&server, &id, &change).await.status, 200);
        let number = server.submit(&job(&id)).await;
        server.wait(&number).await;
        let spec = server.get(&format!("/v1/jobs/{number}/spec")).await.json();
        assert_eq!(spec["constants"]["m"], "recording.mass");
        assert_eq!(
            spec["maneuvers"][0]["flown"]["mass"]["value"], value,
            "what was said then is kept"
        );
        let parameters = server
            .get(&format!("/v1/jobs/{number}/parameters"))
            .await
            .json();
        product.push(kilograms * estimated(&parameters));
    }
    predictions_take_the_mass_of_their_recordings(&server, &id).await;
    // the product of mass and a is what the data tell
    assert!(
        (product[0] - product[1]).abs() < 1e-9 * product[0].abs(),
        "{product:?}"
    );
    // what a maneuver says itself is not asked of its recording
    let without = server.upload(&elevator_of(20.0, 7)).await;
    let mut own = job(&id);
    own["maneuvers"] =
        json!([{"id": id, "constants": {"m": 2.0}}, {"id": without, "constants": {"m": 3.0}}]);
    let accepted = server.post_json("/v1/jobs", &own).await;
    assert_eq!(accepted.status, 202, "{}", accepted.text());
    own["maneuvers"][0]["constants"] = json!({});
    let accepted = server.post_json("/v1/jobs", &own).await;
    assert_eq!(accepted.status, 202, "{}", accepted.text());
    own["maneuvers"][1]["constants"] = json!({});
    let faults = server.post_json("/v1/jobs", &own).await;
    let expected = ("/constants/m".to_string(), "unknown_quantity".to_string());
    assert_eq!(faults.problem(422, "invalid_job"), [expected]);
    let change =
        json!({"flown": {"mass": null, "quantities": {"span": {"value": 2, "unit": "m"}}}});
    patch(&server, &id, &change).await;
    for (from, code) in [
        ("recording.mass", "invalid_job"),
        ("recording.quantities.span", "invalid_job"),
        ("mass", "invalid_job"),
    ] {
        let mut wrong = job(&id);
        wrong["constants"]["m"] = json!(from);
        let faults = server
            .post_json("/v1/jobs", &wrong)
            .await
            .problem(422, code);
        assert_eq!(faults[0].0, "/constants/m", "{faults:?}");
    }
}

/// The job's constant is the recording's mass, and so it is in predictions of other recordings: y = m a u by hand.
async fn predictions_take_the_mass_of_their_recordings(server: &Server, fitted: &str) {
    let number = server.submit(&job(fitted)).await;
    server.wait(&number).await;
    let parameters = server
        .get(&format!("/v1/jobs/{number}/parameters"))
        .await
        .json();
    let a = estimated(&parameters);
    let input = server
        .upload("t[s],de[rad]\n0,0.01\n0.1,0.02\n0.2,0.03\n")
        .await;
    let path = format!("/v1/jobs/{number}/predictions");
    let wanted = json!({"maneuvers": [{"id": input}], "names": ["q"]});
    let refused = server.post_json(&path, &wanted).await;
    let expected = (
        "/maneuvers/0/constants/m".to_string(),
        "unknown_quantity".to_string(),
    );
    assert_eq!(refused.problem(422, "invalid_prediction"), [expected]);
    let change = json!({"flown": {"mass": {"value": 7.0, "unit": "kg"}}});
    assert_eq!(patch(server, &input, &change).await.status, 200);
    let own = json!({"maneuvers": [{"id": input, "constants": {"m": 11.0}}], "names": ["q"]});
    for (wanted, mass) in [(&wanted, 7.0), (&own, 11.0)] {
        let answer = server.post_json(&path, wanted).await;
        assert_eq!(answer.status, 200, "{}", answer.text());
        let answer = answer.json();
        let values = answer["segments"][0]["quantities"][0]["values"].clone();
        for (value, de) in values
            .as_array()
            .expect("a list")
            .iter()
            .zip([0.01, 0.02, 0.03])
        {
            let value = value.as_f64().expect("a number");
            assert!(
                (value - mass * a * de).abs() < 1e-12,
                "{value} for {mass} kg"
            );
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn the_command_line_says_and_shows_it() {
    let server = Server::start_with(Config::default(), 0).await;
    let id = server.upload(&elevator()).await;
    let url = server.url.clone();
    let run = move |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trimtab"));
        let done = command
            .args(arguments)
            .args(["--server", url.as_str()])
            .output()
            .unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (done.status.success(), text(done.stdout), text(done.stderr))
    };
    let (is_done, shown, error) = run(&[
        "maneuver",
        "describe",
        &id,
        "--registration",
        "D-ADAM",
        "--tag",
        "campaign 3",
        "--set",
        "mass=38801[lb]",
        "--set",
        "cg.x=3.1[m]",
        "--set",
        "Iy=320000[kg*m^2]",
        "--set",
        "fuel=1200 kg",
    ]);
    assert!(is_done, "{error}");
    // names and values stand in two columns
    for (name, value) in [
        ("registration", "D-ADAM"),
        ("recording.mass", "38801 lb"),
        ("recording.centre_of_gravity.x", "3.1 m"),
        ("recording.quantities.fuel", "1200 kg"),
    ] {
        let width = "recording.centre_of_gravity.x".len() + 2;
        let line = format!("{name:<width$}{value}");
        assert!(shown.lines().any(|shown| shown == line), "{shown}");
    }
    let (is_done, _, _) = run(&[
        "maneuver",
        "describe",
        &id,
        "--clear",
        "mass",
        "--clear",
        "registration",
    ]);
    assert!(is_done);
    let (_, shown, _) = run(&["maneuver", "show", &id]);
    assert!(
        !shown.contains("mass") && !shown.contains("D-ADAM") && shown.contains("campaign 3"),
        "{shown}"
    );
    let (_, listed, _) = run(&["maneuver", "list", "--tag", "campaign 3"]);
    assert!(listed.contains(&id), "{listed}");
    let (_, listed, _) = run(&["maneuver", "list", "--tag", "other"]);
    assert!(!listed.contains(&id), "{listed}");
    let (is_done, _, error) = run(&["maneuver", "describe", &id, "--set", "mass=heavy"]);
    assert!(!is_done && error.contains("17600[kg]"), "{error}");
}
