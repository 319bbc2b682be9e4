//! Designs of maneuvers, for any model.

use serde::Deserialize;
use utoipa::ToSchema;

use super::simulation::without_files;
use super::spec::ModelSource;
use crate::design::{self, DesignSpec, Designs};
use crate::flight::{Fault, Faults};
use crate::model::{Model, ModelDocument};

/// A plan, and the model that it is for.
#[derive(Clone, PartialEq, Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct PlannedDesign {
    /// A model of the project or a document; absent: the catalog model that the scenario names.
    #[serde(default)]
    pub model: Option<ModelSource>,
    /// What `trimtab design` reads as TOML, the same as JSON. Inputs from files are not read.
    pub plan: DesignSpec,
}

/// Why nothing is designed: faults by their JSON pointers into the [`PlannedDesign`].
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum NoDesign {
    /// The model has faults.
    #[error("{0}")]
    Model(Faults),
    /// The plan does not fit the model, or itself.
    #[error("{0}")]
    Plan(Faults),
}

impl PlannedDesign {
    /// The model, as it is named or written out.
    pub fn source(&self) -> ModelSource {
        let named = || ModelSource::Reference(self.plan.scenario.model.clone());
        self.model.clone().unwrap_or_else(named)
    }

    /// Designs the maneuvers with the document that the model stands for; work as in [`design::design`]. No files are read.
    ///
    /// # Errors
    /// Faults of the model, and of the plan.
    pub fn design(&self, document: &ModelDocument, most: f64) -> Result<Designs, NoDesign> {
        let under = |place: &'static str, faults: Faults| -> Faults {
            let faults = faults.into_iter();
            faults.map(|fault| fault.under(place)).collect()
        };
        let place = match self.model {
            Some(_) => "/model",
            None => "/plan/scenario/model",
        };
        let model =
            Model::compile(document).map_err(|faults| NoDesign::Model(under(place, faults)))?;
        let of_plan = |faults| NoDesign::Plan(under("/plan", faults));
        let mut plan = self.plan.clone();
        without_files(&mut plan.scenario).map_err(|error| {
            let fault = Fault::new("/scenario", "bad_scenario", error.to_string());
            of_plan(fault.into())
        })?;
        design::design(&plan, model, most).map_err(of_plan)
    }
}
