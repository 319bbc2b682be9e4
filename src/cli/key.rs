//! `trimtab key`: keys of any project, for who has the database at hand.

use std::time::Duration;

use clap::{Args, Subcommand, ValueEnum};
use comfy_table::Table;
use comfy_table::presets::NOTHING;
use uuid::Uuid;

use super::Failure;
use super::process::Database;
use crate::http::{a_day, days};
use crate::job::HIGHEST_PRIORITY;
use crate::store::{DEFAULT_PROJECT, Key, KeyRecord, NewKey, Scope, Store};

/// Make, list, replace and revoke keys. As soon as there is one, every request needs one.
#[derive(Args)]
pub(super) struct Keys {
    #[command(subcommand)]
    action: Action,
}

#[derive(Subcommand)]
enum Action {
    /// Make a key, and print it: this once.
    New(New),
    /// List keys, without their secrets.
    List(List),
    /// Replace a key by a new one that may do the same; the old one stays good for a while.
    Rotate(Rotate),
    /// Revoke a key from now on.
    Revoke(Revoke),
}

#[derive(Args)]
struct New {
    #[command(flatten)]
    database: Database,
    /// What the key opens: maneuvers, models and jobs of this project and no other.
    #[arg(long, default_value = DEFAULT_PROJECT)]
    project: String,
    /// What it is used by, for people.
    #[arg(long, default_value = "")]
    name: String,
    /// What it allows; may be given several times.
    #[arg(long = "scope", value_enum, default_values_t = [ScopeName::Read, ScopeName::Submit])]
    scopes: Vec<ScopeName>,
    /// Days until it expires; without, it does not.
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=3650))]
    days: Option<u32>,
    /// The highest priority of jobs that are submitted with it.
    #[arg(long, default_value_t = 0, allow_negative_numbers = true,
        value_parser = clap::value_parser!(i32).range(i64::from(-HIGHEST_PRIORITY)..=i64::from(HIGHEST_PRIORITY)))]
    max_priority: i32,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
enum ScopeName {
    /// See what the project has.
    Read,
    /// Upload, submit and cancel.
    Submit,
    /// Make and revoke the project's keys, and delete what it has.
    Admin,
    /// See /metrics: numbers over all projects, and no data of any.
    Metrics,
}

impl ScopeName {
    fn scope(self) -> Scope {
        match self {
            Self::Read => Scope::Read,
            Self::Submit => Scope::Submit,
            Self::Admin => Scope::Admin,
            Self::Metrics => Scope::Metrics,
        }
    }
}

#[derive(Args)]
struct List {
    #[command(flatten)]
    database: Database,
    /// Of one project only.
    #[arg(long)]
    project: Option<String>,
}

#[derive(Args)]
struct Rotate {
    #[command(flatten)]
    database: Database,
    /// The id of the key, as `list` shows it.
    id: Uuid,
    /// How long the old key stays good beside the new one.
    #[arg(long, value_name = "HOURS", default_value_t = a_day())]
    overlap: u32,
}

#[derive(Args)]
struct Revoke {
    #[command(flatten)]
    database: Database,
    /// The id of the key, as `list` shows it.
    id: Uuid,
}

impl Keys {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        match &self.action {
            Action::New(new) => new.run().await,
            Action::List(list) => list.run().await,
            Action::Rotate(rotate) => rotate.run().await,
            Action::Revoke(revoke) => revoke.run().await,
        }
    }
}

impl New {
    async fn run(&self) -> Result<(), Failure> {
        let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.".contains(&byte);
        if !(1..=64).contains(&self.project.len()) || !self.project.bytes().all(plain) {
            return Err(Failure::new(format!(
                "'{}' is not a project name; use 1 to 64 letters, digits, '-', '_' and '.'",
                self.project
            )));
        }
        let store = self.database.open().await?;
        let first = !store.has_keys().await?;
        let new = NewKey {
            project: self.project.clone(),
            name: self.name.clone(),
            scopes: self.scopes.iter().map(|scope| scope.scope()).collect(),
            max_priority: self.max_priority,
            lifetime: self.days.map(days),
        };
        show(&store.add_key(&new).await?);
        if first {
            eprintln!("it is the first: from now on every request to this database needs a key");
        }
        close(store).await
    }
}

impl List {
    async fn run(&self) -> Result<(), Failure> {
        let store = self.database.open().await?;
        let mut table = Table::new();
        table.load_style(NOTHING);
        table.set_header([
            "id",
            "project",
            "name",
            "scopes",
            "priority",
            "created",
            "last used",
            "state",
        ]);
        let now = store.clock().now_text();
        for key in store.keys(self.project.as_deref()).await? {
            let state = match (&key.revoked, &key.expires) {
                (Some(at), _) => format!("revoked {at}"),
                (None, Some(at)) if *at <= now => format!("expired {at}"),
                (None, Some(at)) => format!("good until {at}"),
                (None, None) => "good".to_string(),
            };
            let scopes: Vec<&str> = key.scopes.iter().map(|scope| scope.name()).collect();
            table.add_row([
                key.id.to_string(),
                key.project,
                key.name,
                scopes.join(", "),
                key.max_priority.to_string(),
                key.created,
                key.used.unwrap_or_else(|| "never".to_string()),
                state,
            ]);
        }
        println!("{table}");
        close(store).await
    }
}

impl Rotate {
    async fn run(&self) -> Result<(), Failure> {
        let store = self.database.open().await?;
        let overlap = Duration::from_secs(u64::from(self.overlap) * 3600);
        let made = store.rotate_key(None, self.id, overlap).await?;
        let made = made.ok_or_else(|| unknown(self.id))?;
        show(&made);
        eprintln!("the old key stays valid for {} h", self.overlap);
        close(store).await
    }
}

impl Revoke {
    async fn run(&self) -> Result<(), Failure> {
        let store = self.database.open().await?;
        let revoked = store.revoke_key(None, self.id).await?;
        let revoked = revoked.ok_or_else(|| unknown(self.id))?;
        eprintln!(
            "revoked: '{}' of the project {}",
            revoked.name, revoked.project
        );
        close(store).await
    }
}

fn unknown(id: Uuid) -> Failure {
    Failure::new(format!(
        "there is no valid key {id}; 'trimtab key list' shows all"
    ))
}

/// The secret alone goes to standard output, for who reads it from there.
fn show((record, key): &(KeyRecord, Key)) {
    eprintln!("key {} of the project {}:", record.id, record.project);
    println!("{}", key.reveal());
}

async fn close(store: Store) -> Result<(), Failure> {
    store.close().await;
    Ok(())
}
