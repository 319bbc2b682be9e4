//! An effect in a scenario: what acts on the aircraft and its sensors and is not in the scenario's model.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::model::{Edit, EditKind, Input, Reference};

/// One effect, by the words of the catalogue. Either an edit of the model, or of the data:
///
/// ```toml
/// [[effects]]
/// kind = "sensor_position"
/// target = "alpha"
/// term = "x"
/// value = 3.2                       # of the first parameter that is added, in its unit
///
/// [[effects]]
/// kind = "unsteady_aero"
/// target = "q"
/// term = "alpha"
/// values = { q_unsteady = -2.0, q_unsteady_time = 0.3 }
///
/// [[effects]]
/// kind = "sensor_outliers"          # shares of the samples; the size of a spike in the channel's unit
/// target = "q"
/// values = { spikes = 0.01, size = 5.0, dropouts = 0.005, stuck = 0.02, stuck_samples = 10 }
///
/// [[effects]]
/// kind = "process_noise"            # as the scenario's process_noise
/// target = "alpha"
/// value = 0.01
/// ```
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScenarioEffect {
    /// The name of an [`EditKind`], `sensor_outliers` or `process_noise`.
    pub kind: String,
    /// The channel, state or definition that it acts on.
    pub target: String,
    /// As of an [`Edit`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub term: Option<String>,
    /// As of an [`Edit`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parameter: Option<String>,
    /// As of an [`Edit`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// As of an [`Edit`](crate::model::Edit).
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub channels: IndexMap<String, Input>,
    /// As of an [`Edit`](crate::model::Edit).
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub about: IndexMap<String, Reference>,
    /// Of the first parameter that is added; the share of spikes, or the intensity of process noise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Of the parameters that are added, by name, in their own units. Those left out have their start value.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub values: IndexMap<String, f64>,
}

impl From<&Edit> for ScenarioEffect {
    fn from(edit: &Edit) -> Self {
        Self {
            kind: edit.kind.name().to_string(),
            target: edit.target.clone(),
            term: edit.term.clone(),
            parameter: edit.parameter.clone(),
            unit: edit.unit.clone(),
            channels: edit.channels.clone(),
            about: edit.about.clone(),
            value: None,
            values: IndexMap::new(),
        }
    }
}

impl ScenarioEffect {
    /// Reads `kind:target=value` or `kind:target:term=value`.
    ///
    /// # Errors
    /// The text is not of this form.
    pub fn parse(text: &str) -> Result<Self, String> {
        let unfit = || format!("'{text}' is not kind:target=value or kind:target:term=value");
        let (what, value) = text.rsplit_once('=').ok_or_else(unfit)?;
        let value: f64 = value.trim().parse().map_err(|_| unfit())?;
        let mut parts = what.splitn(3, ':').map(str::to_string);
        Ok(Self {
            kind: parts.next().ok_or_else(unfit)?,
            target: parts.next().ok_or_else(unfit)?,
            term: parts.next(),
            parameter: None,
            unit: None,
            channels: IndexMap::new(),
            about: IndexMap::new(),
            value: Some(value),
            values: IndexMap::new(),
        })
    }

    /// The edit that it is, if it is one.
    pub fn edit(&self) -> Option<Edit> {
        EditKind::find(&self.kind).map(|kind| Edit {
            kind,
            target: self.target.clone(),
            term: self.term.clone(),
            parameter: self.parameter.clone(),
            unit: self.unit.clone(),
            channels: self.channels.clone(),
            about: self.about.clone(),
        })
    }
}
