//! Who may do what: keys, scopes, projects.

use std::time::Duration;

use crate::common::jobs::job;
use crate::common::recordings::elevator;
use crate::common::server::{Answer, Server, send};
use reqwest::Method;
use serde_json::{Value, json};
use trimtab::http::Config;
use trimtab::store::{NewKey, Scope};

/// A key made where the database is; its secret.
async fn key(server: &Server, project: &str, scopes: &[Scope]) -> String {
    made(server, project, scopes, None).await.1
}

async fn made(
    server: &Server,
    project: &str,
    scopes: &[Scope],
    lifetime: Option<Duration>,
) -> (uuid::Uuid, String) {
    let new = NewKey {
        project: project.into(),
        name: "test".into(),
        scopes: scopes.iter().copied().collect(),
        max_priority: 3,
        lifetime,
    };
    let (record, key) = server.store.add_key(&new).await.unwrap();
    (record.id, key.reveal().to_string())
}

async fn ask(server: &Server, method: Method, path: &str, key: &str, body: &Value) -> Answer {
    let mut request = server.request(method.clone(), path);
    if !key.is_empty() {
        request = request.bearer_auth(key);
    }
    if method == Method::POST || method == Method::PATCH {
        request = request
            .header("content-type", "application/json")
            .body(body.to_string());
    }
    send(request).await
}

async fn get(server: &Server, path: &str, key: &str) -> Answer {
    ask(server, Method::GET, path, key, &Value::Null).await
}

/// The scope that each operation needs, by its id in the OpenAPI document; an operation that is not here fails the test.
const NEEDED: &[(&str, &[&str])] = &[
    ("nothing", &["live", "ready", "listProblems", "getProblem"]),
    (
        "read",
        &[
            "listManeuvers",
            "listMappings",
            "getMapping",
            "getManeuver",
            "getManeuverData",
            "proposeSegments",
            "getFrequencyResponses",
            "listModels",
            "getModel",
            "listJobs",
            "getJob",
            "getJobSpec",
            "listEvents",
            "listIterations",
            "getEstimate",
            "getParameters",
            "getEstimatedModel",
            "getDerivativeStudy",
            "getDiagnosis",
            "getStructure",
            "getCoefficients",
            "getResiduals",
            "getTimeHistories",
            "getTrajectories",
            "getLinearSystem",
            "getFrequencyResponse",
            "getFlyingQualities",
            "predictManeuvers",
            "simulate",
            "trimModel",
            "trimJob",
            "designManeuvers",
            "getSourceCode",
            "getSimulatorModel",
            "getCampaign",
            "compareJobs",
            "getResidualAnalysis",
            "getProvenance",
        ],
    ),
    (
        "submit",
        &[
            "uploadManeuver",
            "uploadFile",
            "updateManeuver",
            "addMapping",
            "addModel",
            "submitJob",
            "submitJobs",
            "rerunJob",
            "correctManeuvers",
            "cancelJob",
        ],
    ),
    (
        "admin",
        &[
            "listAudit",
            "listKeys",
            "makeKey",
            "revokeKey",
            "rotateKey",
            "deleteJob",
            "deleteManeuver",
            "deleteModel",
            "expire",
            "deleteMapping",
            "listWebhooks",
            "addWebhook",
            "deleteWebhook",
            "rotateWebhook",
            "testWebhook",
            "listDeliveries",
        ],
    ),
    ("metrics", &["getMetrics"]),
];

