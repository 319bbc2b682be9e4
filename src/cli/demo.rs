//! `trimtab demo`: the whole way, from bundled maneuvers of known truth to a parameter table.

use std::io::IsTerminal;
use std::path::Path;

use indexmap::IndexMap;
use serde_json::json;

use super::client::Client;
use super::serve::Local;
use super::watch::follow;
use super::{Failure, table};
use crate::job::JobSpec;
use crate::simulate::Scenario;

/// Starts a server, uploads the bundled maneuvers, fits them, and shows the estimates beside the truth.
#[derive(clap::Args, Debug)]
pub struct Demo {
    /// Where the server keeps its data; a file of its own without it, removed at the end.
    #[arg(long)]
    database: Option<String>,
    #[arg(long, default_value = "127.0.0.1:0")]
    listen: String,
    /// Leave the server running to be looked at, even where no terminal is attached.
    #[arg(long)]
    stay: bool,
}

/// A maneuver that comes with Trimtab, and the scenario that made it.
struct Bundled {
    name: &'static str,
    csv: &'static str,
    scenario: &'static str,
}

const ELEVATOR: Bundled = Bundled {
    name: "elevator",
    csv: include_str!("../../data/elevator.csv"),
    scenario: include_str!("../../data/elevator.toml"),
};
const AILERON: Bundled = Bundled {
    name: "aileron",
    csv: include_str!("../../data/aileron.csv"),
    scenario: include_str!("../../data/aileron.toml"),
};
const RUDDER: Bundled = Bundled {
    name: "rudder",
    csv: include_str!("../../data/rudder.csv"),
    scenario: include_str!("../../data/rudder.toml"),
};

/// The jobs of the demonstration; maneuvers of one job are fitted together.
const JOBS: [(&str, &[Bundled]); 2] = [
    ("short-period", &[ELEVATOR]),
    ("lateral-directional-4", &[AILERON, RUDDER]),
];

impl Demo {
    pub async fn run(&self) -> Result<(), Failure> {
        let server = Local::start(&self.listen, self.database.as_deref()).await?;
        eprintln!("server on {}", server.url);
        // nobody looks where nobody is: a script is not kept waiting, unless it asks for that
        let stays = self.stay || std::io::stdin().is_terminal();
        let client = Client::new(&server.url)?;
        for (model, maneuvers) in JOBS {
            let job = fit(&client, model, maneuvers).await?;
            if stays {
                println!("look at it: {}", client.url(&format!("/jobs/{job}"))?);
            }
        }
        if stays {
            println!("\nthe server stays up until you press Ctrl-C");
            let _ = tokio::signal::ctrl_c().await;
        }
        server.stop().await
    }
}

/// Uploads maneuvers, fits a model to them and prints the table; the job's id.
async fn fit(client: &Client, model: &str, maneuvers: &[Bundled]) -> Result<String, Failure> {
    let mut uses = Vec::new();
    let mut truth: IndexMap<String, f64> = IndexMap::new();
    for maneuver in maneuvers {
        let file = format!("{}.csv", maneuver.name);
        let id = client
            .upload(maneuver.name, Path::new(&file), maneuver.csv.into())
            .await?
            .id;
        uses.push(json!({"id": id, "label": maneuver.name}));
        let scenario: Scenario = toml::from_str(maneuver.scenario)
            .map_err(|error| Failure::new(format!("{}: {error}", maneuver.name)))?;
        truth.extend(scenario.truth);
    }
    let names: Vec<&str> = maneuvers.iter().map(|maneuver| maneuver.name).collect();
    let spec = json!({"name": format!("demo: {model}"), "model": model, "maneuvers": uses});
    let spec: JobSpec =
        serde_json::from_value(spec).map_err(|error| Failure::new(error.to_string()))?;
    println!("\n{model} on {}", names.join(" and "));
    let job = client.submit(&spec).await?.id;
    let estimate = follow(client, &job).await?;
    println!("{}", table::result(&estimate, Some(&truth)));
    Ok(job)
}
