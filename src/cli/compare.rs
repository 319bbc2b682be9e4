//! `trimtab compare`: what some jobs say of the same parameters, side by side.

use super::client::Client;
use super::server::ServerOption;
use super::{Failure, table};
use crate::flight::{five_digits, with_error};
use crate::http::comparison_as_csv;
use crate::job::{ComparedValue, Comparison};

/// Compares jobs of a server: parameters side by side, with their differences from the first job in standard errors. Without a
/// server `trimtab campaign` compares files.
#[derive(clap::Args, Debug)]
pub(super) struct Compare {
    /// Ids of two or more finished jobs.
    #[arg(required = true, num_args = 2.., value_name = "JOB")]
    jobs: Vec<String>,
    #[command(flatten)]
    server: ServerOption,
    /// Print a table as CSV, a row for each parameter and job.
    #[arg(long)]
    csv: bool,
    /// Print JSON.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
}

impl Compare {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        let client = Client::of(&self.server)?;
        let comparison: Comparison = client.compare(&self.jobs).await?;
        if self.csv {
            print!("{}", comparison_as_csv(&comparison));
        } else if self.json {
            println!("{}", serde_json::to_string_pretty(&comparison)?);
        } else {
            println!("{}", side_by_side(&comparison));
        }
        for (one, other) in comparison.dependent_pairs() {
            eprintln!(
                "jobs {one} and {other} were fitted to samples of the same recording: they are not independent, and their differences in standard errors are not to be relied on"
            );
        }
        Ok(())
    }
}

fn side_by_side(comparison: &Comparison) -> String {
    let names = comparison.jobs.iter().enumerate();
    let names: Vec<String> = names
        .map(|(at, job)| format!("{}: {} ({})", at + 1, job.name, job.reason))
        .collect();
    let mut header = vec!["parameter".to_string(), "unit".to_string()];
    for at in 1..=comparison.jobs.len() {
        header.push(at.to_string());
        if at > 1 {
            header.push("s.e. apart".to_string());
        }
    }
    let rows = comparison.parameters.iter().map(|row| {
        let mut cells = vec![row.parameter.clone(), row.unit.clone()];
        for (at, value) in row.values.iter().enumerate() {
            cells.push(value.as_ref().map(estimate).unwrap_or_default());
            if at > 0 {
                cells.push(value.as_ref().map(apart).unwrap_or_default());
            }
        }
        cells
    });
    let columns = header.len();
    let header = header.iter().map(String::as_str);
    format!(
        "{}\n{}",
        names.join("\n"),
        table::bordered(header, rows, 2..columns)
    )
}

fn estimate(value: &ComparedValue) -> String {
    match value.standard_error {
        Some(error) => with_error(value.estimate, error),
        None => five_digits(value.estimate),
    }
}

/// With a star where the two jobs are not independent.
fn apart(value: &ComparedValue) -> String {
    let star = if value.is_independent == Some(false) {
        "*"
    } else {
        ""
    };
    let deviation = value
        .deviation
        .map(|deviation| format!("{deviation:+.1}{star}"));
    deviation.unwrap_or_else(|| value.remark.clone())
}
