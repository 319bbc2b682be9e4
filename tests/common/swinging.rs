//! Flights with something that no catalogue has.

use trimtab_core::ingest;
use trimtab_core::model::{Model, catalog};
use trimtab_core::simulate::Scenario;

/// Flights, to be fitted and to check on, whose pitching moment swings by itself: no catalogue has it, and nothing recorded
/// tells of it. As CSV.
pub(crate) fn swinging() -> [String; 2] {
    let model = Model::compile(&catalog::find("short-period").unwrap()).unwrap();
    let fly = |scenario: &str| {
        let mut scenario: Scenario = toml::from_str(scenario).unwrap();
        let effect = &mut scenario.effects[0];
        effect.term = Some("sin(1.9[1/s]*t)".to_string());
        effect.value = Some(0.04);
        ingest::to_csv(&scenario.fly(&model).unwrap(), |_| true)
    };
    [
        fly(include_str!("../../data/effects/pitch-curve-fit.toml")),
        fly(include_str!("../../data/effects/pitch-curve-check.toml")),
    ]
}
