//! `trimtab results`: what a job of a server answers.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::client::{Client, in_path};
use super::form::Form;
use super::server::ServerOption;
use super::{Failure, diagnose, table};

/// Prints a result of a job that is over: its parameters, or what else is named.
#[derive(Args, Debug)]
pub(super) struct Results {
    /// The job's id.
    job: String,
    /// Which result. Without --csv or --json those for people are tables, time histories are CSV and the rest is JSON.
    #[arg(default_value = "parameters", value_name = "WHAT")]
    what: What,
    #[command(flatten)]
    server: ServerOption,
    #[command(flatten)]
    form: Form,
    /// Of time histories, residuals and trajectories: from this second on.
    #[arg(long, value_name = "SECONDS")]
    from: Option<f64>,
    /// Of the same: up to this second.
    #[arg(long, value_name = "SECONDS")]
    to: Option<f64>,
    /// Of the same: at most about so many samples of each segment.
    #[arg(long, value_name = "N")]
    max_points: Option<usize>,
    /// A file to write to.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
enum What {
    Parameters,
    Estimate,
    Diagnosis,
    TimeHistories,
    Residuals,
    Trajectories,
    Iterations,
    ResidualAnalysis,
    LinearSystem,
    Structure,
    DerivativeStudy,
    Model,
    Spec,
    Provenance,
}

/// What the server can make of a result.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Known {
    /// A table: as CSV, too.
    Table,
    /// A table whose samples are chosen by time.
    History,
    /// JSON alone.
    Tree,
}

impl What {
    fn known(self) -> Known {
        match self {
            Self::Parameters | Self::Iterations => Known::Table,
            Self::TimeHistories | Self::Residuals | Self::Trajectories => Known::History,
            _ => Known::Tree,
        }
    }

    /// Its name in the API.
    fn name(self) -> String {
        let value = self.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().to_string())
    }
}

impl Results {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        let text = self.text(&Client::of(&self.server)?).await?;
        match &self.output {
            Some(file) => std::fs::write(file, text)
                .map_err(|error| Failure::new(format!("{}: {error}", file.display()))),
            None => {
                print!("{text}");
                Ok(())
            }
        }
    }

    async fn text(&self, client: &Client) -> Result<String, Failure> {
        let known = self.what.known();
        let chosen = self.chosen();
        if known != Known::History && !chosen.is_empty() {
            let message = format!(
                "--{} is for time-histories, residuals and trajectories",
                chosen[0].0.replace('_', "-")
            );
            return Err(Failure::new(message));
        }
        if self.form.csv && known == Known::Tree {
            let name = self.what.name();
            return Err(Failure::new(format!("{name} is not a table; use --json")));
        }
        let is_for_people = !(self.form.csv || self.form.json);
        match self.what {
            What::Parameters | What::Estimate if is_for_people => {
                let estimate = client.estimate(&in_path(&self.job)).await?;
                Ok(table::result(&estimate, None) + "\n")
            }
            What::Diagnosis if is_for_people => {
                let diagnosis = client.diagnosis(&in_path(&self.job)).await?;
                Ok(diagnose::conclusion(&diagnosis, false) + "\n")
            }
            What::Model if is_for_people => self.fetched(client, "toml", &chosen).await,
            _ if self.form.csv || (is_for_people && known == Known::History) => {
                self.fetched(client, "csv", &chosen).await
            }
            _ => self.fetched(client, "json", &chosen).await,
        }
    }

    /// As the server has it; JSON on lines of its own.
    async fn fetched(
        &self,
        client: &Client,
        format: &str,
        chosen: &[(&str, String)],
    ) -> Result<String, Failure> {
        let path = format!("jobs/{}/{}", in_path(&self.job), self.what.name());
        let mut wanted: Vec<(&str, &str)> = chosen.iter().map(|(k, v)| (*k, v.as_str())).collect();
        if self.what.known() != Known::Tree || self.what == What::Model {
            wanted.push(("format", format));
        }
        let text = client.text(&path, &wanted).await?;
        if format == "json" {
            let value: serde_json::Value = serde_json::from_str(&text)?;
            return Ok(serde_json::to_string_pretty(&value)? + "\n");
        }
        Ok(text)
    }

    /// What of the samples is wanted.
    fn chosen(&self) -> Vec<(&'static str, String)> {
        let text = |number: Option<f64>| number.map(|number| number.to_string());
        let all = [
            ("from", text(self.from)),
            ("to", text(self.to)),
            ("max_points", self.max_points.map(|most| most.to_string())),
        ];
        let given = all.into_iter();
        given
            .filter_map(|(name, value)| Some((name, value?)))
            .collect()
    }
}
