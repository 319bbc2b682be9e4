//! Databases that do not do what they should: locked, not to be written, and no databases at all.

use std::path::Path;
use std::process::Command;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use sqlx::{AnyConnection, Connection, Executor, Row};
use tokio::io::copy_bidirectional;
use tokio::net::{TcpListener, UnixStream};
use tokio::time::sleep;
use tokio_util::sync::CancellationToken;
use trimtab::store::{Store, Trouble};

use crate::bench::{Bench, on_both};
use crate::common::database::Database;

on_both! {
    a_probe_is_written_once_a_second_however_many_ask,
}

/// As long as what a probe has found is good, and a moment.
const STALE: Duration = Duration::from_millis(1100);

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
    assert!(start.elapsed() < Duration::from_secs(2));
    other.execute("ROLLBACK").await.unwrap();
    // the statement that was given up may still be waiting for the lock
    let mut tries = 0;
    while let Err(error) = store.ping().await {
        tries += 1;
        assert!(tries < 10, "{error}");
        sleep(STALE / 2).await;
    }
}

/// It was nothing that a probe wrote on SQLite: what a row is set to that it is already is not written.
async fn a_probe_is_written_once_a_second_however_many_ask(bench: Bench) {
    let mut looking = AnyConnection::connect(&bench.url()).await.unwrap();
    let mut written = async || {
        let row = looking.fetch_one("SELECT at FROM probe").await.unwrap();
        row.get::<String, _>("at")
    };
    bench.store.ping().await.unwrap();
    let first = written().await;
    assert!(!first.is_empty());
    for _ in 0..20 {
        bench.store.ping().await.unwrap();
    }
    assert_eq!(written().await, first);
    sleep(STALE).await;
    bench.store.ping().await.unwrap();
    assert_ne!(written().await, first);
}

/// A small disk of its own; `None`, said loudly, where there is nobody who may mount one.
struct Disk(tempfile::TempDir);

impl Disk {
    fn new(test: &str) -> Option<Self> {
        let directory = tempfile::tempdir().unwrap();
        let disk = Self(directory);
        let mounted = disk.mount(&["-t", "tmpfs", "-o", "size=3m", "tmpfs"]);
        if !mounted {
            eprintln!("SKIPPED {test}: no disk can be mounted; run it as root");
        }
        mounted.then_some(disk)
    }

    fn mount(&self, how: &[&str]) -> bool {
        let mount = Command::new("mount").args(how).arg(self.0.path()).output();
        mount.is_ok_and(|mount| mount.status.success())
    }

    fn file(&self, name: &str) -> String {
        self.0.path().join(name).to_str().unwrap().to_string()
    }

    /// Takes all the room that there is.
    fn fill(&self) {
        let mut chunk = 1 << 16;
        let mut filled = Vec::new();
        while chunk > 0 {
            filled.resize(filled.len() + chunk, 1);
            if std::fs::write(self.file("filler"), &filled).is_err() {
                filled.truncate(filled.len() - chunk);
                chunk /= 2;
            }
        }
        let _ = std::fs::write(self.file("filler"), filled);
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg("-l").arg(self.0.path()).output();
    }
}

#[tokio::test]
async fn a_full_disk_is_not_ready_and_then_ready_again() {
    let Some(disk) = Disk::new("a_full_disk_is_not_ready_and_then_ready_again") else {
        return;
    };
    let store = Store::open(&disk.file("trimtab.db")).await.unwrap();
    store.ping().await.unwrap();
    disk.fill();
    sleep(STALE).await;
    let full = store.ping().await.expect_err("there is no room");
    assert_eq!(full.trouble(), Some(Trouble::Full), "{full}");
    std::fs::remove_file(disk.file("filler")).unwrap();
    sleep(STALE).await;
    store.ping().await.unwrap();
}

/// Why a database is refused at the start, and how soon.
async fn refusal(file: &str) -> (String, Duration) {
    let start = Instant::now();
    let refused = Store::open(file).await.err().expect("refused").to_string();
    assert!(refused.contains(file), "{refused}");
    (refused, start.elapsed())
}

