//! A recording of known truth from a scenario, of any model.

use serde::Deserialize;
use utoipa::ToSchema;

use super::spec::ModelSource;
use crate::flight::{Faults, Maneuver};
use crate::model::{Model, ModelDocument};
use crate::simulate::{Scenario, ScenarioError};

/// What is to be simulated.
#[derive(Clone, PartialEq, Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct SimulationSpec {
    /// A model of the project or a document; absent: the catalog model that the scenario names.
    #[serde(default)]
    pub model: Option<ModelSource>,
    /// What `trimtab simulate` reads as TOML, the same as JSON: `model`, `seed`, `step`, `duration`, `truth`, `inputs`,
    /// `outputs`, `channels`, `process_noise`, `effects`. Inputs from files are not read.
    #[schema(value_type = Object, example = json!({"model": "short-period", "seed": 1, "step": 0.04, "duration": 10.0,
        "truth": {"Za": -0.85, "Zq": 0.97, "Zde": -0.08, "Ma": -3.4, "Mq": -1.6, "Mde": -4.8, "alpha_eq": 0.06, "de_eq": -0.02, "q_bias": 0.0, "alpha_0": 0.06},
        "inputs": {"de": {"unit": "deg", "trim": -1.1459, "design": {"shape": "doublet", "start": 2.0, "unit_time": 1.0, "amplitude": 2.0}}},
        "outputs": {"alpha": {"unit": "deg", "noise": 0.05}, "q": {"unit": "deg/s", "noise": 0.08}}}))]
    pub scenario: Scenario,
}

/// Why nothing is simulated.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum NoSimulatedManeuver {
    /// The model has faults.
    #[error("{0}")]
    Model(Faults),
    /// The scenario does not fit the model, or itself.
    #[error("{0}")]
    Scenario(String),
}

impl SimulationSpec {
    /// The model, as it is named or written out.
    pub fn source(&self) -> ModelSource {
        let named = || ModelSource::Reference(self.scenario.model.clone());
        self.model.clone().unwrap_or_else(named)
    }

    /// Flies the scenario with the document that its model stands for. No more samples than `most`, and no files are read.
    ///
    /// # Errors
    /// Faults of the model; a scenario that cannot be flown.
    pub fn fly(
        &self,
        document: &ModelDocument,
        most: usize,
    ) -> Result<Maneuver, NoSimulatedManeuver> {
        let unfit = NoSimulatedManeuver::Scenario;
        let mut scenario = self.scenario.clone();
        without_files(&mut scenario).map_err(|error| unfit(error.to_string()))?;
        let samples = scenario.duration / scenario.step;
        // written so that NaN is refused
        let is_short = samples < most as f64;
        if !is_short {
            let message = format!("step: at most {most} samples here; trimtab simulate takes more");
            return Err(unfit(message));
        }
        let model = Model::compile(document).map_err(NoSimulatedManeuver::Model)?;
        scenario
            .fly(&model)
            .map_err(|error| unfit(error.to_string()))
    }
}

/// Where a scenario is sent in, its inputs are not read from files.
pub(super) fn without_files(scenario: &mut Scenario) -> Result<(), ScenarioError> {
    let unread = |file: &str| Err(format!("{file}: files are not read here; design the input"));
    scenario.read_recorded(unread)
}
