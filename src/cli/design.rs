//! `trimtab design`: maneuvers before they are flown, without a server.

use std::path::{Path, PathBuf};

use indexmap::IndexMap;

use super::recording::read_text;
use super::scenario::{model_of, read_inputs};
use super::{Failure, table};
use crate::design::{self, DesignSpec, DesignedManeuver, Designs};
use crate::estimate::five_digits as number;
use crate::model::Model;

/// Designs the maneuvers of a plan (multisteps, multisines, D-optimal inputs) and predicts the error bounds that they will give.
#[derive(clap::Args, Debug)]
pub(super) struct Design {
    /// The plan, TOML or JSON: scenario, maneuvers, limits. See data/design/short-period.toml.
    plan: PathBuf,
    /// A model document (.toml, .json) or a catalog model, in place of the one that the scenario names.
    #[arg(long, short, value_name = "MODEL")]
    model: Option<String>,
    /// Write into this directory, for each maneuver, its inputs over time (NAME.csv) and itself as a scenario (NAME.toml).
    #[arg(long, short, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
    /// Print everything as JSON.
    #[arg(long)]
    json: bool,
}

impl Design {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let place = self.plan.display();
        let text = read_text(&self.plan)?;
        let unread = |why: String| Failure::new(format!("{place}: {why}"));
        let is_json = self
            .plan
            .extension()
            .is_some_and(|extension| extension == "json");
        let mut spec: DesignSpec = match is_json {
            true => serde_json::from_str(&text).map_err(|e| unread(e.to_string()))?,
            false => toml::from_str(&text).map_err(|e| unread(e.to_string()))?,
        };
        read_inputs(&mut spec.scenario, &self.plan)?;
        let document = model_of(&spec.scenario, &self.plan, self.model.as_deref())?;
        let model =
            Model::compile(&document).map_err(|faults| Failure::faults(&document.name, &faults))?;
        let stems = match &self.output {
            // before it takes its time
            Some(_) => stems(spec.maneuvers.iter().map(|one| one.name.as_str()))?,
            None => Vec::new(),
        };
        let designs = design::design(&spec, model, f64::INFINITY)
            .map_err(|faults| Failure::faults("there is no design", &faults))?;
        if let Some(directory) = &self.output {
            write(directory, &stems, &designs)?;
        }
        match self.json {
            true => println!("{}", serde_json::to_string_pretty(&designs)?),
            false => println!("{}", shown(&designs)),
        }
        Ok(())
    }
}

/// Files are called as the maneuvers, without what cannot be in a name of a file; no two of them the same.
fn stems<'n>(names: impl Iterator<Item = &'n str>) -> Result<Vec<String>, Failure> {
    let fit = |c: char| match c.is_alphanumeric() || "-_.".contains(c) {
        true => c,
        false => '_',
    };
    let mut seen: IndexMap<String, &str> = IndexMap::new();
    for name in names {
        let stem: String = name.chars().map(fit).collect();
        if let Some(before) = seen.insert(stem.clone(), name) {
            return Err(Failure::new(format!(
                "--output: the maneuvers '{before}' and '{name}' would both be {stem}.csv; rename one of them"
            )));
        }
    }
    Ok(seen.into_keys().collect())
}

fn write(directory: &Path, stems: &[String], designs: &Designs) -> Result<(), Failure> {
    let unwritten = |file: &Path, why: String| {
        Failure::new(format!(
            "--output {}: {why}; name a directory that can be written",
            file.display()
        ))
    };
    std::fs::create_dir_all(directory).map_err(|why| unwritten(directory, why.to_string()))?;
    for (maneuver, stem) in designs.maneuvers.iter().zip(stems) {
        let scenario = toml::to_string(&maneuver.scenario)
            .map_err(|why| unwritten(directory, why.to_string()))?;
        for (ending, text) in [("csv", maneuver.to_csv()), ("toml", scenario)] {
            let file = directory.join(format!("{stem}.{ending}"));
            std::fs::write(&file, text).map_err(|why| unwritten(&file, why.to_string()))?;
        }
    }
    Ok(())
}

/// Inputs and responses of each maneuver, then bounds side by side.
fn shown(designs: &Designs) -> String {
    let mut text = String::new();
    for maneuver in &designs.maneuvers {
        text += &format!("{}\n", one(maneuver));
    }
    let mut header = vec!["parameter".to_string()];
    header.extend(
        designs
            .maneuvers
            .iter()
            .map(|maneuver| maneuver.name.clone()),
    );
    header.extend(["together".to_string(), "best".to_string()]);
    let rows = designs.together.iter().map(|row| {
        let alone = designs.maneuvers.iter().map(|maneuver| {
            let bound = maneuver
                .parameters
                .iter()
                .find(|bound| bound.name == row.name);
            cell(
                bound.and_then(|bound| bound.standard_error),
                bound.and_then(|bound| bound.relative),
            )
        });
        let mut cells = vec![format!("{} [{}]", row.name, unit(&row.unit))];
        cells.extend(alone);
        cells.push(cell(row.standard_error, None));
        cells.push(row.best.clone().unwrap_or_default());
        cells
    });
    let rows: Vec<Vec<String>> = rows.collect();
    let last = header.len() - 1;
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    text += &table::bordered(header, rows, 1..last);
    text + "\nleast standard errors (Cramér-Rao) at the a priori values; -: the maneuver does not tell it"
}

fn unit(text: &str) -> &str {
    if text.is_empty() { "-" } else { text }
}

fn cell(error: Option<f64>, relative: Option<f64>) -> String {
    match (error, relative) {
        (None, _) => "-".to_string(),
        (Some(error), None) => number(error),
        (Some(error), Some(share)) => format!("{} ({:.1} %)", number(error), 100.0 * share),
    }
}

fn one(maneuver: &DesignedManeuver) -> String {
    let mut text = maneuver.name.clone();
    if let (Some(frequency), Some(time)) = (maneuver.natural_frequency, maneuver.unit_time) {
        text += &format!(": unit of time {time} s for {} rad/s", number(frequency));
    }
    if maneuver.reduced_to < 1.0 {
        let share = 100.0 * maneuver.reduced_to;
        text += &format!(", amplitudes reduced to {share:.0} % by the limits of responses");
    }
    for input in maneuver.inputs.iter().filter(|input| input.peak > 0.0) {
        text += &format!(
            "\n  {} [{}]: peak {}, rms {}",
            input.name,
            unit(&input.unit),
            number(input.peak),
            number(input.rms)
        );
        if let Some(factor) = input.relative_peak_factor {
            text += &format!(", relative peak factor {factor:.2}");
        }
        if !input.harmonics.is_empty() {
            text += &format!(", {} harmonics", input.harmonics.len());
        }
    }
    for response in &maneuver.responses {
        text += &format!(
            "\n  {} [{}] moves by {}",
            response.name,
            unit(&response.unit),
            number(response.departure)
        );
    }
    text
}
