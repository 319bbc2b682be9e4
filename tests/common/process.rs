//! The program itself, started and ended as an operator would.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// A running `trimtab serve`. It is killed with the test, if it was not ended before.
pub struct Process {
    pub url: String,
    child: Child,
}

impl Process {
    /// On a free port, with the database in `directory`.
    pub fn start(directory: &Path, workers: usize) -> Self {
        let database = super::server::database(directory);
        let mut child = Command::new(env!("CARGO_BIN_EXE_trimtab"))
            .args([
                "serve",
                "--listen",
                "127.0.0.1:0",
                "--log",
                "warn",
                "--database",
            ])
            .arg(database)
            .args(["--workers", &workers.to_string()])
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap())
            .read_line(&mut line)
            .unwrap();
        let url = line
            .trim()
            .strip_prefix("listening on ")
            .expect("one line with the URL");
        Self {
            url: url.to_string(),
            child,
        }
    }

    /// Sends SIGTERM; how it ended, and how long that took.
    pub fn terminate(mut self) -> (ExitStatus, Duration) {
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
    pub fn kill(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
