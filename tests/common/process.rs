//! The program itself, started and ended as an operator would.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::{Duration, Instant};

/// A running `trimtab serve` or `trimtab work`. It is killed with the test, if it was not ended before.
pub(crate) struct Process {
    /// Of a server.
    pub url: String,
    child: Child,
}

impl Process {
    /// A server on a free port, with the database in `directory`.
    pub(crate) fn start(directory: &Path, workers: usize) -> Self {
        let database = super::server::database(directory);
        Self::serve(database.to_str().unwrap(), "127.0.0.1:0", workers)
    }

    pub(crate) fn serve(database: &str, listen: &str, workers: usize) -> Self {
        Self::serve_with(database, listen, workers, &[])
    }

    /// With further settings.
    pub(crate) fn serve_with(database: &str, listen: &str, workers: usize, more: &[&str]) -> Self {
        let workers = workers.to_string();
        let arguments = ["serve", "--listen", listen, "--workers", &workers];
        let (child, line) = started(&[&arguments, more].concat(), database);
        let url = line.strip_prefix("listening on ");
        Self {
            url: url.expect("one line with the URL").to_string(),
            child,
        }
    }

    pub(crate) fn work(database: &str, workers: usize) -> Self {
        let workers = workers.to_string();
        let (child, line) = started(&["work", "--workers", &workers], database);
        assert!(line.contains(" workers on "), "{line}");
        Self {
            url: String::new(),
            child,
        }
    }

    /// Sends SIGTERM; how it ended, and how long that took.
    pub(crate) fn terminate(mut self) -> (ExitStatus, Duration) {
        let started = Instant::now();
        let id = self.child.id().to_string();
        assert!(
            Command::new("kill")
                .args(["-TERM", &id])
                .status()
                .unwrap()
                .success()
        );
        let status = self.child.wait().unwrap();
        (status, started.elapsed())
    }

    /// Sends SIGKILL: no chance to put anything in order.
    pub(crate) fn kill(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

/// Where a server listens that is to come back: at an address of the machine's that no other test has, or the next
/// server that any test starts could take its port while it is away.
pub(crate) fn own_address() -> String {
    static LAST: AtomicU8 = AtomicU8::new(1);
    format!("127.0.0.{}:0", LAST.fetch_add(1, Ordering::Relaxed) + 1)
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The program, and the line that it prints when it is ready.
fn started(arguments: &[&str], database: &str) -> (Child, String) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_trimtab"))
        .args(arguments)
        .args(["--log", "error", "--database", database])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut line = String::new();
    BufReader::new(child.stdout.take().unwrap())
        .read_line(&mut line)
        .unwrap();
    (child, line.trim().to_string())
}