#[tokio::test]
async fn a_file_that_another_has_locked_is_named_at_the_start() {
    let (_directory, file) = place();
    Store::open(&file).await.unwrap().close().await;
    let mut other = AnyConnection::connect(&format!("sqlite://{file}"))
        .await
        .unwrap();
    other.execute("BEGIN IMMEDIATE").await.unwrap();
    let (refused, after) = refusal(&file).await;
    assert!(
        refused.contains("another process holds it locked"),
        "{refused}"
    );
    assert!(after < Duration::from_secs(4), "{after:?}");
}

#[tokio::test]
async fn a_file_that_cannot_be_written_is_named_at_the_start() {
    let Some(disk) = Disk::new("a_file_that_cannot_be_written_is_named_at_the_start") else {
        return;
    };
    let file = disk.file("trimtab.db");
    Store::open(&file).await.unwrap().close().await;
    assert!(disk.mount(&["-o", "remount,ro"]));
    let (refused, after) = refusal(&file).await;
    assert!(refused.contains("see to the permissions"), "{refused}");
    assert!(after < Duration::from_secs(4), "{after:?}");
}

/// Stands before a PostgreSQL, and lets nothing through any more when it is told.
async fn proxy(socket: String, stalled: CancellationToken) -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let port = listener.local_addr().unwrap().port();
    tokio::spawn(async move {
        while let Ok((mut client, _)) = listener.accept().await {
            let (socket, stalled) = (socket.clone(), stalled.clone());
            tokio::spawn(async move {
                let mut server = UnixStream::connect(socket).await.unwrap();
                tokio::select! {
                    _ = copy_bidirectional(&mut client, &mut server) => {}
                    // and the connection stays as it is
                    () = stalled.cancelled() => std::future::pending().await,
                }
            });
        }
    });
    port
}

/// It took 8 s.
#[tokio::test]
async fn readiness_does_not_hang_where_postgresql_does() {
    let Some(database) = Database::postgres("readiness_does_not_hang").await else {
        return;
    };
    let (name, socket) = database
        .address
        .strip_prefix("postgres:///")
        .and_then(|rest| rest.split_once("?host="))
        .expect("an address as tests/postgres gives it");
    let directory = socket.split('&').next().unwrap();
    let socket = Path::new(directory).join(".s.PGSQL.5432");
    let stalled = CancellationToken::new();
    let port = proxy(socket.to_str().unwrap().to_string(), stalled.clone()).await;
    let store = Store::open(&format!("postgres://trimtab@127.0.0.1:{port}/{name}"))
        .await
        .unwrap();
    store.ping().await.unwrap();
    stalled.cancel();
    sleep(STALE).await;
    for _ in 0..2 {
        let start = Instant::now();
        let asked = (0..5).map(|_| store.ping());
        for answer in futures_util::future::join_all(asked).await {
            let away = answer.expect_err("nothing comes through");
            assert_eq!(away.trouble(), Some(Trouble::Away), "{away}");
        }
        assert!(
            start.elapsed() < Duration::from_secs(2),
            "{:?}",
            start.elapsed()
        );
        sleep(STALE).await;
    }
}

/// What is logged.
#[derive(Clone, Default)]
struct Log(Arc<Mutex<Vec<u8>>>);

impl std::io::Write for Log {
    fn write(&mut self, text: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().extend_from_slice(text);
        Ok(text.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// PostgreSQL told at each start that a table is there already.
#[tokio::test]
async fn a_start_that_finds_all_in_place_has_nothing_to_tell() {
    let Some(database) = Database::postgres("a_start_that_finds_all_in_place").await else {
        return;
    };
    Store::open(&database.address).await.unwrap().close().await;
    let log = Log::default();
    let written = log.clone();
    let subscriber = tracing_subscriber::fmt()
        .with_writer(move || log.clone())
        .finish();
    let logging = tracing::subscriber::set_default(subscriber);
    Store::open(&database.address).await.unwrap().close().await;
    tracing::info!("heard");
    drop(logging);
    let log = String::from_utf8(written.0.lock().unwrap().clone()).unwrap();
    assert!(log.contains("heard"), "{log}");
    assert!(!log.contains("already exists"), "{log}");
}
