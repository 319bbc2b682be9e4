//! `trimtab simulate`: a maneuver of known truth from a scenario.

use std::io::Write;
use std::path::PathBuf;

use super::Failure;
use super::scenario::{model_of, read_inputs};
use crate::ingest;
use crate::model::Model;
use crate::simulate::{Scenario, ScenarioEffect};

/// Simulates a maneuver from a scenario and writes it as CSV. The same scenario gives the same file.
#[derive(clap::Args, Debug)]
pub(super) struct Simulate {
    /// The scenario, TOML: model, truth, inputs, noise. See data/elevator.toml.
    scenario: PathBuf,
    /// An effect that is not in the model, besides those of the scenario: kind:target=value or kind:target:term=value,
    /// such as sensor_delay:q=0.1 or missing_term:q:alpha^2=-8. The value is that of the first parameter it adds.
    #[arg(long = "effect", value_name = "EFFECT", value_parser = ScenarioEffect::parse)]
    effects: Vec<ScenarioEffect>,
    /// A model document (.toml, .json) or a catalog model, in place of the one that the scenario names.
    #[arg(long, short, value_name = "MODEL")]
    model: Option<String>,
    /// Where to write; standard output without it.
    #[arg(long, short)]
    output: Option<PathBuf>,
}

impl Simulate {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let path = self.scenario.display();
        let text = std::fs::read_to_string(&self.scenario)
            .map_err(|e| Failure::new(format!("{path}: {e}")))?;
        let mut scenario: Scenario =
            toml::from_str(&text).map_err(|e| Failure::new(format!("{path}: {e}")))?;
        scenario.effects.extend(self.effects.iter().cloned());
        read_inputs(&mut scenario, &self.scenario)?;
        let document = model_of(&scenario, &self.scenario, self.model.as_deref())?;
        let model =
            Model::compile(&document).map_err(|faults| Failure::faults(&document.name, &faults))?;
        let maneuver = scenario
            .fly(&model)
            .map_err(|e| Failure::new(format!("{path}: {e}")))?;
        let csv = ingest::to_csv_as_recorded(&maneuver);
        match &self.output {
            Some(file) => std::fs::write(file, csv)
                .map_err(|e| Failure::new(format!("{}: {e}", file.display()))),
            None => std::io::stdout()
                .write_all(csv.as_bytes())
                .map_err(|e| Failure::new(e.to_string())),
        }
    }
}
