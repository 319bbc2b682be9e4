//! `trimtab retain`: deletes what is older than it need be kept, in all projects or one; for a timer on the database's machine.

use std::time::Duration;

use clap::Args;

use super::Failure;
use super::process::Database;
use crate::http::days;
use crate::store::{Expired, Rule};

/// Delete jobs that ended long ago, and maneuvers that no job uses any more.
#[derive(Args)]
pub(super) struct Retain {
    #[command(flatten)]
    database: Database,
    /// Days that everything is kept.
    #[arg(long, value_name = "DAYS", value_parser = clap::value_parser!(u32).range(1..=36500))]
    older_than: u32,
    /// Of one project only.
    #[arg(long)]
    project: Option<String>,
    /// Jobs with this tag are kept, and what they use.
    #[arg(long, default_value = "keep")]
    keep_tag: String,
    /// Say how much it is, and delete nothing.
    #[arg(long)]
    dry_run: bool,
}

impl Retain {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        let store = self.database.open().await?;
        let age: Duration = days(self.older_than);
        let rule = Rule {
            project: self.project.clone(),
            before: store.clock().text_before(age),
            keep_tag: self.keep_tag.clone(),
        };
        let Expired {
            jobs,
            maneuvers,
            maneuver_bytes,
        } = store.expire(&rule, self.dry_run).await?;
        let done = if self.dry_run { "would be" } else { "were" };
        println!(
            "{jobs} jobs and {maneuvers} maneuvers ({maneuver_bytes} bytes) from before {} {done} deleted",
            rule.before
        );
        store.close().await;
        Ok(())
    }
}
