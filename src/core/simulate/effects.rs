//! Effects in a scenario: what acts on the aircraft and its sensors and is not in the scenario's model.

use indexmap::IndexMap;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::input_design::InputDesign;
use super::scenario::{Scenario, ScenarioError, unit_like};
use crate::flight::{Channel, Dimension, Maneuver};
use crate::model::{Added, Edit, EditKind, Input, Model, ModelDocument, Recorded, Reference};

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
    pub kind: String,
    pub target: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub term: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parameter: Option<String>,
    /// As of an [`Edit`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub channels: IndexMap<String, Input>,
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub about: IndexMap<String, Reference>,
    /// Of the first parameter that is added; the share of spikes, or the intensity of process noise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Of the parameters that are added, by name, in their own units. Those left out have their start value.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub values: IndexMap<String, f64>,
}

const OUTLIERS: &str = "sensor_outliers";
const PROCESS_NOISE: &str = "process_noise";

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

/// A scenario with its effects in the model, and what is left of them to be done to the data.
pub(super) struct Affected<'s> {
    pub document: ModelDocument,
    pub scenario: Scenario,
    /// Parameters that were added: where they are read off the data, they are so off the designed inputs.
    pub added: Vec<String>,
    outliers: Vec<(usize, &'s ScenarioEffect)>,
}

impl<'s> Affected<'s> {
    pub(super) fn new(
        scenario: &'s Scenario,
        model: &ModelDocument,
    ) -> Result<Self, ScenarioError> {
        let mut affected = Self {
            document: model.clone(),
            scenario: Scenario {
                effects: Vec::new(),
                ..scenario.clone()
            },
            added: Vec::new(),
            outliers: Vec::new(),
        };
        for (i, effect) in scenario.effects.iter().enumerate() {
            let unfit = |message: String| ScenarioError::Unfit {
                what: format!("effects[{i}]"),
                message,
            };
            if let Some(edit) = effect.edit() {
                let edited = (edit.apply(&affected.document)).map_err(|e| unfit(e.to_string()))?;
                let added = Added::between(&affected.document, &edited).parameters;
                if let Some(name) = effect.values.keys().find(|name| !added.contains(name)) {
                    let known = added.join(", ");
                    return Err(unfit(format!("it adds no '{name}'; it adds {known}")));
                }
                let first = added.first().cloned().zip(effect.value);
                affected.scenario.truth.extend(first);
                let values = effect
                    .values
                    .iter()
                    .map(|(name, value)| (name.clone(), *value));
                affected.scenario.truth.extend(values);
                affected.added.extend(added);
                affected.document = edited;
            } else if effect.kind == OUTLIERS {
                affected.outliers.push((i, effect));
            } else if effect.kind == PROCESS_NOISE {
                let intensity = effect.value.or(effect.values.get("intensity").copied());
                let intensity = intensity.unwrap_or(0.0);
                let noise = &mut affected.scenario.process_noise;
                *noise.entry(effect.target.clone()).or_insert(0.0) += intensity;
            } else {
                let known: Vec<&str> = EditKind::ALL.iter().map(|kind| kind.name()).collect();
                return Err(unfit(format!(
                    "there is no effect '{}'; known are {}, {OUTLIERS}, {PROCESS_NOISE}",
                    effect.kind,
                    known.join(", ")
                )));
            }
        }
        Ok(affected)
    }

    pub(super) fn compile(&self) -> Result<Model, ScenarioError> {
        Model::compile(&self.document).map_err(|faults| ScenarioError::Unfit {
            what: "effects".to_string(),
            message: (faults.iter())
                .map(|fault| format!("{}: {}", fault.pointer, fault.message))
                .collect::<Vec<_>>()
                .join("; "),
        })
    }

    /// Spikes, dropouts and stuck values in what was recorded.
    pub(super) fn spoil(
        &self,
        channels: &mut IndexMap<String, Channel>,
    ) -> Result<(), ScenarioError> {
        for &(i, effect) in &self.outliers {
            // a stream of its own, so that nothing else changes with it
            let mut random = ChaCha8Rng::seed_from_u64(self.scenario.seed);
            random.set_stream(2 + i as u64);
            outliers(effect, channels, &mut random).map_err(|message| ScenarioError::Unfit {
                what: format!("effects[{i}]"),
                message,
            })?;
        }
        Ok(())
    }
}

