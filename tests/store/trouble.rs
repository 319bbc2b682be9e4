//! Databases that do not do what they should: locked, not to be written, and no databases at all.

use std::time::{Duration, Instant};

use sqlx::{AnyConnection, Connection, Executor};
use trimtab::store::{Store, Trouble};

/// A directory and the path of a database in it.
fn place() -> (tempfile::TempDir, String) {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("trimtab.db");
    let file = file.to_str().unwrap().to_string();
    (directory, file)
}

/// At the start it is said at once which file is at fault, and in what way; "pool timed out" after 10 s was said.
#[tokio::test]
async fn a_file_that_is_no_database_is_named_at_once() {
    let (_directory, file) = place();
    std::fs::write(&file, "time,alpha\n".repeat(1000)).unwrap();
    let start = Instant::now();
    let refused = Store::open(&file).await.err().expect("refused").to_string();
    assert!(refused.contains(&file), "{refused}");
    assert!(refused.contains("not a database"), "{refused}");
    assert!(start.elapsed() < Duration::from_secs(5), "{refused}");
}

/// Another process that holds the file is trouble that may pass: it is not a defect, and what waits for it goes on.
#[tokio::test]
async fn a_locked_database_is_away_and_then_there_again() {
    let (_directory, file) = place();
    let store = Store::open(&file).await.unwrap();
    let mut other = AnyConnection::connect(&format!("sqlite://{file}"))
        .await
        .unwrap();
    other.execute("BEGIN IMMEDIATE").await.unwrap();
    let start = Instant::now();
    let locked = store.ping().await.expect_err("it cannot be written");
    assert_eq!(locked.trouble(), Some(Trouble::Away), "{locked}");
    assert!(start.elapsed() < Duration::from_secs(5));
    other.execute("ROLLBACK").await.unwrap();
    // the statement that was given up may still be waiting for the lock
    let mut tries = 0;
    while let Err(error) = store.ping().await {
        tries += 1;
        assert!(tries < 5, "{error}");
    }
}