#[tokio::test]
async fn every_operation_is_open_to_whom_it_should_be_and_to_nobody_else() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let done = server.submit(&job(&maneuver)).await;
    server.wait(&done).await;
    let order = json!({"url": "https://example.org/hook"});
    let webhook = server.post_json("/v1/webhooks", &order).await.json();
    let webhook = webhook["id"].as_str().unwrap().to_string();
    let mapping = json!({"time": {"step": 0.1, "unit": "s"}, "channels": {"q": {"from": "q", "unit": "deg/s"}}});
    let kept = server.post_json("/v1/mappings?name=logger", &mapping).await;
    assert_eq!(kept.status, 201, "{}", kept.text());
    // from here on there are keys, and what was here is the default project's
    let all = Scope::ALL;
    let (spare, _) = made(&server, "default", &[Scope::Read], None).await;
    let (revoked, of_revoked) = made(&server, "default", &all, None).await;
    server.store.revoke_key(None, revoked).await.unwrap();
    let (_, of_expired) = made(&server, "default", &all, Some(Duration::ZERO)).await;
    let mut callers = vec![
        ("no key", String::new(), 401),
        ("an unknown key", format!("trimtab_{}", "0".repeat(64)), 401),
        ("a revoked key", of_revoked, 401),
        ("an expired key", of_expired, 401),
    ];
    for scope in all {
        callers.push((scope.name(), key(&server, "default", &[scope]).await, 403));
    }
    let stranger = key(&server, "another", &all).await;

    let document = server.get("/openapi.json").await.json();
    let mut seen = Vec::new();
    for (template, methods) in document["paths"].as_object().unwrap() {
        for (method, operation) in methods.as_object().unwrap() {
            let id = operation["operationId"].as_str().unwrap();
            let needed = NEEDED.iter().find(|(_, ids)| ids.contains(&id));
            let (needed, _) = needed.unwrap_or_else(|| panic!("{id} is not in the table"));
            seen.push(id.to_string());
            let method: Method = method.to_uppercase().parse().unwrap();
            let of = match template.split('/').nth(2).unwrap_or_default() {
                "jobs" => done.clone(),
                "maneuvers" => maneuver.clone(),
                "models" => "short-period".to_string(),
                "keys" => spare.to_string(),
                "webhooks" => webhook.clone(),
                "mappings" => "logger".to_string(),
                _ => "internal".to_string(),
            };
            let path = template.replace("{id}", &of).replace("{code}", &of);
            let body = json!({"a body": "of another shape"});
            for (who, key, refused) in &callers {
                let answer = ask(&server, method.clone(), &path, key, &body).await;
                let status = answer.status.as_u16();
                let cell = format!("{who}: {method} {path} ({id}) is answered {status}");
                if *needed == "nothing" || needed == who {
                    assert!(status != 401 && status != 403 && status < 500, "{cell}");
                } else {
                    assert_eq!(status, *refused, "{cell}");
                    let code = if status == 401 {
                        "key_needed"
                    } else {
                        "scope_missing"
                    };
                    assert_eq!(answer.problem(*refused, code), [], "{cell}");
                }
            }
            // whoever may do everything elsewhere finds nothing of it
            if template.contains("{id}")
                && !["models", "problems"]
                    .iter()
                    .any(|of| template.contains(of))
            {
                let body = match id {
                    "rotateKey" => json!({}),
                    "updateManeuver" => json!({"name": "mine"}),
                    _ => json!({"mass": 1.0}),
                };
                let answer = ask(&server, method.clone(), &path, &stranger, &body).await;
                // these read their bodies first
                let reads = [
                    "getCoefficients",
                    "predictManeuvers",
                    "getFrequencyResponses",
                    "trimJob",
                ];
                let is_hidden = answer.status == 404 || reads.contains(&id) && answer.status == 422;
                assert!(is_hidden, "{method} {path}: {}", answer.text());
            }
        }
    }
    let listed: usize = NEEDED.iter().map(|(_, ids)| ids.len()).sum();
    assert_eq!(seen.len(), listed, "{seen:?}");
    for list in ["jobs", "maneuvers"] {
        let page = get(&server, &format!("/v1/{list}"), &stranger).await.json();
        assert_eq!(page[list], json!([]));
    }
    let page = get(&server, "/v1/keys", &stranger).await.json();
    assert_eq!(page["keys"].as_array().unwrap().len(), 1);
}

#[tokio::test]
async fn pages_and_what_is_nowhere_are_closed_too() {
    let server = Server::start_with(Config::default(), 0).await;
    let id = server.submit(&job(&server.upload(&elevator()).await)).await;
    let reader = key(&server, "default", &[Scope::Read]).await;
    let page = format!("/jobs/{id}");
    let answer = get(&server, &page, "").await;
    answer.problem(401, "key_needed");
    assert!(answer.header("www-authenticate").starts_with("Basic "));
    let answer = get(&server, "/v1/jobs", "").await;
    assert!(answer.header("www-authenticate").starts_with("Bearer "));
    get(&server, "/no/such/route", "")
        .await
        .problem(401, "key_needed");
    get(&server, "/no/such/route", &reader)
        .await
        .problem(404, "unknown_route");
    assert_eq!(get(&server, &page, &reader).await.status, 200);
    // as a browser sends it
    let basic = server
        .request(Method::GET, &page)
        .basic_auth("", Some(&reader));
    assert_eq!(send(basic).await.status, 200);
    let unreadable = server
        .request(Method::GET, &page)
        .header("authorization", "Digest x");
    send(unreadable).await.problem(400, "invalid_header");
}

