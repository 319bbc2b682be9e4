//! A small chaos on each engine; `cargo bench --bench chaos` is the large one.

use std::time::Duration;

use crate::common::chaos::{Chaos, Report};
use crate::common::database::Database;

fn is_sound(report: &Report) {
    println!("{report}");
    assert!(report.kills == 5 && report.reconnects > 0, "{report:?}");
    assert!(report.taken_over > 0, "{report:?}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_server_on_a_file_is_killed_and_loses_nothing() {
    let database = Database::file();
    let chaos = Chaos {
        database: &database.address,
        jobs: 60,
        workers: 0,
        kill_every: Duration::from_millis(300),
        kills: 5,
        server_restarts: 0,
        database_restarts: 0,
        control: None,
    };
    is_sound(&chaos.run().await);
}

#[tokio::test(flavor = "multi_thread")]
async fn workers_a_server_and_a_postgresql_are_killed_and_nothing_is_lost() {
    let test = "workers_a_server_and_a_postgresql_are_killed_and_nothing_is_lost";
    let Some(database) = Database::postgres(test).await else {
        return;
    };
    let chaos = Chaos {
        database: &database.address,
        jobs: 60,
        workers: 3,
        kill_every: Duration::from_millis(300),
        kills: 5,
        server_restarts: 1,
        database_restarts: 0,
        control: None,
    };
    is_sound(&chaos.run().await);
}
