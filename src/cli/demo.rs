//! `trimtab demo`: the whole way, from bundled maneuvers of known truth to a parameter table, and to what a model lacks.

use std::io::IsTerminal;
use std::path::Path;

use indexmap::IndexMap;
use serde_json::json;

use super::client::{Client, Stored};
use super::local::Local;
use super::watch::{conclude, follow};
use super::{Failure, plots, table};
use crate::estimate::Role;
use crate::ingest::bundled::{AILERON, Bundled, ELEVATOR, RUDDER, UNDECLARED};
use crate::job::JobSpec;
use crate::simulate::Scenario;

/// Starts a server, uploads the bundled maneuvers, fits them, and shows the estimates beside the truth. Then finds what
/// a model lacks of which the flights had an effect in them.
#[derive(clap::Args, Debug)]
pub(super) struct Demo {
    /// Where the server keeps its data; a file of its own without it, removed at the end.
    #[arg(long)]
    database: Option<String>,
    #[arg(long, default_value = "127.0.0.1:0")]
    listen: String,
    /// Leave the server running to be looked at, even where no terminal is attached.
    #[arg(long)]
    stay: bool,
}

/// The jobs of the demonstration; maneuvers of one job are fitted together.
const JOBS: [(&str, &[Bundled]); 2] = [
    ("short-period", &[ELEVATOR]),
    ("lateral-directional-4", &[AILERON, RUDDER]),
];

/// What part the flights with an effect in them take.
const ROLES: [Role; 3] = [Role::Estimation, Role::Validation, Role::Final];

fn scenario_of(maneuver: &Bundled) -> Result<Scenario, Failure> {
    toml::from_str(maneuver.scenario)
        .map_err(|error| Failure::new(format!("{}: {error}", maneuver.name)))
}

/// Uploads it; its id.
async fn upload(client: &Client, maneuver: &Bundled) -> Result<String, Failure> {
    let file = format!("{}.csv", maneuver.name);
    let stored: Stored = client
        .upload(maneuver.name, Path::new(&file), None, maneuver.csv.into())
        .await?;
    Ok(stored.id)
}

impl Demo {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        let server = Local::start(&self.listen, self.database.as_deref()).await?;
        eprintln!("server on {}", server.url);
        // nobody looks where nobody is: a script is not kept waiting, unless it asks for that
        let stays = self.stay || std::io::stdin().is_terminal();
        let client = Client::new(&server.url, None)?;
        for (model, maneuvers) in JOBS {
            let job = fit(&client, model, maneuvers).await?;
            if stays {
                println!("look at it: {}", client.url(&format!("/jobs/{job}"))?);
            }
        }
        let job = diagnose(&client).await?;
        if stays {
            println!("look at it: {}", client.url(&format!("/jobs/{job}"))?);
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
        let id = upload(client, maneuver).await?;
        uses.push(json!({"id": id, "label": maneuver.name}));
        truth.extend(scenario_of(maneuver)?.truth);
    }
    let names: Vec<&str> = maneuvers.iter().map(|maneuver| maneuver.name).collect();
    let spec = json!({"name": format!("demo: {model}"), "model": model, "maneuvers": uses});
    let spec: JobSpec =
        serde_json::from_value(spec).map_err(|error| Failure::new(error.to_string()))?;
    println!("\n{model} on {}", names.join(" and "));
    let job = client.submit(&spec).await?.id;
    let estimate = follow(client, &job).await?;
    println!("{}", table::result(&estimate, Some(&truth)));
    plots::show(client, &job).await?;
    Ok(job)
}

/// Uploads the flights with an effect in them, has the model diagnosed and prints what it lacks; the job's id.
async fn diagnose(client: &Client) -> Result<String, Failure> {
    let [first, ..] = &UNDECLARED;
    let Scenario {
        model,
        truth,
        effects,
        ..
    } = scenario_of(first)?;
    println!("\nwhat does {model} lack?");
    for effect in effects {
        let value = effect.value.unwrap_or_default();
        println!(
            "the truth, which is not told: {} of {}, {value:.4}",
            effect.kind, effect.target
        );
    }
    let mut uses = Vec::new();
    for (role, maneuver) in ROLES.into_iter().zip(&UNDECLARED) {
        let id = upload(client, maneuver).await?;
        uses.push(json!({"id": id, "label": maneuver.name, "role": role}));
    }
    let spec = json!({"kind": "diagnose", "name": "demo: what is missing", "model": model, "maneuvers": uses});
    let spec: JobSpec =
        serde_json::from_value(spec).map_err(|error| Failure::new(error.to_string()))?;
    let job = client.submit(&spec).await?.id;
    let estimate = follow(client, &job).await?;
    println!("{}", table::result(&estimate, Some(&truth)));
    conclude(client, &job, &estimate).await?;
    Ok(job)
}
