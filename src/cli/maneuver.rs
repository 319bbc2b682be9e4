//! `trimtab maneuver`: the recordings of a server, and what was flown in them.

use clap::{Args, Subcommand};
use serde::Deserialize;

use super::Failure;
use super::client::Client;
use super::describe::Describe;
use super::server::ServerOption;
use super::table::bordered;
use crate::flight::{Flown, Quantity};
use crate::ingest::Summary;

/// List the recordings of a server, show one, and say what was flown in it.
#[derive(Args)]
pub(super) struct Maneuvers {
    #[command(subcommand)]
    action: Action,
}

#[derive(Subcommand)]
enum Action {
    /// List recordings, newest first.
    List(List),
    /// Show a recording, and what was flown.
    Show(Show),
    /// Say what was flown: aircraft, configuration, mass, notes, tags. What is not given stays as it is.
    Describe(Box<Describe>),
}

#[derive(Args)]
struct List {
    #[command(flatten)]
    server: ServerOption,
    /// Only those that have each of these words in their name, tags, notes, or what else is said of the flight.
    #[arg(long, value_name = "WORDS")]
    search: Option<String>,
    /// Only those with this tag.
    #[arg(long)]
    tag: Option<String>,
    /// Only those of this aircraft.
    #[arg(long)]
    aircraft: Option<String>,
    /// Only those of this registration.
    #[arg(long)]
    registration: Option<String>,
    /// Only those of this flight.
    #[arg(long)]
    flight: Option<String>,
    /// Only those of this test point.
    #[arg(long)]
    test_point: Option<String>,
    /// At most so many.
    #[arg(long, default_value_t = 50, value_parser = clap::value_parser!(u32).range(1..=200))]
    limit: u32,
}

#[derive(Args)]
struct Show {
    /// The id of the recording.
    id: String,
    #[command(flatten)]
    server: ServerOption,
}

/// What is shown of a recording.
#[derive(Deserialize)]
struct Shown {
    id: String,
    name: String,
    created: String,
    summary: Summary,
    flown: Flown,
}

impl Maneuvers {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        match &self.action {
            Action::List(list) => list.run().await,
            Action::Show(show) => {
                let client = Client::of(&show.server)?;
                print!("{}", told(&client.maneuver(&show.id).await?));
                Ok(())
            }
            Action::Describe(describe) => {
                let client = Client::of(&describe.server)?;
                let change = describe.change()?;
                print!(
                    "{}",
                    told(&client.change_maneuver(&describe.id, &change).await?)
                );
                Ok(())
            }
        }
    }
}

impl List {
    async fn run(&self) -> Result<(), Failure> {
        #[derive(Deserialize)]
        struct Page {
            maneuvers: Vec<Shown>,
        }
        let limit = self.limit.to_string();
        let wanted = [
            ("q", self.search.as_deref()),
            ("tag", self.tag.as_deref()),
            ("aircraft", self.aircraft.as_deref()),
            ("registration", self.registration.as_deref()),
            ("flight", self.flight.as_deref()),
            ("test_point", self.test_point.as_deref()),
            ("limit", Some(limit.as_str())),
        ];
        let wanted: Vec<(&str, &str)> = (wanted.into_iter())
            .filter_map(|(name, value)| Some((name, value?)))
            .collect();
        let page: Page = Client::of(&self.server)?.maneuvers(&wanted).await?;
        let rows = page.maneuvers.into_iter().map(|maneuver| {
            let Flown {
                registration,
                flight,
                test_point,
                tags,
                ..
            } = maneuver.flown;
            vec![
                maneuver.id,
                maneuver.name,
                format!("{}", maneuver.summary.duration),
                maneuver.summary.channels.len().to_string(),
                registration.unwrap_or_default(),
                flight.unwrap_or_default(),
                test_point.unwrap_or_default(),
                tags.join(", "),
            ]
        });
        let header = [
            "id",
            "name",
            "s",
            "channels",
            "registration",
            "flight",
            "test point",
            "tags",
        ];
        println!("{}", bordered(header, rows, 2..4));
        Ok(())
    }
}

/// A recording and what was flown, a line for each thing.
fn told(maneuver: &Shown) -> String {
    let Shown {
        id,
        name,
        created,
        summary,
        flown,
    } = maneuver;
    let length = format!("{} s, {} samples", summary.duration, summary.samples);
    let facts = [
        ("id", id.as_str()),
        ("name", name),
        ("uploaded", created),
        ("duration", &length),
    ];
    let facts = facts.into_iter().chain(flown.texts());
    let facts = facts.map(|(name, text)| (name.replace('_', " "), text.to_string()));
    let tags = Some(flown.tags.join(", ")).filter(|tags| !tags.is_empty());
    let tags = tags.map(|tags| ("tags".to_string(), tags));
    let quantities = flown.quantities().map(|(name, quantity)| {
        let Quantity { value, unit } = quantity;
        (format!("recording.{name}"), format!("{value} {unit}"))
    });
    let lines: Vec<(String, String)> = facts.chain(tags).chain(quantities).collect();
    let widths = lines.iter().map(|(name, _)| name.chars().count());
    let width = widths.max().unwrap_or(0) + 2;
    let lines = lines.iter();
    lines
        .map(|(name, value)| format!("{name:<width$}{value}\n"))
        .collect()
}
