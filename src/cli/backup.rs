//! `trimtab backup`, `restore`, `check`: a database in a file, kept elsewhere, put back, and looked through.

use std::path::PathBuf;

use clap::Args;

use super::Failure;
use super::process::Database;
use crate::store::{self, Contents};

/// Write the database to a file, while the service goes on. A copy of the database's file alone would lose what was written last.
#[derive(Args)]
pub(super) struct Backup {
    #[command(flatten)]
    database: Database,
    /// The file to write, which is not there yet.
    file: PathBuf,
}

/// Put a backup where the database is to be, which is not there yet; the service is started on it then.
#[derive(Args)]
pub(super) struct Restore {
    #[command(flatten)]
    database: Database,
    /// A file that `trimtab backup` has written.
    file: PathBuf,
}

/// Look through all of a database, or of a backup (--database FILE): whether it is whole, and what it has.
#[derive(Args)]
pub(super) struct Check {
    #[command(flatten)]
    database: Database,
}

impl Backup {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        show(&store::back_up(self.database.address(), &self.file).await?);
        Ok(())
    }
}

impl Restore {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        show(&store::restore(&self.file, self.database.address()).await?);
        Ok(())
    }
}

impl Check {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        show(&store::check(self.database.address()).await?);
        Ok(())
    }
}

fn show(contents: &Contents) {
    let Contents {
        version,
        jobs,
        results,
        maneuvers,
        models,
    } = contents;
    println!(
        "whole: {jobs} jobs, {results} results, {maneuvers} maneuvers, {models} models (schema {version})"
    );
}
