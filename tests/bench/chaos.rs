//! The chaos in full: `tests/postgres cargo bench --bench chaos [jobs] [kills] [sqlite|postgres]`.
//!
//! On PostgreSQL: three worker processes, one of which is killed (SIGKILL) every two seconds, 50 times, the server
//! restarted twice and the database, too. On SQLite: one process that serves and works, killed 50 times. What is promised is checked by
//! [`Chaos::run`]: each accepted job ends once, its events are all there and were seen once by who followed them.

#[path = "../common"]
#[allow(dead_code)] // the tests use the rest
mod common {
    pub(crate) mod chaos;
    pub(crate) mod database;
    pub(crate) mod jobs;
    pub(crate) mod process;
    pub(crate) mod recordings;
    pub(crate) mod server;
    pub(crate) mod sse;
}

use std::time::Duration;

use common::chaos::Chaos;
use common::database::Database;

#[tokio::main]
async fn main() {
    let mut numbers = std::env::args().filter_map(|argument| argument.parse().ok());
    let jobs = numbers.next().unwrap_or(1000);
    let kills = numbers.next().unwrap_or(50);
    let wanted = |engine: &str| {
        let mut words = std::env::args().filter(|word| ["sqlite", "postgres"].contains(&&**word));
        words.next().is_none_or(|word| word == engine)
    };
    if wanted("sqlite") {
        on_a_file(jobs, kills).await;
    }
    if wanted("postgres") {
        on_a_server(jobs, kills).await;
    }
}

async fn on_a_file(jobs: usize, kills: usize) {
    let file = Database::file();
    let chaos = Chaos {
        database: &file.address,
        jobs,
        workers: 0,
        kill_every: Duration::from_secs(2),
        kills,
        server_restarts: 0,
        database_restarts: 0,
        control: None,
    };
    println!("SQLite, {kills} kills\n{}\n", chaos.run().await);
}

async fn on_a_server(jobs: usize, kills: usize) {
    let Some(server) = Database::postgres("chaos").await else {
        return;
    };
    let chaos = Chaos {
        database: &server.address,
        jobs,
        workers: 3,
        kill_every: Duration::from_secs(2),
        kills,
        server_restarts: 2,
        database_restarts: 2,
        control: std::env::var("TRIMTAB_TEST_POSTGRES_CONTROL").ok(),
    };
    println!(
        "PostgreSQL, {kills} kills of a worker\n{}",
        chaos.run().await
    );
}
