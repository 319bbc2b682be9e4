//! What the effects of a scenario make of its model, and of what is recorded.

use indexmap::IndexMap;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::document::{Scenario, ScenarioError};
use super::effect::ScenarioEffect;
use crate::flight::Channel;
use crate::model::{EditKind, Model, ModelDocument};

const OUTLIERS: &str = "sensor_outliers";
const PROCESS_NOISE: &str = "process_noise";

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
                let added: Vec<String> = edited.added.into_iter().map(|added| added.name).collect();
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
                affected.document = edited.document;
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
                    "there is no effect '{}'; choose one of {}, {OUTLIERS}, {PROCESS_NOISE}",
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
