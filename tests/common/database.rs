//! Databases of a test's own: a file, or a database on the PostgreSQL that `tests/postgres` has started.

use sqlx::{AssertSqlSafe, Connection, PgConnection};
use tempfile::TempDir;
use uuid::Uuid;

/// It is gone with the test, or with the server that `tests/postgres` ends.
pub(crate) struct Database {
    /// As an operator would give it.
    pub address: String,
    _directory: Option<TempDir>,
}

impl Database {
    pub(crate) fn file() -> Self {
        let directory = TempDir::new().expect("a directory");
        let path = directory.path().join("test.db");
        Self {
            address: path.to_str().expect("UTF-8").to_string(),
            _directory: Some(directory),
        }
    }

    /// `None`, said loudly, where there is no PostgreSQL; with TRIMTAB_REQUIRE_POSTGRES that is a failure.
    pub(crate) async fn postgres(test: &str) -> Option<Self> {
        let Ok(server) = std::env::var("TRIMTAB_TEST_POSTGRES") else {
            let required = std::env::var_os("TRIMTAB_REQUIRE_POSTGRES").is_some();
            assert!(!required, "TRIMTAB_TEST_POSTGRES is not set");
            eprintln!(
                "SKIPPED {test}: there is no PostgreSQL; run it by tests/postgres cargo test"
            );
            return None;
        };
        let name = format!("trimtab_{}", Uuid::now_v7().simple());
        let mut connection = PgConnection::connect(&server)
            .await
            .expect("the PostgreSQL");
        sqlx::raw_sql(AssertSqlSafe(format!("CREATE DATABASE {name}")))
            .execute(&mut connection)
            .await
            .expect("a database");
        let (scheme, rest) = server
            .split_once("///")
            .expect("postgres:///DATABASE?host=...");
        let (_, parameters) = rest.split_once('?').expect("a socket");
        Some(Self {
            address: format!("{scheme}///{name}?{parameters}"),
            _directory: None,
        })
    }
}
