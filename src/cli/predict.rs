//! `trimtab predict`: a fit along other recordings, from their inputs alone, without a server.

use std::path::PathBuf;
use std::sync::Arc;

use indexmap::IndexMap;

use super::file_rows::FileRows;
use super::mapping::MappingOption;
use super::pairs::{once, pair};
use super::recording::{read_recording, read_text};
use super::{Failure, table};
use crate::estimate::{MonteCarlo, Role, five_digits as number};
use crate::http::predictions_as_csv;
use crate::job::{
    self, Gaps, JobKind, JobResult, JobSpec, ManeuverUse, ModelSource, PredictedSegment,
    PredictionSpec,
};
use crate::model::Start;

/// Simulates a fit with the inputs of other recordings, which need no outputs: states, definitions and outputs with standard
/// errors, and how outputs that are recorded compare. Nothing is estimated.
#[derive(clap::Args, Debug)]
pub(super) struct Predict {
    /// What `trimtab fit --json` printed.
    fit: PathBuf,
    /// Recordings of the inputs.
    #[arg(required = true, value_name = "FILE[:FIRST-LAST]")]
    files: Vec<FileRows>,
    #[command(flatten)]
    mapping: MappingOption,
    /// How a model input or output is made from recorded channels: "da=(da_right - da_left)/2".
    #[arg(long = "channel", short, value_name = "NAME=FORMULA")]
    channels: Vec<String>,
    /// The value of a parameter of the maneuver (initial state, bias): "alpha_0=0.06", or "alpha_0=first(alpha)".
    #[arg(long = "start", short, value_name = "NAME=VALUE")]
    starts: Vec<String>,
    /// One quantity to write; all without it.
    #[arg(long = "name", value_name = "NAME")]
    names: Vec<String>,
    /// Draws over the covariance of the parameters: the range of the middle 95 of 100 is written, too.
    #[arg(long)]
    draws: Option<usize>,
    /// Of the draws.
    #[arg(long, default_value_t = 0, requires = "draws")]
    seed: u64,
    /// Where to write the table (CSV); without it only how outputs compare is printed.
    #[arg(long, short)]
    output: Option<PathBuf>,
    /// Print everything as JSON.
    #[arg(long)]
    json: bool,
}

impl Predict {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let place = self.fit.display();
        let result: JobResult = serde_json::from_str(&read_text(&self.fit)?).map_err(|error| {
            Failure::new(format!(
                "{place}: {error}; give what trimtab fit --json printed"
            ))
        })?;
        let mapping = self.mapping.read()?;
        let maneuvers = (self.files.iter())
            .map(|rows| read_recording(&rows.file, mapping.as_ref()).map(Arc::new))
            .collect::<Result<Vec<_>, Failure>>()?;
        let ids: Vec<String> = maneuvers.iter().map(|maneuver| maneuver.digest()).collect();
        let wanted = self.wanted(&ids)?;
        let model = ModelSource::Document(Box::new(result.model.clone()));
        let spec = JobSpec::new(JobKind::Estimate, model, wanted.maneuvers.clone());
        let segments = job::predicted(&spec, &wanted, &result.model, &result.estimate, &maneuvers)
            .map_err(|faults| Failure::faults("there is no prediction", &faults))?;
        if let Some(file) = &self.output {
            std::fs::write(file, predictions_as_csv(&segments)).map_err(|why| {
                Failure::new(format!(
                    "{}: {why}; name a file that can be written",
                    file.display()
                ))
            })?;
        }
        if self.json {
            println!("{}", serde_json::to_string_pretty(&segments)?);
        } else {
            println!("{}", compared(&segments));
        }
        Ok(())
    }

    fn wanted(&self, ids: &[String]) -> Result<PredictionSpec, Failure> {
        let (mut channels, mut start) = (IndexMap::new(), IndexMap::new());
        for text in &self.channels {
            let (name, formula) = pair(text, "--channel")?;
            let before = channels.insert(name.to_string(), formula.to_string());
            once("--channel", name, before.is_some())?;
        }
        for text in &self.starts {
            let (name, value) = pair(text, "--start")?;
            let value = value
                .parse()
                .map_or_else(|_| Start::FromData(value.to_string()), Start::Value);
            once(
                "--start",
                name,
                start.insert(name.to_string(), value).is_some(),
            )?;
        }
        let usage = |(id, used): (&String, &FileRows)| ManeuverUse {
            label: used.label(),
            rows: used.rows,
            seconds: used.seconds,
            gaps: Gaps::default(),
            start: start.clone(),
            ..ManeuverUse::new(id.clone(), Role::Estimation)
        };
        Ok(PredictionSpec {
            maneuvers: ids.iter().zip(&self.files).map(usage).collect(),
            channels,
            names: self.names.clone(),
            monte_carlo: self.draws.map(|draws| MonteCarlo {
                draws,
                seed: self.seed,
            }),
        })
    }
}

/// How well recorded outputs are predicted, as a table.
fn compared(segments: &[PredictedSegment]) -> String {
    let rows: Vec<Vec<String>> = (segments.iter())
        .flat_map(|segment| segment.outputs.iter().map(move |output| (segment, output)))
        .map(|(segment, output)| {
            let (fit, shares) = (&output.fit, output.fit.theil_shares);
            let held = output.tolerance.as_ref();
            vec![
                segment.segment.clone(),
                format!("{} [{}]", fit.name, fit.unit),
                number(fit.rms),
                number(fit.bias),
                format!("{:.4}", fit.theil),
                format!(
                    "{:.2} {:.2} {:.2}",
                    shares.bias, shares.variance, shares.covariance
                ),
                held.map_or(String::new(), |held| {
                    format!("{:.1} %", 100.0 * held.share_within)
                }),
                held.map_or(String::new(), |held| {
                    format!("14 CFR 60 A2A {}: {}", held.entry, held.tolerance)
                }),
            ]
        })
        .collect();
    if rows.is_empty() {
        return "no output is recorded: there is nothing to compare with; --output FILE has the prediction".to_string();
    }
    let header = [
        "recording",
        "output",
        "rms error",
        "mean error",
        "Theil",
        "bias, variance, covariance",
        "within",
        "tolerance",
    ];
    table::bordered(header, rows, 2..5)
}
