//! Designs of maneuvers, for any model.

use serde::Deserialize;
use utoipa::ToSchema;

use super::spec::ModelSource;
use crate::design::{self, DesignSpec, Designs};
use crate::flight::{Fault, Faults};
use crate::model::ModelDocument;

/// A plan, and the model that it is for.
#[derive(Clone, PartialEq, Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct PlannedDesign {
    /// A model of the project or a document; absent: the catalog model that the scenario names.
    #[serde(default)]
    pub model: Option<ModelSource>,
    /// What `trimtab design` reads as TOML, the same as JSON.
    pub plan: DesignSpec,
}

impl PlannedDesign {
    /// The model, as it is named or written out.
    pub fn source(&self) -> ModelSource {
        let named = || ModelSource::Reference(self.plan.scenario.model.clone());
        self.model.clone().unwrap_or_else(named)
    }

    /// Designs the maneuvers with the document that the model stands for; work as in [`design::design`].
    ///
    /// # Errors
    /// Faults of the model, and of the plan, by their JSON pointers.
    pub fn design(&self, document: &ModelDocument, most: f64) -> Result<Designs, Faults> {
        let within = |mut fault: Fault| {
            fault.pointer = format!("/plan{}", fault.pointer);
            fault
        };
        design::design(&self.plan, document, most)
            .map_err(|faults| faults.into_iter().map(within).collect())
    }
}
