//! `trimtab serve`.

use clap::Args;
use tokio_util::sync::CancellationToken;

use super::Failure;
use super::process::Process;
use crate::{http, ingest, webhook, work};

#[derive(Args)]
pub(super) struct Serve {
    /// Address to listen on; port 0 takes a free one. One that other machines can reach is refused as long as there are no
    /// keys (`trimtab key new`).
    #[arg(
        long,
        env = "TRIMTAB_LISTEN",
        value_name = "HOST:PORT",
        default_value = "127.0.0.1:8300"
    )]
    listen: String,

    #[command(flatten)]
    process: Process,

    /// Bytes of an uploaded recording.
    #[arg(long, env = "TRIMTAB_MAX_MANEUVER_BODY", value_name = "BYTES", default_value_t = http::Config::default().max_maneuver_body)]
    max_maneuver_body: usize,

    /// Bytes of a job or a model.
    #[arg(long, env = "TRIMTAB_MAX_JSON_BODY", value_name = "BYTES", default_value_t = http::Config::default().max_json_body)]
    max_json_body: usize,

    /// Bytes of all bodies that are on their way in at a time, and being read; at least twice the largest.
    #[arg(long, env = "TRIMTAB_MAX_BODY_MEMORY", value_name = "BYTES", default_value_t = http::Config::default().max_body_memory)]
    max_body_memory: usize,

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

    /// Connections at a time; those beyond are told that the service is busy (503), and `/health` is answered all the same.
    #[arg(long, env = "TRIMTAB_MAX_CONNECTIONS", value_name = "N", default_value_t = http::Config::default().max_connections)]
    max_connections: usize,

    /// Connections of one address at a time; 0: as many as there are, as behind a proxy, where all come from one.
    #[arg(long, env = "TRIMTAB_MAX_CONNECTIONS_PER_PEER", value_name = "N", default_value_t = http::Config::default().max_connections_per_peer)]
    max_connections_per_peer: usize,

    /// Believe `X-Forwarded-Host` and `X-Forwarded-Proto`: a proxy stands before the service and sets both.
    #[arg(long, env = "TRIMTAB_TRUST_PROXY")]
    trust_proxy: bool,

    /// Jobs that wait, of everybody; beyond, submissions are refused for the time being (429).
    #[arg(long, env = "TRIMTAB_MAX_QUEUED", value_name = "N", default_value_t = http::Config::default().max_queued)]
    max_queued: usize,

    /// Jobs that wait, of one key.
    #[arg(long, env = "TRIMTAB_MAX_QUEUED_PER_KEY", value_name = "N", default_value_t = http::Config::default().max_queued_per_key)]
    max_queued_per_key: usize,

    /// Requests of a key in a second, and twice as many at once; 0: as many as it will.
    #[arg(long, env = "TRIMTAB_MAX_REQUESTS_PER_SECOND", value_name = "N", default_value_t = http::Config::default().max_requests_per_second)]
    max_requests_per_second: u32,

    /// Bytes that the maneuvers of a project may take.
    #[arg(long, env = "TRIMTAB_MAX_STORED_BYTES", value_name = "BYTES", default_value_t = http::Config::default().max_stored_bytes)]
    max_stored_bytes: u64,

    /// A host that webhooks may lead to although it is on this machine or its network; also without TLS. May be given several times.
    #[arg(
        long = "webhook-allow",
        env = "TRIMTAB_WEBHOOK_ALLOW",
        value_name = "HOST",
        value_delimiter = ','
    )]
    webhook_allow: Vec<String>,

    /// Another site whose pages may use the service from a browser (CORS), as https://HOST:PORT; may be given several times.
    #[arg(
        long = "allow-origin",
        env = "TRIMTAB_ALLOW_ORIGIN",
        value_name = "ORIGIN",
        value_delimiter = ','
    )]
    origins: Vec<http::Origin>,
}

impl Serve {
    pub(super) fn run(&self) -> Result<(), Failure> {
        self.process.run(|shutdown| self.serve(shutdown))
    }

    async fn serve(&self, shutdown: CancellationToken) -> Result<(), Failure> {
        // first: an address that is refused should leave no file behind
        if self.process.database.is_missing() && !http::is_loopback(&self.listen).await? {
            return Err(http::BindError::Open(self.listen.clone()).into());
        }
        let store = self.process.database.open().await?;
        let listener = http::bind(&self.listen, &store).await?;
        let workers = self.process.workers();
        let url = format!("http://{}", listener.local_addr()?);
        println!("listening on {url}");
        tracing::info!(
            url,
            database = self.process.database.shown(),
            workers = workers.count,
            "ready"
        );
        let config = self.config();
        let allowed = config.webhooks.clone();
        tokio::join!(
            http::run(config, listener, store.clone(), shutdown.clone()),
            work::run(store.clone(), workers, shutdown.clone()),
            webhook::run(store.clone(), allowed, shutdown),
        );
        store.close().await;
        Ok(())
    }

    fn config(&self) -> http::Config {
        http::Config {
            max_maneuver_body: self.max_maneuver_body,
            max_json_body: self.max_json_body,
            max_body_memory: self.max_body_memory,
            recording: ingest::Limits {
                max_columns: self.max_columns,
                max_samples: self.max_samples,
                max_values: self.max_values,
                max_bytes: self.max_maneuver_body,
                ..ingest::Limits::default()
            },
            max_job_values: self.max_job_values,
            max_connections: self.max_connections,
            max_connections_per_peer: self.max_connections_per_peer,
            trusts_proxy: self.trust_proxy,
            max_queued: self.max_queued,
            max_queued_per_key: self.max_queued_per_key,
            max_requests_per_second: self.max_requests_per_second,
            max_stored_bytes: self.max_stored_bytes,
            webhooks: webhook::Allowed::new(self.webhook_allow.clone()),
            origins: self.origins.clone(),
        }
    }
}
