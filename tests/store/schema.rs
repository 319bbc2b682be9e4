//! Databases of earlier and of later versions.

use std::time::Duration;

use crate::bench::{Bench, on_both};
use trimtab::model::ModelDocument;
use trimtab::store::{DEFAULT_PROJECT, JobFilter, ManeuverFilter, Once, Search, Store};

on_both! {
    a_later_schema_is_refused_not_damaged,
    processes_that_start_at_once_do_not_disturb_each_other,
}

async fn a_later_schema_is_refused_not_damaged(bench: Bench) {
    let pool = sqlx::AnyPool::connect(&bench.url()).await.unwrap();
    sqlx::query("INSERT INTO schema_steps (version, applied) VALUES (999, 'later')")
        .execute(&pool)
        .await
        .unwrap();
    let refused = Store::open(&bench.database.address)
        .await
        .err()
        .expect("refused");
    assert!(refused.to_string().contains("later version"), "{refused}");
}

async fn processes_that_start_at_once_do_not_disturb_each_other(bench: Bench) {
    let stores = futures_util::future::join_all((0..4).map(|_| bench.other())).await;
    bench.submit("job").await;
    assert!(stores[3].claim("w").await.unwrap().is_some());
}

/// A database as the first `version` steps have made it, in a file.
async fn database_of(version: usize, file: &str) -> sqlx::AnyPool {
    const STEPS: [&str; 7] = [
        include_str!("../../src/store/migrations/0001_first.sql"),
        include_str!("../../src/store/migrations/0002_many_machines.sql"),
        include_str!("../../src/store/migrations/0003_answers.sql"),
        include_str!("../../src/store/migrations/0004_projects.sql"),
        include_str!("../../src/store/migrations/0005_tallies.sql"),
        include_str!("../../src/store/migrations/0006_webhooks.sql"),
        include_str!("../../src/store/migrations/0007_mappings.sql"),
    ];
    sqlx::any::install_default_drivers();
    let url = format!("sqlite://{file}?mode=rwc");
    let pool = sqlx::AnyPool::connect(&url).await.unwrap();
    let table =
        "CREATE TABLE schema_steps (version BIGINT PRIMARY KEY NOT NULL, applied TEXT NOT NULL)";
    sqlx::raw_sql(table).execute(&pool).await.unwrap();
    for (number, step) in (1..).zip(&STEPS[..version]) {
        sqlx::raw_sql(*step).execute(&pool).await.unwrap();
        sqlx::query("INSERT INTO schema_steps VALUES ($1, '')")
            .bind(number)
            .execute(&pool)
            .await
            .unwrap();
    }
    pool
}

/// A key that was to expire is not replaced by one that never does, though nobody had written down for how long it was meant.
#[tokio::test]
async fn a_key_from_before_lifetimes_were_kept_has_the_one_it_had() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("old.db");
    let file = file.to_str().unwrap();
    let pool = database_of(7, file).await;
    let [ending, lasting] = [1, 2].map(|n| format!("01950000-0000-7000-8000-00000000000{n}"));
    for (id, expires) in [
        (&ending, Some("2120-01-01T00:00:00.000Z")),
        (&lasting, None),
    ] {
        sqlx::query(
            "INSERT INTO keys (id, project, name, digest, scopes, max_priority, created, expires) \
             VALUES ($1, 'default', 'n', $1, '[\"read\"]', 0, '2020-01-01T00:00:00.000Z', $2)",
        )
        .bind(id)
        .bind(expires)
        .execute(&pool)
        .await
        .unwrap();
    }
    pool.close().await;

    let store = Store::open(file).await.unwrap();
    for (id, expires) in [(ending, true), (lasting, false)] {
        let id = id.parse().unwrap();
        let rotated = store.rotate_key(None, id, Duration::from_secs(3600)).await;
        let (key, _) = rotated.unwrap().expect("a good key");
        assert_eq!(key.expires.is_some(), expires, "{key:?}");
    }
}

/// What a database of an earlier version has is the default project's, whole.
#[tokio::test]
async fn a_database_from_before_there_were_projects_is_carried_over() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("old.db");
    let address = file.to_str().unwrap();
    let pool = database_of(3, address).await;
    let rows = "INSERT INTO maneuvers VALUES ('m', 'run 1', '2026-11-21T12:00:00.000Z', '{}', X'0102'); \
         INSERT INTO models VALUES ('01950000-0000-7000-8000-000000000001', 'n', 't', '2026-11-21T12:00:00.000Z', '{\"name\": \"n\"}'); \
         INSERT INTO answers VALUES ('k', 'r', '01950000-0000-7000-8000-000000000002', '9999', NULL, NULL)";
    sqlx::raw_sql(rows).execute(&pool).await.unwrap();
    let spec = r#"{"model": "short-period", "maneuvers": [{"id": "m"}]}"#;
    let model = serde_json::to_string(&ModelDocument::default()).unwrap();
    sqlx::query(
        "INSERT INTO jobs (id, kind, name, tags, status, created, last_seq, attempt, lost, spec, model) \
         VALUES ('01950000-0000-7000-8000-000000000003', 'estimate', 'old', '[]', 'queued', '2026-11-21T12:00:00.000Z', 0, 0, 0, $1, $2)",
    )
    .bind(spec)
    .bind(model)
    .execute(&pool)
    .await
    .unwrap();
    pool.close().await;

    let store = Store::open(address).await.unwrap();
    let project = store.project(DEFAULT_PROJECT, "");
    assert_eq!(project.maneuver("m").await.unwrap().unwrap().name, "run 1");
    assert_eq!(project.stored_bytes().await.unwrap(), 2);
    // it is found by its words, and called by what it is about
    let filter = JobFilter {
        search: Search::of("RUN old"),
        ..JobFilter::default()
    };
    let found = project.jobs(&filter, None, 9).await.unwrap().unwrap();
    assert_eq!(found.entries[0].about.maneuvers[0].label, "run 1");
    let filter = ManeuverFilter {
        search: Search::of("Run"),
        ..ManeuverFilter::default()
    };
    let found = project.maneuvers(&filter, None, 9).await.unwrap().unwrap();
    assert_eq!(found.entries[0].id, "m");
    let found = project.models(&Search::of("n T"), None, 9).await.unwrap();
    assert_eq!(found.entries.len(), 1);
    let model = "01950000-0000-7000-8000-000000000001".parse().unwrap();
    assert!(project.model(model).await.unwrap().is_some());
    let once = project.take_in_hand("k", "r").await.unwrap();
    assert_eq!(once, Once::InHand);
    let claim = store.claim("w").await.unwrap().expect("the old job");
    assert_eq!(
        (claim.project.as_str(), claim.spec.maneuvers[0].id.as_str()),
        (DEFAULT_PROJECT, "m")
    );
}
