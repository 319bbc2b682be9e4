//! The recorder: what of a flight gets into the file.

use std::sync::Arc;

use indexmap::IndexMap;
use trimtab_core::flight::{Channel as Recorded, Maneuver, Unit};

use crate::fly::FINER;
use crate::motion::{Motion, Quantity};
use crate::names::renamed;
use crate::noise::Noise;
use crate::plant::Plant;
use crate::random::Random;

/// One channel of the recorder.
#[derive(Clone, Debug)]
pub(crate) struct Channel {
    pub name: String,
    pub unit: &'static str,
    pub quantity: Quantity,
    /// Standard deviation, in the channel's unit.
    pub noise: f64,
    /// Whether the declared model compares its output with it. Noise of what it does not compare is white.
    pub output: bool,
}

impl Channel {
    pub(crate) fn new(name: &str, unit: &'static str, quantity: Quantity, noise: f64) -> Self {
        Self {
            name: name.to_string(),
            unit,
            quantity,
            noise,
            output: true,
        }
    }

    /// A channel that drives the model, or that it does not use.
    pub(crate) fn given(self) -> Self {
        Self {
            output: false,
            ..self
        }
    }

    pub(crate) fn scale(&self) -> f64 {
        Unit::parse(self.unit).expect("a unit").scale
    }
}

/// A recorded flight, and what only the judge knows of it.
pub(crate) struct Recording {
    pub label: String,
    pub fitted: bool,
    pub maneuver: Arc<Maneuver>,
    /// Noise of the outputs, SI, in their order.
    pub noise: Vec<Vec<f64>>,
}

/// How it is recorded.
pub(crate) struct Recorder<'r> {
    pub channels: &'r [Channel],
    /// Colour by output, in their order.
    pub noises: &'r [Noise],
    /// Without it nothing disturbs the truth.
    pub noisy: bool,
    /// Controls are recorded to a digit of four times their noise.
    pub coarse: bool,
    /// s between samples
    pub sample: f64,
}

impl Recorder<'_> {
    /// Channels go by other names where `names` has them.
    pub(crate) fn record(
        &self,
        label: &str,
        fitted: bool,
        motions: &[Motion],
        plant: &Plant,
        names: &[(&str, &str)],
        random: &mut Random,
    ) -> Recording {
        let step = self.sample / FINER as f64;
        let count = (motions.len() - 1) / FINER + 1;
        let mut channels = IndexMap::new();
        let mut noise = Vec::new();
        let mut number = 0;
        let place = |channels: &IndexMap<String, Recorded>, name: &str| {
            channels.get_index_of(&renamed(name, names))
        };
        for channel in self.channels {
            let mut series: Vec<f64> = motions.iter().map(|m| m.of(channel.quantity)).collect();
            for (_, change) in plant
                .sensors
                .iter()
                .filter(|(name, _)| *name == channel.name)
            {
                series = change(&series, motions, step);
            }
            let scale = channel.scale();
            let mut samples: Vec<f64> = (0..count).map(|k| series[k * FINER] / scale).collect();
            let colour = if channel.output {
                self.noises[number]
            } else {
                Noise::WHITE
            };
            number += usize::from(channel.output);
            let mut own = vec![0.0; count];
            if self.noisy {
                own = colour
                    .series(count, random)
                    .iter()
                    .map(|e| e * channel.noise)
                    .collect();
                samples.iter_mut().zip(&own).for_each(|(y, e)| *y += e);
                for (_, change) in plant
                    .records
                    .iter()
                    .filter(|(name, _)| *name == channel.name)
                {
                    change(&mut samples, channel.noise);
                }
                if self.coarse && matches!(channel.quantity, Quantity::Command(_)) {
                    let digit = 4.0 * channel.noise;
                    samples
                        .iter_mut()
                        .for_each(|y| *y = (*y / digit).round() * digit);
                }
            }
            if channel.output {
                noise.push(own.iter().map(|e| e * scale).collect());
            }
            let unit = Unit::parse(channel.unit).expect("a unit");
            channels.insert(
                renamed(&channel.name, names),
                Recorded::from_recorded(channel.unit, unit, samples),
            );
        }
        if let Some((a, b)) = &plant.swapped
            && let (Some(i), Some(j)) = (place(&channels, a), place(&channels, b))
        {
            let (left, right) = (channels[i].values.clone(), channels[j].values.clone());
            (channels[i].values, channels[j].values) = (right, left);
        }
        let clock = self.sample * (1.0 + plant.clock);
        let time = (0..count).map(|k| k as f64 * clock).collect();
        Recording {
            label: label.to_string(),
            fitted,
            maneuver: Arc::new(Maneuver::new(time, channels).expect("a maneuver")),
            noise,
        }
    }
}
