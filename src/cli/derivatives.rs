//! `trimtab derivatives`: dimensional derivatives to nondimensional coefficients, and back.

use std::path::{Path, PathBuf};

use indexmap::IndexMap;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::{Failure, table};
use crate::estimate::{Estimate, coefficients};
use crate::flight::{self, Aircraft, Unit};
use crate::model::{Model, catalog};

/// Nondimensional coefficients, with error bounds, from a fit; or start values for a model from coefficients.
#[derive(clap::Args, Debug)]
pub(super) struct Derivatives {
    /// A result: what `trimtab fit --json` prints, or a job's /estimate. With --model a list of
    /// coefficients: "Cma = -0.68", one a line (.toml), or the same as JSON.
    file: PathBuf,
    /// Mass, geometry, inertia and flight condition (m, S, c, b, Ix, Iy, Iz, Ixz, V, rho or qbar), TOML or JSON, SI.
    #[arg(long, short)]
    aircraft: PathBuf,
    /// Go the other way: the derivatives of this catalog model, in its units.
    #[arg(long, short)]
    model: Option<String>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// `fit --json` wraps the estimate, the service answers with it bare.
#[derive(Deserialize)]
#[serde(untagged)]
enum Answer {
    Wrapped { estimate: Box<Estimate> },
    Bare(Box<Estimate>),
}

impl Derivatives {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let aircraft: Aircraft = read(&self.aircraft)?;
        let place = self.aircraft.display().to_string();
        let faults = aircraft.faults();
        if !faults.is_empty() {
            return Err(Failure::faults(&place, &faults));
        }
        if let Some(model) = &self.model {
            return self.to_derivatives(&aircraft, model, &place);
        }
        let (Answer::Wrapped { estimate } | Answer::Bare(estimate)) = read(&self.file)?;
        let found = coefficients(&estimate, &aircraft)
            .map_err(|faults| Failure::faults(&place, &faults))?;
        if self.json {
            println!("{}", serde_json::to_string_pretty(&found)?);
        } else {
            println!("{}", table::coefficients(&found));
        }
        Ok(())
    }

    fn to_derivatives(&self, aircraft: &Aircraft, name: &str, place: &str) -> Result<(), Failure> {
        let given: IndexMap<String, f64> = read(&self.file)?;
        let document = catalog::find(name)
            .ok_or_else(|| Failure::new(format!("there is no catalog model '{name}'")))?;
        let model = Model::compile(&document)
            .map_err(|faults| Failure::faults(&format!("the model {name}"), &faults))?;
        let units: IndexMap<&str, Unit> = (model.parameters.iter())
            .map(|parameter| (parameter.name.as_str(), parameter.unit))
            .collect();
        let wanted: Vec<(&str, Unit)> = units.iter().map(|(&name, &unit)| (name, unit)).collect();
        let names: Vec<&str> = given.keys().map(String::as_str).collect();
        let values: Vec<f64> = given.values().copied().collect();
        let sums = flight::derivatives(&names, &wanted, aircraft)
            .map_err(|fault| Failure::faults(place, &[fault]))?;
        let used = |index: &usize| {
            sums.iter()
                .any(|sum| sum.terms.iter().any(|(i, _)| i == index))
        };
        for unused in (0..names.len()).filter(|index| !used(index)) {
            eprintln!(
                "note: the model {name} has no derivative for {}",
                names[unused]
            );
        }
        let found: IndexMap<&str, f64> = (sums.iter())
            .map(|sum| {
                let name = sum.name.as_str();
                (name, units[name].from_si(sum.value(&values)))
            })
            .collect();
        if self.json {
            println!("{}", serde_json::to_string_pretty(&found)?);
            return Ok(());
        }
        for (name, value) in &found {
            println!("{name} = {value}");
        }
        Ok(())
    }
}

/// A file that is JSON where it says so, else TOML.
fn read<T: DeserializeOwned>(file: &Path) -> Result<T, Failure> {
    let place = file.display();
    let text = std::fs::read_to_string(file).map_err(|e| Failure::new(format!("{place}: {e}")))?;
    let is_json = file.extension().is_some_and(|end| end == "json");
    let read = if is_json {
        serde_json::from_str(&text).map_err(|error| error.to_string())
    } else {
        toml::from_str(&text).map_err(|error| error.to_string())
    };
    read.map_err(|error| Failure::new(format!("{place}: {error}")))
}
