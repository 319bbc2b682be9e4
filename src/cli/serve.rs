//! `trimtab serve`.

use std::io::IsTerminal;
use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, ValueEnum};
use tokio::signal::unix::{SignalKind, signal};
use tokio_util::sync::CancellationToken;
use tracing_subscriber::EnvFilter;

use super::Failure;
use crate::store::Store;
use crate::{http, ingest, work};

/// The service ends within this time, even if its database does not answer any more.
const LONGEST_END: Duration = Duration::from_millis(4200);

/// How long the threads of solvers that do not notice the end are waited for; their jobs are back in
/// the queue by then.
const THREADS_GRACE: Duration = Duration::from_millis(300);

#[derive(Args)]
pub struct Serve {
    /// Address to listen on; port 0 takes a free one. Other than loopback addresses are refused.
    #[arg(
        long,
        env = "TRIMTAB_LISTEN",
        value_name = "HOST:PORT",
        default_value = "127.0.0.1:8300"
    )]
    listen: String,

    /// The database: a file, made if it is not there (a path, or sqlite:PATH).
    #[arg(
        long,
        env = "TRIMTAB_DATABASE",
        value_name = "FILE",
        default_value = "./trimtab.db"
    )]
    database: String,

    /// Jobs that run at a time [default: one for each core]; with 0 this process only accepts them.
    #[arg(long, env = "TRIMTAB_WORKERS", value_name = "N")]
    workers: Option<usize>,

    /// Bytes of an uploaded recording.
    #[arg(long, env = "TRIMTAB_MAX_MANEUVER_BODY", value_name = "BYTES", default_value_t = http::Config::default().max_maneuver_body)]
    max_maneuver_body: usize,

    /// Bytes of a job or a model.
    #[arg(long, env = "TRIMTAB_MAX_JSON_BODY", value_name = "BYTES", default_value_t = http::Config::default().max_json_body)]
    max_json_body: usize,

    /// Columns of a recording, time included.
    #[arg(long, env = "TRIMTAB_MAX_COLUMNS", value_name = "N", default_value_t = ingest::Limits::default().max_columns)]
    max_columns: usize,

    /// Samples of a recording.
    #[arg(long, env = "TRIMTAB_MAX_SAMPLES", value_name = "N", default_value_t = ingest::Limits::default().max_samples)]
    max_samples: usize,

    /// Values (samples times columns) of a recording.
    #[arg(long, env = "TRIMTAB_MAX_VALUES", value_name = "N", default_value_t = ingest::Limits::default().max_values)]
    max_values: usize,

    /// Values of all maneuvers of a job.
    #[arg(long, env = "TRIMTAB_MAX_JOB_VALUES", value_name = "N", default_value_t = http::Config::default().max_job_values)]
    max_job_values: usize,

    /// Connections at a time; those beyond wait.
    #[arg(long, env = "TRIMTAB_MAX_CONNECTIONS", value_name = "N", default_value_t = http::Config::default().max_connections)]
    max_connections: usize,

    /// What is logged, to standard error: a level, or levels by module (`info,trimtab=debug`).
    #[arg(
        long,
        env = "TRIMTAB_LOG",
        value_name = "FILTER",
        default_value = "info"
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

impl Serve {
    pub fn run(self) -> Result<(), Failure> {
        self.start_log()?;
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .enable_all()
            .build()?;
        let served = runtime.block_on(self.serve());
        // dropping the runtime would wait for every solver thread, however long it takes
        runtime.shutdown_timeout(THREADS_GRACE);
        served
    }

    fn start_log(&self) -> Result<(), Failure> {
        let filter = EnvFilter::try_new(&self.log)?;
        let log = tracing_subscriber::fmt()
            .with_env_filter(filter)
            .with_ansi(std::io::stderr().is_terminal())
            .with_writer(std::io::stderr);
        match self.log_format {
            LogFormat::Text => log.init(),
            LogFormat::Json => log.json().init(),
        }
        // panics are caught where they happen; this puts them into the log with what led to them
        std::panic::set_hook(Box::new(|panic| tracing::error!("{panic}")));
        Ok(())
    }

    async fn serve(self) -> Result<(), Failure> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let workers = self.workers.unwrap_or(cores);
        let shutdown = shutdown_on_signal()?;
        // first: an address that is refused should leave no file behind
        let listener = http::bind(&self.listen).await?;
        let store = Store::open(&self.database).await?;
        let url = format!("http://{}", listener.local_addr()?);
        println!("listening on {url}");
        tracing::info!(url, database = self.database, workers, "ready");
        let config = self.config();
        let serve = async {
            tokio::join!(
                http::run(config, listener, store.clone(), shutdown.clone()),
                work::run(store.clone(), workers, shutdown.clone()),
            );
            store.close().await;
            tracing::info!("ended");
        };
        let too_late = async {
            shutdown.cancelled().await;
            tokio::time::sleep(LONGEST_END).await;
        };
        tokio::select! {
            () = serve => {}
            () = too_late => {
                tracing::warn!("cut off what did not end; jobs under way are taken up when their leases run out");
            }
        }
        Ok(())
    }

    fn config(&self) -> http::Config {
        http::Config {
            max_maneuver_body: self.max_maneuver_body,
            max_json_body: self.max_json_body,
            recording: ingest::Limits {
                max_columns: self.max_columns,
                max_samples: self.max_samples,
                max_values: self.max_values,
                ..ingest::Limits::default()
            },
            max_job_values: self.max_job_values,
            max_connections: self.max_connections,
        }
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

/// A server of this process, for a command that needs one; nothing of it is logged.
pub struct Local {
    pub url: String,
    shutdown: CancellationToken,
    running: tokio::task::JoinHandle<()>,
    store: Store,
    /// Removed when the server has stopped.
    directory: Option<PathBuf>,
}

impl Local {
    /// On `listen`, with `database` or with one that goes away again.
    pub async fn start(listen: &str, database: Option<&str>) -> Result<Self, Failure> {
        let listener = http::bind(listen).await?;
        let url = format!("http://{}", listener.local_addr()?);
        let (database, directory) = match database {
            Some(database) => (database.to_string(), None),
            None => {
                let directory =
                    std::env::temp_dir().join(format!("trimtab-{}", uuid::Uuid::now_v7()));
                std::fs::create_dir(&directory)?;
                (
                    directory.join("trimtab.db").display().to_string(),
                    Some(directory),
                )
            }
        };
        let store = Store::open(&database).await?;
        let shutdown = CancellationToken::new();
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let (served, token) = (store.clone(), shutdown.clone());
        let running = tokio::spawn(async move {
            tokio::join!(
                http::run(
                    http::Config::default(),
                    listener,
                    served.clone(),
                    token.clone()
                ),
                work::run(served.clone(), cores, token),
            );
        });
        Ok(Self {
            url,
            shutdown,
            running,
            store,
            directory,
        })
    }

    pub async fn stop(self) -> Result<(), Failure> {
        self.shutdown.cancel();
        self.running.await?;
        self.store.close().await;
        if let Some(directory) = self.directory {
            std::fs::remove_dir_all(directory)?;
        }
        Ok(())
    }
}
