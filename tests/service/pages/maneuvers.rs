//! Pages of maneuvers: what they say, and that nothing of a stranger becomes markup.

use crate::common::server::{Server, send};
use reqwest::{Method, Url};
use serde_json::json;
use trimtab::http::Config;

const SMALL: &str = "t[s],alpha[deg],q[deg/s]\n0,1.5,2\n0.1,,3\n0.2,2.5,4\n0.3,2.5,5\n";

/// An address with a query, as the tests' server is asked for it.
fn address(path: &str, query: &[(&str, &str)]) -> String {
    let url = Url::parse_with_params(&format!("http://x{path}"), query).unwrap();
    format!("{path}?{}", url.query().unwrap())
}

async fn page(server: &Server, path: &str) -> String {
    let answer = server.get(path).await;
    assert_eq!(answer.status, 200, "{}", answer.text());
    assert!(answer.header("content-type").starts_with("text/html"));
    answer.text()
}

#[tokio::test]
async fn maneuvers_are_listed_and_can_be_chosen() {
    let server = Server::start_with(Config::default(), 0).await;
    let empty = page(&server, "/maneuvers").await;
    assert!(empty.contains("Nothing is recorded here yet"));
    for part in [
        r#"type="file""#,
        r#"value="sidpac""#,
        r#"data-shown="deg/s""#,
        r#"src="/assets/maneuvers.js""#,
    ] {
        assert!(empty.contains(part), "{part}");
    }
    let hostile = "<script>alert('x')</script> & \"quoted\"";
    let upload = address("/v1/maneuvers", &[("name", hostile)]);
    let stored = server.post(&upload, "text/csv", SMALL).await.json();
    let id = stored["id"].as_str().unwrap();
    let list = page(&server, "/maneuvers").await;
    assert!(list.contains(&format!(r#"name="estimation" value="{id}""#)));
    assert!(list.contains(&format!(r#"href="/maneuvers/{id}""#)));
    assert!(list.contains("alpha, q"));
    assert!(!list.contains("<script>alert") && list.contains("&lt;script&gt;alert"));

    let one = page(&server, &format!("/maneuvers/{id}")).await;
    assert!(!one.contains("<script>alert") && one.contains("&lt;script&gt;alert"));
    let answer = server.get("/maneuvers?cursor=x").await;
    assert_eq!(answer.problem(400, "invalid_cursor"), []);
}

#[tokio::test]
async fn later_pages_are_reached() {
    let server = Server::start_with(Config::default(), 0).await;
    for number in 0..51 {
        server.upload(&format!("t[s],q\n0,{number}\n1,2\n")).await;
    }
    let rows = |page: &str| page.matches(r#"name="estimation""#).count();
    let first = page(&server, "/maneuvers").await;
    assert_eq!(rows(&first), 50);
    let (_, behind) = first.split_once(r#"href="/maneuvers?cursor="#).unwrap();
    let cursor = behind.split('"').next().unwrap();
    let second = page(&server, &format!("/maneuvers?cursor={cursor}")).await;
    assert_eq!(rows(&second), 1);
    // a search goes on where there is more of it
    let other = address("/v1/maneuvers", &[("name", "Ä & other")]);
    server.post(&other, "text/csv", SMALL).await;
    let found = page(&server, "/maneuvers?q=%C3%A4+%26").await;
    assert!(
        rows(&found) == 1 && found.contains("value=\"ä &amp;\""),
        "{found}"
    );
    let none = page(&server, "/maneuvers?q=nothing").await;
    assert!(rows(&none) == 0 && none.contains("No maneuver matches"));
}

#[tokio::test]
async fn a_maneuver_is_told_in_numbers_and_findings() {
    let server = Server::start_with(Config::default(), 0).await;
    let id = server.upload(SMALL).await;
    let text = page(&server, &format!("/maneuvers/{id}")).await;
    for part in [
        r#"data-samples="4""#,
        "4 at 10.000 Hz",
        // degrees, as they were recorded
        "<td>deg/s</td>",
        r#"<td class="number">2.5000</td>"#,
        "missing",
        &format!(r#"href="/new?estimation={id}""#),
        &format!(r#"href="/v1/maneuvers/{id}/data?format=csv""#),
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let summary = server.get(&format!("/v1/maneuvers/{id}")).await.json();
    let finding = summary["summary"]["findings"][0]["message"].as_str();
    assert!(text.contains(finding.unwrap()), "{finding:?}");
    for unknown in ["/maneuvers/abc", "/maneuvers/%3Cscript%3E"] {
        let answer = server.get(unknown).await;
        assert_eq!(answer.problem(404, "unknown_maneuver"), []);
    }
    let gone = send(server.request(Method::DELETE, &format!("/v1/maneuvers/{id}"))).await;
    assert_eq!(gone.status, 204);
    let answer = server.get(&format!("/maneuvers/{id}")).await;
    assert_eq!(answer.status, 404);
}

/// What the page of uploads makes of corrections.
#[tokio::test]
async fn a_mapping_corrects_the_columns_of_a_csv_file() {
    let server = Server::start_with(Config::default(), 0).await;
    let recorded =
        "Zeit,angle of attack[rad],q,mode\n0,1.5,2,on\n100,,3,off\n200,2.5,4,on\n300,2.5,5,on\n";
    let refused = server.post("/v1/maneuvers", "text/csv", recorded).await;
    refused.problem(422, "invalid_maneuver");
    let mapping = json!({
        "time": {"from": "Zeit", "unit": "ms"},
        "channels": {
            "alpha": {"from": "(:,2)", "unit": "deg"},
            "q": {"from": "q", "unit": "deg/s"},
        },
    });
    let with = |mapping: &str| address("/v1/maneuvers", &[("mapping", mapping)]);
    let corrected = server
        .post(&with(&mapping.to_string()), "text/csv", recorded)
        .await;
    assert_eq!(corrected.status, 201, "{}", corrected.text());
    assert_eq!(corrected.json()["id"], server.upload(SMALL).await);

    let kept = server.post_json("/v1/mappings?name=logger", &mapping).await;
    assert_eq!(kept.status, 201);
    let named = server.post(&with("logger"), "text/csv", recorded).await;
    assert_eq!(named.status, 200, "{}", named.text());
    let listed = page(&server, "/maneuvers").await;
    assert!(listed.contains(r#"<option value="logger""#));

    let other = server.post(&with("logger"), "text/csv", SMALL).await;
    let faults = other.problem(422, "invalid_maneuver");
    let unknown = ("/time/from".to_string(), "unknown_source".to_string());
    assert_eq!(faults[0], unknown);
}
