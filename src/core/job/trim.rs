//! Trim of any model, without a job.

use indexmap::IndexMap;
use serde::Deserialize;
use utoipa::ToSchema;

use super::spec::ModelSource;
use crate::dynamics::{Trim, TrimSpec, trim};
use crate::flight::{Fault, Faults, escape};
use crate::model::{Model, ModelDocument, Start};

/// A model and the steady flight that is looked for.
#[derive(Clone, PartialEq, Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ModelTrimSpec {
    /// A catalog model or one of the project, or a document.
    pub model: ModelSource,
    /// Constants of the model that differ, in their own units.
    #[serde(default, deserialize_with = "crate::model::unique")]
    #[schema(example = json!({"m": 1250.0}))]
    pub constants: IndexMap<String, f64>,
    /// Parameters that differ from their start values, in their own units. Those that a model reads off a recording are zero.
    #[serde(default, deserialize_with = "crate::model::unique")]
    #[schema(example = json!({"Cma": -0.68}))]
    pub parameters: IndexMap<String, f64>,
    /// The conditions.
    #[serde(default)]
    pub conditions: TrimSpec,
}

impl ModelTrimSpec {
    /// The trim of the document that the model stands for.
    ///
    /// # Errors
    /// Faults of the model, and of the conditions, by their JSON pointers.
    pub fn trim(&self, document: &ModelDocument) -> Result<Trim, Faults> {
        let mut document = document.clone();
        let mut faults = Vec::new();
        for (name, value) in &self.constants {
            match document.constants.get_mut(name) {
                Some(constant) => constant.value = *value,
                None => faults.push(unknown("constants", name, document.constants.keys())),
            }
        }
        for (name, value) in &self.parameters {
            match document.parameters.get_mut(name) {
                Some(parameter) => parameter.start = Start::Value(*value),
                None => faults.push(unknown("parameters", name, document.parameters.keys())),
            }
        }
        if !faults.is_empty() {
            return Err(faults.into());
        }
        let model = Model::compile(&document).map_err(|faults| -> Faults {
            let faults = faults.into_iter();
            faults.map(|fault| self.located(fault)).collect()
        })?;
        let parameters: Vec<f64> = (model.parameters.iter())
            .map(|info| match info.document.start {
                Start::Value(value) => info.unit.to_si(value),
                Start::FromData(_) => 0.0,
            })
            .collect();
        trim(&model, &parameters, &self.conditions).map_err(|faults| {
            let faults = faults.into_iter();
            faults.map(|fault| fault.under("/conditions")).collect()
        })
    }

    /// A fault of the model where it stands: beside the model where a value differs from its own.
    fn located(&self, mut fault: Fault) -> Fault {
        let parameters = self.parameters.keys().map(|name| ("parameters", name));
        let constants = self.constants.keys().map(|name| ("constants", name));
        for (field, name) in parameters.chain(constants) {
            let given = format!("/{field}/{}", escape(name));
            let is_of_it = (fault.pointer.strip_prefix(&given))
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
            if is_of_it {
                fault.pointer = given;
                return fault;
            }
        }
        fault.under("/model")
    }
}

fn unknown<'n>(field: &str, name: &str, known: impl Iterator<Item = &'n String>) -> Fault {
    let known: Vec<&str> = known.map(String::as_str).collect();
    let message = format!("the model has no '{name}'; it has {}", known.join(", "));
    Fault::new(
        format!("/{field}/{}", escape(name)),
        "unknown_symbol",
        message,
    )
}
