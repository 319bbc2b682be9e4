//! The chaos in full: `tests/postgres cargo bench --bench chaos [jobs] [kills] [sqlite|postgres]`.
//!
//! On PostgreSQL: three worker processes, one of which is killed (SIGKILL) every two seconds, 50 times, the server
//! restarted twice and the database, too. On SQLite: one process that serves and works, killed 50 times. What is promised is checked by
//! [`chaos::Chaos::run`]: each accepted job ends once, its events are all there and were seen once by who followed them.

#[path = "../common/chaos.rs"]
mod chaos;
#[allow(dead_code)]
#[path = "../common/database.rs"]
mod database;
#[allow(dead_code)]
#[path = "../common/process.rs"]
mod process;
#[allow(dead_code)]
#[path = "../common/recordings.rs"]
mod recordings;
#[allow(dead_code)]
#[path = "../common/server.rs"]
mod server;
#[allow(dead_code)]
#[path = "../common/sse.rs"]
mod sse;

use std::time::Duration;

use chaos::Chaos;
use database::Database;

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