#[tokio::test]
async fn without_keys_only_this_machine_by_its_own_name_is_answered() {
    let server = Server::start_with(Config::default(), 0).await;
    let with_host =
        |host: &'static str| server.request(Method::GET, "/v1/jobs").header("host", host);
    assert_eq!(send(with_host("localhost")).await.status, 200);
    send(with_host("evil.example"))
        .await
        .problem(403, "unknown_host");
    let reader = key(&server, "default", &[Scope::Read]).await;
    let known = with_host("lab.example").bearer_auth(&reader);
    assert_eq!(send(known).await.status, 200);
}

#[tokio::test]
async fn keys_are_made_rotated_and_revoked_over_the_api() {
    let server = Server::start_with(Config::default(), 0).await;
    let admin = key(&server, "icing", &Scope::ALL).await;
    let order = json!({"name": "pipeline", "days": 30, "max_priority": 2});
    let answer = ask(&server, Method::POST, "/v1/keys", &admin, &order).await;
    assert_eq!(answer.status, 201, "{}", answer.text());
    assert_eq!(answer.header("cache-control"), "no-store");
    let made = answer.json();
    assert_eq!(made["project"], "icing");
    assert_eq!(made["scopes"], json!(["read", "submit"]));
    let secret = made["secret"].as_str().unwrap().to_string();
    assert_eq!(get(&server, "/v1/jobs", &secret).await.status, 200);
    get(&server, "/v1/keys", &secret)
        .await
        .problem(403, "scope_missing");
    let listed = get(&server, "/v1/keys", &admin).await.text();
    assert!(!listed.contains(&secret) && listed.contains("pipeline"));

    let wrong = json!({"name": "", "scopes": [], "days": 0, "max_priority": 4});
    let answer = ask(&server, Method::POST, "/v1/keys", &admin, &wrong).await;
    let faults = answer.problem(422, "invalid_key");
    let places: Vec<&str> = faults.iter().map(|(place, _)| place.as_str()).collect();
    assert_eq!(places, ["/name", "/scopes", "/days", "/max_priority"]);

    // an admin of a project is none of the service
    let only_admin = key(&server, "icing", &[Scope::Admin]).await;
    let order = json!({"name": "watcher", "scopes": ["metrics"]});
    let answer = ask(&server, Method::POST, "/v1/keys", &only_admin, &order).await;
    assert_eq!(
        answer.problem(422, "invalid_key"),
        [("/scopes".into(), "out_of_range".into())]
    );
    let answer = ask(&server, Method::POST, "/v1/keys", &admin, &order).await;
    assert_eq!(answer.status, 201, "{}", answer.text());

    let path = format!("/v1/keys/{}", made["id"].as_str().unwrap());
    let rotate = format!("{path}/rotate");
    let overlap = json!({"overlap_hours": 1});
    let next = ask(&server, Method::POST, &rotate, &admin, &overlap)
        .await
        .json();
    assert!(
        next["expires"].is_string(),
        "what replaces a key that expires does, too"
    );
    let next = next["secret"].as_str().unwrap();
    for both in [&secret, next] {
        assert_eq!(get(&server, "/v1/jobs", both).await.status, 200);
    }
    server.store.clock().advance(Duration::from_secs(3601));
    get(&server, "/v1/jobs", &secret)
        .await
        .problem(401, "key_needed");
    assert_eq!(get(&server, "/v1/jobs", next).await.status, 200);
    let revoked = ask(&server, Method::DELETE, &path, &admin, &Value::Null).await;
    assert!(revoked.json()["revoked"].is_string());
    ask(&server, Method::POST, &rotate, &admin, &json!({}))
        .await
        .problem(404, "unknown_key");
}

