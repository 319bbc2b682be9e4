//! `trimtab maneuver`: the recordings of a server, and what was flown in them.

use clap::{Args, Subcommand};
use serde::Deserialize;
use serde_json::{Map, Value, json};

use super::Failure;
use super::client::Client;
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

#[derive(Args)]
struct Describe {
    /// The id of the recording.
    id: String,
    #[command(flatten)]
    server: ServerOption,
    /// Another name of the recording.
    #[arg(long)]
    name: Option<String>,
    /// The type of the aircraft.
    #[arg(long)]
    aircraft: Option<String>,
    /// Its registration or tail number.
    #[arg(long)]
    registration: Option<String>,
    /// The flight, by its number or name.
    #[arg(long)]
    flight: Option<String>,
    /// The test point of the flight.
    #[arg(long)]
    test_point: Option<String>,
    /// The day, as 2026-11-21.
    #[arg(long)]
    date: Option<String>,
    /// The configuration as a whole.
    #[arg(long)]
    configuration: Option<String>,
    /// The landing gear.
    #[arg(long)]
    gear: Option<String>,
    /// The flaps.
    #[arg(long)]
    flaps: Option<String>,
    /// For people.
    #[arg(long)]
    notes: Option<String>,
    /// A tag; may be given several times, and takes the place of those before.
    #[arg(long = "tag", value_name = "TAG")]
    tags: Vec<String>,
    /// A quantity with its unit: "mass=17600[kg]", "cg.x=3.1[m]", "Iy=1.5e6[kg*m^2]", or by a name of your own; may be given
    /// several times.
    #[arg(long = "set", value_name = "NAME=NUMBER[UNIT]")]
    quantities: Vec<String>,
    /// What is to be taken away, by the name of its option or quantity; may be given several times.
    #[arg(long, value_name = "NAME")]
    clear: Vec<String>,
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

impl Describe {
    /// The merge patch.
    fn change(&self) -> Result<Value, Failure> {
        let mut flown = Map::new();
        for name in &self.clear {
            put(&mut flown, member(name), Value::Null);
        }
        let texts = [
            ("aircraft", &self.aircraft),
            ("registration", &self.registration),
            ("flight", &self.flight),
            ("test_point", &self.test_point),
            ("date", &self.date),
            ("configuration", &self.configuration),
            ("gear", &self.gear),
            ("flaps", &self.flaps),
            ("notes", &self.notes),
        ];
        for (name, text) in texts {
            if let Some(text) = text {
                flown.insert(name.to_string(), json!(text));
            }
        }
        if !self.tags.is_empty() {
            flown.insert("tags".to_string(), json!(self.tags));
        }
        for text in &self.quantities {
            let (name, quantity) = (text.split_once('=')).ok_or_else(|| {
                Failure::new(format!("--set '{text}': write it like mass=17600[kg]"))
            })?;
            let quantity = Quantity::parse(quantity)
                .map_err(|why| Failure::new(format!("--set '{text}': {why}")))?;
            put(&mut flown, member(name.trim()), json!(quantity));
        }
        let mut change = Map::new();
        if let Some(name) = &self.name {
            change.insert("name".to_string(), json!(name));
        }
        if !flown.is_empty() {
            change.insert("flown".to_string(), Value::Object(flown));
        }
        match change.is_empty() {
            false => Ok(Value::Object(change)),
            true => Err(Failure::new(
                "nothing is said of the recording; say it, as --aircraft or --set mass=17600[kg]",
            )),
        }
    }
}

/// Where a quantity or a text stands.
fn member(name: &str) -> Vec<String> {
    let name = name.replace('-', "_");
    let path: Vec<&str> = match name.as_str() {
        "Ix" | "Iy" | "Iz" | "Ixz" => vec!["inertia", &name],
        "cg" => vec!["centre_of_gravity"],
        "aircraft" | "registration" | "flight" | "test_point" | "date" | "configuration"
        | "gear" | "flaps" | "notes" | "tags" | "mass" | "inertia" => vec![&name],
        _ => match name.split_once('.') {
            Some(("cg" | "centre_of_gravity", axis)) => vec!["centre_of_gravity", axis],
            Some(("inertia", of)) => vec!["inertia", of],
            Some(("quantities", other)) => vec!["quantities", other],
            _ => vec!["quantities", &name],
        },
    };
    path.into_iter().map(str::to_string).collect()
}

fn put(into: &mut Map<String, Value>, path: Vec<String>, value: Value) {
    match <[String; 2]>::try_from(path) {
        Ok([group, name]) => {
            let group = into.entry(group).or_insert_with(|| json!({}));
            group[name] = value;
        }
        Err(path) => {
            into.extend(path.into_iter().next().map(|name| (name, value)));
        }
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
    let mut lines = vec![
        ("id", id.clone()),
        ("name", name.clone()),
        ("uploaded", created.clone()),
        (
            "duration",
            format!("{} s, {} samples", summary.duration, summary.samples),
        ),
    ];
    let texts = [
        ("aircraft", &flown.aircraft),
        ("registration", &flown.registration),
        ("flight", &flown.flight),
        ("test point", &flown.test_point),
        ("date", &flown.date),
        ("configuration", &flown.configuration),
        ("gear", &flown.gear),
        ("flaps", &flown.flaps),
        ("notes", &flown.notes),
    ];
    lines.extend(
        texts
            .into_iter()
            .filter_map(|(name, text)| Some((name, text.clone()?))),
    );
    if !flown.tags.is_empty() {
        lines.push(("tags", flown.tags.join(", ")));
    }
    let mut text: String = lines
        .iter()
        .map(|(name, value)| format!("{name:<16}{value}\n"))
        .collect();
    for (name, quantity) in flown.quantities() {
        text += &format!(
            "{:<16}{} {}\n",
            format!("recording.{name}"),
            quantity.value,
            quantity.unit
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_to_their_places() {
        let mut flown = Map::new();
        for (name, value) in [
            ("mass", 1),
            ("cg.x", 2),
            ("Iy", 3),
            ("fuel", 4),
            ("cg.z", 5),
        ] {
            put(&mut flown, member(name), json!(value));
        }
        let expected = json!({
            "mass": 1, "centre_of_gravity": {"x": 2, "z": 5}, "inertia": {"Iy": 3}, "quantities": {"fuel": 4},
        });
        assert_eq!(Value::Object(flown), expected);
    }
}