fn outliers(
    effect: &ScenarioEffect,
    channels: &mut IndexMap<String, Channel>,
    random: &mut ChaCha8Rng,
) -> Result<(), String> {
    const WORDS: [&str; 5] = ["spikes", "size", "dropouts", "stuck", "stuck_samples"];
    if let Some(name) = effect
        .values
        .keys()
        .find(|name| !WORDS.contains(&name.as_str()))
    {
        return Err(format!("it has no '{name}'; it has {}", WORDS.join(", ")));
    }
    let known = channels.keys().cloned().collect::<Vec<_>>().join(", ");
    let Some(channel) = channels.get_mut(&effect.target) else {
        return Err(format!(
            "'{}' is not recorded; recorded are {known}",
            effect.target
        ));
    };
    let value = |name: &str, otherwise: f64| effect.values.get(name).copied().unwrap_or(otherwise);
    let spikes = value("spikes", effect.value.unwrap_or(0.0));
    let (dropouts, stuck) = (value("dropouts", 0.0), value("stuck", 0.0));
    let length = value("stuck_samples", 10.0);
    if [spikes, dropouts, stuck]
        .iter()
        .any(|share| !(0.0..=1.0).contains(share))
        || !(1.0..=1e6).contains(&length)
    {
        return Err(
            "spikes, dropouts and stuck are shares from 0 to 1, stuck_samples 1 or more".into(),
        );
    }
    let clean = channel.values.clone();
    let spread = {
        let mean = clean.iter().sum::<f64>() / clean.len() as f64;
        (clean.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / clean.len() as f64).sqrt()
    };
    // five standard deviations of the whole recording, where it does not say
    let size = (effect.values.get("size")).map_or(5.0 * spread, |size| size * channel.unit.scale);
    let mut held = 0;
    for k in 0..clean.len() {
        // as many draws for each sample, whatever happens to it
        let draws: [f64; 4] = std::array::from_fn(|_| random.random());
        if held == 0 && k > 0 && draws[0] < stuck / length {
            held = length as usize;
        }
        if held > 0 {
            held -= 1;
            channel.values[k] = channel.values[k - 1];
        } else if draws[1] < dropouts {
            channel.values[k] = channel.unit.to_si(0.0);
        } else if draws[2] < spikes {
            channel.values[k] += if draws[3] < 0.5 { -size } else { size };
        }
    }
    Ok(())
}

/// The designed inputs as a recording, for parameters that are read off one.
pub(super) struct Designed<'m> {
    pub model: &'m Model,
    pub time: Vec<f64>,
    pub inputs: &'m [Vec<f64>],
}

impl Recorded for Designed<'_> {
    fn time(&self) -> &[f64] {
        &self.time
    }

    fn channel(&self, name: &str) -> Option<(&[f64], Dimension)> {
        let place = (self.model.inputs.iter()).position(|input| input.name == name)?;
        Some((&self.inputs[place], self.model.inputs[place].unit.dimension))
    }

    fn names(&self) -> Vec<String> {
        (self.model.inputs.iter())
            .map(|input| input.name.clone())
            .collect()
    }
}

impl Scenario {
    /// Reads the inputs whose design is `recorded` in a file: `read` gives the recording of a path. Times count from
    /// its first sample, values are taken over into the unit of the input.
    ///
    /// # Errors
    /// A file that cannot be read, or a channel or unit that is not in it.
    pub fn read_recorded(
        &mut self,
        mut read: impl FnMut(&str) -> Result<Maneuver, String>,
    ) -> Result<(), ScenarioError> {
        for (name, input) in &mut self.inputs {
            let unfit = |message: String| ScenarioError::Unfit {
                what: format!("inputs.{name}.design"),
                message,
            };
            let InputDesign::Recorded {
                file: Some(file),
                channel,
                time,
                values,
            } = &mut input.design
            else {
                continue;
            };
            let maneuver = read(file).map_err(unfit)?;
            let channel = channel.as_ref().unwrap_or(name);
            let Some(recorded) = maneuver.channels().get(channel) else {
                let known: Vec<_> = maneuver.channels().keys().map(String::as_str).collect();
                let known = known.join(", ");
                return Err(unfit(format!("{file} has no '{channel}'; it has {known}")));
            };
            let unit = unit_like(&input.unit, recorded.unit, &format!("inputs.{name}.unit"))?;
            let begin = maneuver.time()[0];
            let samples = maneuver.time().iter().zip(&recorded.values);
            (*time, *values) = samples
                .filter(|(_, value)| value.is_finite())
                .map(|(t, value)| (t - begin, unit.from_si(*value)))
                .unzip();
        }
        Ok(())
    }
}