/// What would be kept for the repetition is a secret.
#[tokio::test]
async fn a_secret_is_not_kept_under_an_idempotency_key() {
    let server = Server::start_with(Config::default(), 0).await;
    let admin = key(&server, "default", &Scope::ALL).await;
    let make = async || {
        let request = server
            .request(Method::POST, "/v1/keys")
            .bearer_auth(&admin)
            .header("idempotency-key", "same")
            .header("content-type", "application/json")
            .body(json!({"name": "twice"}).to_string());
        let answer = send(request).await;
        assert_eq!(answer.status, 201, "{}", answer.text());
        answer.json()["secret"].as_str().map(ToString::to_string)
    };
    let (first, again) = (make().await.expect("a secret"), make().await);
    assert_eq!(again, None);
    server.store.close().await;
    for entry in std::fs::read_dir(server.directory.path()).unwrap() {
        let bytes = std::fs::read(entry.unwrap().path()).unwrap();
        for secret in [&first, &admin] {
            let found = bytes
                .windows(secret.len())
                .any(|part| part == secret.as_bytes());
            assert!(!found, "a secret is in the database");
        }
    }
}

#[tokio::test]
async fn a_priority_is_within_what_the_key_allows() {
    let server = Server::start_with(Config::default(), 0).await;
    let maneuver = server.upload(&elevator()).await;
    let mut spec = job(&maneuver);
    spec["priority"] = json!(10);
    assert_eq!(
        server.post_json("/v1/jobs", &spec).await.json()["priority"],
        10
    );
    let sender = key(&server, "default", &[Scope::Submit]).await;
    let answer = ask(&server, Method::POST, "/v1/jobs", &sender, &spec).await;
    assert_eq!(
        answer.problem(422, "invalid_job"),
        [("/priority".into(), "out_of_range".into())]
    );
    spec["priority"] = json!(3);
    let answer = ask(&server, Method::POST, "/v1/jobs", &sender, &spec).await;
    assert_eq!(answer.status, 202, "{}", answer.text());
}

#[tokio::test]
async fn jobs_are_listed_from_a_moment_on() {
    let server = Server::start_with(Config::default(), 0).await;
    let maneuver = server.upload(&elevator()).await;
    server.submit(&job(&maneuver)).await;
    server.store.clock().advance(Duration::from_secs(60));
    let second = server.submit(&job(&maneuver)).await;
    let created = server.get(&format!("/v1/jobs/{second}")).await.json();
    let moment: jiff::Timestamp = created["created"].as_str().unwrap().parse().unwrap();
    let before = moment - jiff::SignedDuration::from_secs(30);
    let page = server
        .get(&format!("/v1/jobs?created_after={before}"))
        .await
        .json();
    let ids: Vec<&str> = page["jobs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|job| job["id"].as_str().unwrap())
        .collect();
    assert_eq!(ids, [second]);
    server
        .get("/v1/jobs?created_after=yesterday")
        .await
        .problem(400, "invalid_query");
}

/// Pages of the sites that the operator named may use the service from a browser, and no others.
#[tokio::test]
async fn a_browser_is_let_in_from_where_the_operator_said() {
    let config = Config {
        origins: vec!["https://dashboards.lab".parse().unwrap()],
        ..Config::default()
    };
    let server = Server::start_with(config, 0).await;
    let preflight = async |origin: &'static str| {
        let request = server
            .request(Method::OPTIONS, "/v1/jobs")
            .header("origin", origin)
            .header("access-control-request-method", "POST")
            .header(
                "access-control-request-headers",
                "authorization,content-type",
            );
        let answer = send(request).await;
        answer.header("access-control-allow-origin").to_string()
    };
    assert_eq!(
        preflight("https://dashboards.lab").await,
        "https://dashboards.lab"
    );
    assert_eq!(preflight("https://evil.example").await, "");
    let post = async |origin: &'static str| {
        let request = server
            .request(Method::POST, "/v1/jobs")
            .header("origin", origin)
            .header("sec-fetch-site", "cross-site")
            .header("content-type", "application/json");
        send(request.body("{}")).await
    };
    post("https://dashboards.lab")
        .await
        .problem(422, "wrong_shape");
    post("https://evil.example")
        .await
        .problem(403, "cross_origin");
    let answer = server.get("/v1/jobs").await;
    let policy = answer.header("content-security-policy");
    assert!(policy.contains("default-src 'none'") && policy.contains("frame-ancestors 'none'"));
    assert_eq!(answer.header("x-content-type-options"), "nosniff");
    assert_eq!(answer.header("cache-control"), "private, no-cache");
}

