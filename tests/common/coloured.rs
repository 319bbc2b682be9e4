//! Short-period fits with noise of a given colour.

use std::ops::Range;
use std::sync::Arc;

use serde_json::json;
use trimtab_core::job::JobSpec;
use trimtab_core::model::{Model, catalog};
use trimtab_core::simulate::{NoiseColour, Scenario};

use super::coverage::{Coverage, fit, over_seeds};

/// Fits the bundled elevator maneuver with `seeds` realisations of its noise, coloured.
pub(crate) fn short_period(colour: NoiseColour, seeds: Range<u64>) -> Coverage {
    let text = include_str!("../../data/elevator.toml");
    let mut scenario: Scenario = toml::from_str(text).expect("a scenario");
    for output in scenario.outputs.values_mut() {
        output.colour = colour;
    }
    let document = catalog::find("short-period").expect("a catalog model");
    let model = Model::compile(&document).expect("a model");
    // alpha_0 is held: at its true value, or its error would be part of the others'
    let held = json!({"alpha_0": {"start": scenario.truth["alpha_0"]}});
    let spec = json!({"model": "short-period", "maneuvers": [{"id": "x"}], "parameters": held});
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    let truth = scenario.truth.clone();
    over_seeds(seeds, &truth, |seed| {
        let scenario = Scenario {
            seed,
            ..scenario.clone()
        };
        let recording = Arc::new(scenario.fly(&model).expect("a maneuver"));
        fit(&document, &spec, recording)
    })
}
