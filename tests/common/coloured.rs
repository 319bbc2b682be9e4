//! Short-period fits with noise of a given colour, of recordings as loggers make them.

use std::ops::Range;
use std::sync::Arc;

use serde_json::{Value, json};
use trimtab_core::flight::{Channel, Maneuver};
use trimtab_core::job::JobSpec;
use trimtab_core::model::{Model, catalog};
use trimtab_core::simulate::{NoiseColour, Scenario};

use super::coverage::{Coverage, fit, over_seeds};

/// What a logger makes of the samples.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Logged {
    /// All of them.
    Whole,
    /// Twice none, while the input stands still and the aircraft moves.
    WithGaps,
    /// Those of alpha at a fifth of the rate, each held until the next.
    Held,
    /// Both.
    HeldWithGaps,
}

/// Seconds without rows.
const GAPS: [(f64, f64); 2] = [(6.6, 7.4), (9.0, 9.4)];
/// Rows in which a sample is held.
const HELD: usize = 5;

impl Logged {
    fn has_gaps(self) -> bool {
        matches!(self, Self::WithGaps | Self::HeldWithGaps)
    }

    fn is_held(self) -> bool {
        matches!(self, Self::Held | Self::HeldWithGaps)
    }

    fn recording(self, flown: Maneuver) -> Maneuver {
        let time = flown.time();
        let is_in_gap = |t: f64| GAPS.iter().any(|(from, to)| t > *from && t < *to);
        let rows = 0..time.len();
        let kept: Vec<usize> = rows
            .filter(|row| !self.has_gaps() || !is_in_gap(time[*row]))
            .collect();
        let channel = |name: &str, channel: &Channel| {
            let held = |row: usize| match self.is_held() && name == "alpha" {
                true => row / HELD * HELD,
                false => row,
            };
            let values = kept.iter().map(|row| channel.values[held(*row)]);
            let values = values.collect();
            Channel {
                values,
                ..channel.clone()
            }
        };
        let channels = flown.channels().iter();
        let channels = channels.map(|(name, of)| (name.clone(), channel(name, of)));
        let time = kept.iter().map(|row| time[*row]).collect();
        Maneuver::new(time, channels.collect()).expect("a recording")
    }

    /// What a job says of it.
    fn said(self) -> Value {
        match (self.has_gaps(), self.is_held()) {
            (false, false) => json!({"id": "x"}),
            (true, false) => json!({"id": "x", "gaps": "through"}),
            (false, true) => json!({"id": "x", "channels": {"alpha": "fresh(alpha)"}}),
            (true, true) => {
                json!({"id": "x", "gaps": "through", "channels": {"alpha": "fresh(alpha)"}})
            }
        }
    }
}

/// Fits the bundled elevator maneuver with `seeds` realisations of its noise, coloured.
pub(crate) fn short_period(colour: NoiseColour, seeds: Range<u64>) -> Coverage {
    logged(colour, Logged::Whole, seeds)
}

/// The same as a logger writes it.
pub(crate) fn logged(colour: NoiseColour, by: Logged, seeds: Range<u64>) -> Coverage {
    let text = include_str!("../../data/elevator.toml");
    let mut scenario: Scenario = toml::from_str(text).expect("a scenario");
    for output in scenario.outputs.values_mut() {
        output.colour = colour;
    }
    let document = catalog::find("short-period").expect("a catalog model");
    let model = Model::compile(&document).expect("a model");
    // alpha_0 is held: at its true value, or its error would be part of the others'
    let held = json!({"alpha_0": {"start": scenario.truth["alpha_0"]}});
    let spec = json!({"model": "short-period", "maneuvers": [by.said()], "parameters": held});
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    let truth = scenario.truth.clone();
    over_seeds(seeds, &truth, |seed| {
        let scenario = Scenario {
            seed,
            ..scenario.clone()
        };
        let flown = scenario.fly(&model).expect("a maneuver");
        fit(&document, &spec, Arc::new(by.recording(flown)))
    })
}
