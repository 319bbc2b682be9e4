//! `trimtab jobs`: the jobs of a server.

use clap::Args;

use super::Failure;
use super::client::Client;
use super::form::{Column, Form};
use super::server::ServerOption;

/// Lists the jobs of a server, newest first.
#[derive(Args, Debug)]
pub(super) struct Jobs {
    #[command(flatten)]
    server: ServerOption,
    /// Only those that have each of these words in their name, tags, model or labels of maneuvers.
    #[arg(long, value_name = "WORDS")]
    search: Option<String>,
    /// Only those of this status: queued, running, cancelling, succeeded, failed or cancelled.
    #[arg(long)]
    status: Option<String>,
    /// Only those of this kind: estimate, diagnose, structure or derivative_study.
    #[arg(long)]
    kind: Option<String>,
    /// Only those with this tag.
    #[arg(long)]
    tag: Option<String>,
    /// Only those submitted after this moment (RFC 3339): 2026-11-21T12:00:00Z.
    #[arg(long, value_name = "TIME")]
    after: Option<String>,
    /// At most so many.
    #[arg(long, default_value_t = 50, value_name = "N")]
    limit: usize,
    #[command(flatten)]
    form: Form,
}

const COLUMNS: [Column; 8] = [
    Column::text("id", "/id"),
    Column::text("title", "/title"),
    Column::text("kind", "/kind"),
    Column::text("status", "/status"),
    Column::text("outcome", "/outcome"),
    Column::text("created", "/created"),
    Column::text("tags", "/tags"),
    Column::number("lowest R²", "/fit/r_squared"),
];

impl Jobs {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        let wanted = [
            ("q", self.search.as_deref()),
            ("status", self.status.as_deref()),
            ("kind", self.kind.as_deref()),
            ("tag", self.tag.as_deref()),
            ("created_after", self.after.as_deref()),
        ];
        let client = Client::of(&self.server)?;
        let jobs = client.list("jobs", &wanted, self.limit).await?;
        self.form.print(&COLUMNS, &jobs)
    }
}
