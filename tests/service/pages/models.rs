//! The pages of models.

use crate::common::server::Server;
use serde_json::json;
use trimtab::http::Config;
use trimtab::model::catalog;

async fn server() -> Server {
    Server::start_with(Config::default(), 0).await
}

#[tokio::test]
async fn each_model_of_the_catalog_has_a_page_with_its_equations() {
    let server = server().await;
    let list = server.get("/models").await;
    assert_eq!(list.status, 200, "{}", list.text());
    for document in catalog::all() {
        let address = format!("/models/{}", document.name);
        assert!(list.text().contains(&format!("href=\"{address}\"")));
        let page = server.get(&address).await;
        assert_eq!(page.status, 200, "{}", page.text());
        assert!(page.text().contains("<math"), "{}", document.name);
        // an equation that cannot be typeset would stand as code
        assert_eq!(
            page.text().matches("<li><code>").count(),
            0,
            "{}",
            document.name
        );
    }
}

#[tokio::test]
async fn what_is_not_there_is_not_found() {
    let server = server().await;
    let nobody = "00000000-0000-7000-8000-000000000000";
    for address in [
        "/models/nope".to_string(),
        format!("/models/{nobody}"),
        "/models?from=nope".to_string(),
        "/models/short-period?against=nope".to_string(),
        format!("/models/short-period?against=job:{nobody}"),
        "/models/short-period?against=job:nope".to_string(),
    ] {
        let answer = server.get(&address).await;
        assert_eq!(answer.status, 404, "{address}: {}", answer.text());
    }
    assert_eq!(server.get("/models?cursor=x").await.status, 400);
}

#[tokio::test]
async fn a_comparison_shows_what_was_changed() {
    let server = server().await;
    let mut document = serde_json::to_value(catalog::find("short-period").unwrap()).unwrap();
    document["name"] = json!("<mine>");
    document["outputs"]["q"]["equation"] = json!("q_scale*q + q_bias");
    document["parameters"]["q_scale"] = json!({"start": 1.0, "unit": "-"});
    let stored = server.post_json("/v1/models", &document).await;
    assert_eq!(stored.status, 201, "{}", stored.text());
    let id = stored.json()["id"].as_str().unwrap().to_string();

    let page = server
        .get(&format!("/models/short-period?against={id}"))
        .await;
    assert_eq!(page.status, 200, "{}", page.text());
    let page = page.text();
    for expected in [
        "output q: equation",
        "parameter q_scale",
        "alttext=\"output q = q_scale*q + q_bias\"",
        "2 changed, 1 added, 0 removed.",
        "&lt;mine&gt;",
    ] {
        assert!(page.contains(expected), "{expected} is not in {page}");
    }
    assert!(!page.contains("<mine>"));

    let page = server.get(&format!("/models/{id}?against={id}")).await;
    assert!(page.text().contains("the two documents are the same"));
    let list = server.get(&format!("/models?from={id}")).await;
    assert!(list.text().contains("q_scale*q + q_bias"));
    let found = server.get("/models?q=%3CMINE").await.text();
    let tail = format!("<code title=\"{id}\">{}</code>", &id[id.len() - 8..]);
    assert!(
        found.contains(&tail) && !found.contains("\"/models/phugoid\""),
        "{found}"
    );
    // before the catalog's models are behind it, the list goes on
    let later = server.get("/models?cursor=six-degrees-of-freedom").await;
    assert!(later.text().contains(&id) && !later.text().contains("\"/models/phugoid\""));
}

#[tokio::test]
async fn a_model_is_compared_with_the_one_a_job_ended_with() {
    let server = Server::start().await;
    let maneuver = server.upload(&crate::common::recordings::elevator()).await;
    let spec = json!({"model": "short-period", "maneuvers": [{"id": maneuver}],
        "edits": [{"kind": "sensor_scale", "target": "q"}]});
    let job = server.submit(&spec).await;
    assert_eq!(server.wait(&job).await["status"], "succeeded");
    let page = server
        .get(&format!("/models/short-period?against=job:{job}"))
        .await;
    assert_eq!(page.status, 200, "{}", page.text());
    assert!(page.text().contains("output q: equation"));
    assert!(page.text().contains("as estimated in the job"));
}