/// Whoever may make keys got one that may do more than their own by replacing another's.
#[tokio::test]
async fn replacing_a_key_gives_nobody_more_than_making_one() {
    let server = Server::start_with(Config::default(), 0).await;
    let admin = key(&server, "default", &[Scope::Admin]).await;
    let (watcher, _) = made(&server, "default", &[Scope::Metrics], None).await;
    let higher = NewKey {
        project: "default".into(),
        name: "urgent".into(),
        scopes: [Scope::Submit].into(),
        max_priority: 9,
        lifetime: None,
    };
    let (urgent, _) = server.store.add_key(&higher).await.unwrap();
    let (equal, _) = made(&server, "default", &[Scope::Submit], None).await;
    let rotate = async |id: uuid::Uuid| {
        let path = format!("/v1/keys/{id}/rotate");
        ask(&server, Method::POST, &path, &admin, &json!({})).await
    };
    let fault = |place: &str| [(place.to_string(), "out_of_range".to_string())];
    let refused = rotate(watcher).await;
    assert_eq!(refused.problem(422, "invalid_key"), fault("/scopes"));
    let refused = rotate(urgent.id).await;
    assert_eq!(refused.problem(422, "invalid_key"), fault("/max_priority"));
    assert_eq!(rotate(equal).await.status, 201);
    // what was refused was not done
    let listed = server.store.keys(None).await.unwrap();
    assert_eq!(listed.len(), 5);
}

/// What was deleted, and who was let in, is told to who may do the same.
#[tokio::test]
async fn what_cannot_be_undone_is_written_down() {
    let server = Server::start_with(Config::default(), 0).await;
    let maneuver = server.upload(&elevator()).await;
    let (id, admin) = made(&server, "default", &[Scope::Admin], None).await;
    let reader = key(&server, "default", &[Scope::Read, Scope::Submit]).await;
    let stranger = key(&server, "another", &[Scope::Admin]).await;
    let order = json!({"name": "pipeline"});
    let key = ask(&server, Method::POST, "/v1/keys", &admin, &order)
        .await
        .json();
    let path = format!("/v1/keys/{}", key["id"].as_str().unwrap());
    let rotate = format!("{path}/rotate");
    ask(&server, Method::POST, &rotate, &admin, &json!({})).await;
    for _ in 0..2 {
        ask(&server, Method::DELETE, &path, &admin, &Value::Null).await;
    }
    let hook = json!({"url": "https://example.org/hook"});
    let hook = ask(&server, Method::POST, "/v1/webhooks", &admin, &hook)
        .await
        .json();
    let hook = format!("/v1/webhooks/{}", hook["id"].as_str().unwrap());
    ask(&server, Method::DELETE, &hook, &admin, &Value::Null).await;
    let gone = format!("/v1/maneuvers/{maneuver}");
    ask(&server, Method::DELETE, &gone, &admin, &Value::Null).await;
    // what is refused is not done
    ask(&server, Method::DELETE, &gone, &admin, &Value::Null).await;
    ask(&server, Method::DELETE, &gone, &reader, &Value::Null).await;
    let old = json!({"older_than_days": 30});
    ask(&server, Method::POST, "/v1/retention", &admin, &old).await;

    get(&server, "/v1/audit", &reader)
        .await
        .problem(403, "scope_missing");
    let mut lines = Vec::new();
    let mut path = "/v1/audit?limit=3".to_string();
    loop {
        let page = get(&server, &path, &admin).await;
        assert!(!page.text().contains("trimtab_"), "no secret");
        let page = page.json();
        lines.extend(page["lines"].as_array().unwrap().clone());
        let Some(cursor) = page["next_cursor"].as_str() else {
            break;
        };
        path = format!("/v1/audit?limit=3&cursor={cursor}");
    }
    let deeds: Vec<&str> = lines
        .iter()
        .rev()
        .map(|line| line["deed"].as_str().unwrap())
        .collect();
    let expected = [
        "key.made",
        "key.made",
        "key.made",
        "key.rotated",
        "key.revoked",
        "webhook.added",
        "webhook.deleted",
        "maneuver.deleted",
        "expired",
    ];
    assert_eq!(deeds, expected);
    let by = |line: &Value| line["key"].as_str().map(ToString::to_string);
    let by: Vec<Option<String>> = lines.iter().rev().map(by).collect();
    assert!(
        by[..2].iter().all(Option::is_none),
        "made where the database is"
    );
    assert!(by[2..].iter().all(|key| *key == Some(id.to_string())));
    let of_stranger = get(&server, "/v1/audit", &stranger).await.json();
    assert_eq!(
        of_stranger["lines"].as_array().unwrap().len(),
        1,
        "its own key"
    );
}
