//! What the commands that stay up share: a database, workers, a log, and an end in good order.

use std::io::IsTerminal;
use std::time::Duration;

use clap::{Args, ValueEnum};
use tokio::signal::unix::{SignalKind, signal};
use tokio_util::sync::CancellationToken;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::prelude::*;

use super::Failure;
use crate::store::{self, Store};
use crate::work::Workers;

/// The service ends within this time, even if its database does not answer any more.
const LONGEST_END: Duration = Duration::from_millis(4200);

/// How long the threads of solvers that do not notice the end are waited for; their jobs are back in
/// the queue by then.
const THREADS_GRACE: Duration = Duration::from_millis(300);

#[derive(Args)]
pub(super) struct Database {
    /// The database: a file, made if it is not there (a path, or sqlite:PATH), or a PostgreSQL that many machines share
    /// (postgres://USER:PASSWORD@HOST/DATABASE; its password is safer in the environment).
    #[arg(
        long,
        env = "TRIMTAB_DATABASE",
        hide_env_values = true,
        value_name = "FILE|URL",
        default_value = "./trimtab.db"
    )]
    database: String,
}

impl Database {
    pub(super) fn address(&self) -> &str {
        &self.database
    }

    /// Its address, without its password.
    pub(super) fn shown(&self) -> String {
        store::without_password(&self.database)
    }

    /// Whether it is a file that is not there yet.
    pub(super) fn is_missing(&self) -> bool {
        store::is_missing(&self.database)
    }

    pub(super) async fn open(&self) -> Result<Store, Failure> {
        Ok(Store::open(&self.database).await?)
    }
}

#[derive(Args)]
pub(super) struct Process {
    #[command(flatten)]
    pub database: Database,

    /// Jobs that run at a time [default: one for each core]; with 0 this process only accepts them.
    #[arg(long, env = "TRIMTAB_WORKERS", value_name = "N")]
    workers: Option<usize>,

    /// Seconds that a job may take; then it ends with what it has come to, and the outcome `budget`. Without, it takes as long as it takes.
    #[arg(long, env = "TRIMTAB_MAX_JOB_SECONDS", value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    max_job_seconds: Option<u64>,

    /// What is logged, to standard error: a level, or levels by module (`info,trimtab=debug`).
    #[arg(
        long,
        env = "TRIMTAB_LOG",
        value_name = "FILTER",
        default_value = "info,cranelift_jit=warn"
    )]
    log: String,

    /// How it is logged.
    #[arg(long, env = "TRIMTAB_LOG_FORMAT", value_enum, default_value_t = LogFormat::Text)]
    log_format: LogFormat,
}

#[derive(Clone, Copy, ValueEnum)]
enum LogFormat {
    Text,
    Json,
}

impl Process {
    pub(super) fn workers(&self) -> Workers {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        Workers {
            count: self.workers.unwrap_or_else(cores),
            longest_job: self.max_job_seconds.map(Duration::from_secs),
        }
    }

    /// Runs `command`, whose token says when it has to end, and does not wait for it much longer.
    pub(super) fn run<F: Future<Output = Result<(), Failure>>>(
        &self,
        command: impl FnOnce(CancellationToken) -> F,
    ) -> Result<(), Failure> {
        self.start_log()?;
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .enable_all()
            .build()?;
        let done = runtime.block_on(async {
            let shutdown = shutdown_on_signal()?;
            let too_late = async {
                shutdown.cancelled().await;
                tokio::time::sleep(LONGEST_END).await;
            };
            tokio::select! {
                done = command(shutdown.clone()) => {
                    tracing::info!("ended");
                    done
                }
                () = too_late => {
                    tracing::warn!("cut off what did not end; jobs under way are taken up when their leases run out");
                    Ok(())
                }
            }
        });
        // dropping the runtime would wait for every solver thread, however long it takes
        runtime.shutdown_timeout(THREADS_GRACE);
        done
    }

    fn start_log(&self) -> Result<(), Failure> {
        let filter: Targets = self.log.parse()?;
        let log = tracing_subscriber::fmt::layer()
            .with_ansi(std::io::stderr().is_terminal())
            .with_writer(std::io::stderr);
        let log = match self.log_format {
            LogFormat::Text => log.boxed(),
            LogFormat::Json => log.json().boxed(),
        };
        tracing_subscriber::registry()
            .with(log.with_filter(filter))
            .init();
        // panics are caught where they happen; this puts them into the log with what led to them
        std::panic::set_hook(Box::new(|panic| tracing::error!("{panic}")));
        Ok(())
    }
}

/// A token that SIGTERM and SIGINT (Ctrl-C) cancel. A second one ends the process where it stands.
fn shutdown_on_signal() -> std::io::Result<CancellationToken> {
    let mut terminate = signal(SignalKind::terminate())?;
    let mut interrupt = signal(SignalKind::interrupt())?;
    let shutdown = CancellationToken::new();
    let token = shutdown.clone();
    tokio::spawn(async move {
        let mut either = async || {
            tokio::select! {
                _ = terminate.recv() => "SIGTERM",
                _ = interrupt.recv() => "SIGINT",
            }
        };
        let signal = either().await;
        tracing::info!(signal, "ending: no new requests, jobs go back to the queue");
        token.cancel();
        either().await;
        std::process::exit(130);
    });
    Ok(shutdown)
}
