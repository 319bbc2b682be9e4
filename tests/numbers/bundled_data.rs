//! The bundled maneuvers are what their scenarios make, and the truth can be found in them.

use std::ops::ControlFlow;
use std::path::PathBuf;

use crate::common::recordings::maneuver;
use crate::common::repository;
use serde_json::json;
use trimtab_core::job::{self, JobSpec};
use trimtab_core::model::{Model, catalog};
use trimtab_core::simulate::Scenario;

fn file(name: &str) -> PathBuf {
    repository::path(&format!("data/{name}"))
}

fn scenario(name: &str) -> Scenario {
    toml::from_str(&std::fs::read_to_string(file(&format!("{name}.toml"))).expect("a file"))
        .expect("a scenario")
}

#[test]
fn each_file_is_what_its_scenario_makes() {
    let scenarios = [".", "effects"].into_iter().flat_map(|folder| {
        let entries = std::fs::read_dir(file(folder)).expect("a folder");
        let names = entries.map(|entry| entry.expect("an entry").file_name());
        let names = names.map(|name| name.into_string().expect("a name"));
        names.filter_map(move |name| Some(format!("{folder}/{}", name.strip_suffix(".toml")?)))
    });
    let names: Vec<String> = scenarios.collect();
    assert!(names.len() >= 3 + 3 * 6, "{names:?}");
    for name in names {
        let scenario = scenario(&name);
        let model = Model::compile(&catalog::find(&scenario.model).expect("a catalog model"))
            .expect("a model");
        let made =
            trimtab_core::ingest::to_csv_as_recorded(&scenario.fly(&model).expect("a maneuver"));
        let kept = std::fs::read_to_string(file(&format!("{name}.csv"))).expect("a file");
        assert!(
            made == kept,
            "data/{name}.csv is not what `trimtab simulate data/{name}.toml` makes"
        );
    }
}

#[test]
fn the_truth_is_within_four_standard_errors() {
    for (model, names) in [
        ("short-period", vec!["elevator"]),
        ("lateral-directional-4", vec!["aileron", "rudder"]),
    ] {
        let maneuvers: Vec<_> = (names.iter())
            .map(|name| std::fs::read(file(&format!("{name}.csv"))).expect("a file"))
            .map(|bytes| maneuver(&bytes))
            .collect();
        let uses: Vec<_> = maneuvers
            .iter()
            .map(|maneuver| json!({"id": maneuver.digest()}))
            .collect();
        let spec: JobSpec =
            serde_json::from_value(json!({"model": model, "maneuvers": uses})).expect("a spec");
        let document = catalog::find(model).expect("a catalog model");
        let plan = job::prepare(&spec, &document, &maneuvers)
            .unwrap_or_else(|faults| panic!("{faults:#?}"));
        let result = job::run(&plan, &mut |_| ControlFlow::Continue(()))
            .unwrap_or_else(|faults| panic!("{faults:#?}"));
        assert!(
            result.estimate.outcome.is_minimum(),
            "{}",
            result.estimate.reason
        );
        let truth = scenario(names[0]).truth;
        let mut compared = 0;
        for parameter in &result.estimate.parameters {
            if let (Some(error), Some(&truth)) =
                (parameter.standard_error, truth.get(&parameter.name))
            {
                let off = (parameter.estimate - truth).abs() / error;
                assert!(
                    off < 4.0,
                    "{model} {}: {off:.1} standard errors off",
                    parameter.name
                );
                compared += 1;
            }
        }
        assert!(compared >= 9, "only {compared} parameters compared");
    }
}
