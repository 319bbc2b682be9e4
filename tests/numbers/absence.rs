//! Every effect contains its own absence: at the values of `Edited::absence` the edited model gives the outputs of the
//! model before, for each kind of the catalogue and all that it can be aimed at in six models.

use std::collections::BTreeSet;

use trimtab_core::model::{Edit, EditKind, Model, ModelDocument, catalog};

use super::effects::outputs;

const MODELS: [&str; 6] = [
    "short-period",
    "lateral-directional-2",
    "lateral-directional-4",
    "longitudinal-nonlinear",
    "six-degrees-of-freedom",
    "flight-path-reconstruction",
];

/// Everything that a kind may be aimed at: what does not fit is refused.
fn edits(document: &ModelDocument, kind: EditKind) -> Vec<Edit> {
    let inputs: Vec<&str> = document.inputs.keys().map(String::as_str).collect();
    let states: Vec<&str> = document.states.keys().map(String::as_str).collect();
    let outputs = document.outputs.keys().map(String::as_str);
    let definitions = document.definitions.keys().map(String::as_str);
    let mut targets: Vec<&str> = inputs.iter().chain(&states).copied().collect();
    targets.extend(outputs.chain(definitions));
    targets.extend(["p+r", "alpha+beta", "ax+az", "phi+theta"]);
    targets.extend(["all", "CL+Cm", "CL+CD+Cm", "Wx", "Wy", "Wz"]);
    targets.extend(document.parameters.keys().map(String::as_str));
    targets.dedup();
    let signals = || states.iter().chain(&inputs);
    let terms: Vec<String> = match kind {
        EditKind::SensorPosition => ["x", "y", "z"].map(String::from).to_vec(),
        EditKind::SensorCrossAxis => (document.outputs.keys().cloned())
            .chain(signals().map(|name| (*name).to_string()))
            .collect(),
        EditKind::UnrecordedInput => vec!["dt[rad]".to_string()],
        EditKind::MissingTerm => signals()
            .flat_map(|name| [format!("{name}^2"), format!("{name}*abs({name})")])
            .chain(states.iter().map(|state| format!("{state}dot")))
            .chain(["qbar".to_string()])
            .collect(),
        EditKind::UnsteadyAero => signals().map(|name| (*name).to_string()).collect(),
        // flow separates with a flow angle, which stays below the bound of the stall; a bank angle need not
        EditKind::StallHysteresis => (signals().map(|name| (*name).to_string()))
            .chain(["alpha".to_string(), "beta".to_string()])
            .filter(|name| ["alpha", "beta"].contains(&name.as_str()))
            .collect::<BTreeSet<String>>()
            .into_iter()
            .collect(),
        EditKind::Wind => ["constant", "ramp", "shear"].map(String::from).to_vec(),
        EditKind::StructuralMode => inputs.iter().map(|name| (*name).to_string()).collect(),
        _ => Vec::new(),
    };
    let of = |target: &&str| {
        let plain = Edit::new(kind, *target);
        if terms.is_empty() {
            vec![plain]
        } else {
            let with = |term: &String| plain.clone().with_term(term.as_str());
            // what scales with dynamic pressure are the derivatives of the whole model
            let is_meant = |term: &&String| term.as_str() != "qbar" || *target == "all";
            terms.iter().filter(is_meant).map(with).collect()
        }
    };
    targets.iter().flat_map(of).collect()
}

fn largest(series: &[f64]) -> f64 {
    series.iter().map(|y| y.abs()).fold(0.0, f64::max)
}

/// Of an output's size, what is left to rounding where an equation is written otherwise.
const ROUNDING: f64 = 1e-12;

#[test]
fn every_effect_contains_its_own_absence() {
    let mut worst = (0.0, String::new());
    for kind in EditKind::ALL {
        let mut tried = 0;
        for name in MODELS {
            let before = catalog::find(name).expect("a catalog model");
            let declared = outputs(&before, &[]);
            for edit in edits(&before, kind) {
                let Ok(edited) = edit.apply(&before) else {
                    continue;
                };
                // a rate in its own equation is refused there
                if Model::compile(&edited.document).is_err() {
                    continue;
                }
                let what = format!("{name}, {edit:?}");
                let absence = edited.absence();
                let values: Vec<(&str, f64)> = absence
                    .iter()
                    .map(|(name, value)| (name.as_str(), *value))
                    .collect();
                let size = &edited.added[0].name;
                // a fixed parameter may be read off the data
                assert!(
                    absence.contains_key(size) || kind == EditKind::FixedParameter,
                    "{what}: where is {size} absent?"
                );
                let found = outputs(&edited.document, &values);
                for (output, y) in &declared {
                    let apart = y.iter().zip(&found[output]).map(|(a, b)| (a - b).abs());
                    let apart = apart.fold(0.0, |a: f64, b| if b.is_nan() { b } else { a.max(b) });
                    let share = apart / largest(y).max(1e-6);
                    assert!(share <= ROUNDING, "{what}: {output} is {share:e} apart");
                    if share > worst.0 {
                        worst = (share, what.clone());
                    }
                }
                tried += 1;
            }
        }
        println!("{:20} {tried} edits", kind.name());
        assert!(tried > 2, "{kind:?} is hardly tried");
    }
    println!("farthest apart: {:.1e}, {}", worst.0, worst.1);
}

/// The values of absence are in the ranges of the parameters, and the outputs have derivatives there.
#[test]
fn absence_is_within_reach() {
    for kind in EditKind::ALL {
        for name in MODELS {
            let before = catalog::find(name).expect("a catalog model");
            for edit in edits(&before, kind) {
                let Ok(edited) = edit.apply(&before) else {
                    continue;
                };
                for (parameter, value) in edited.absence() {
                    let range = &edited.document.parameters[&parameter];
                    let inside = range.lower.is_none_or(|lower| lower <= value)
                        && range.upper.is_none_or(|upper| value <= upper);
                    assert!(inside, "{name}, {edit:?}: {parameter} = {value}");
                }
            }
        }
    }
    let before = catalog::find("short-period").expect("a catalog model");
    // but for a delay of the input, which jumps: it has no slope where it is recorded
    for (kind, target) in [
        (EditKind::Backlash, "de"),
        (EditKind::ActuatorLag, "de"),
        (EditKind::SensorLag, "q"),
        (EditKind::SensorDelay, "q"),
    ] {
        let edited = Edit::new(kind, target).apply(&before).expect("an edit");
        let name = edited.added[0].name.as_str();
        let moved = |value: f64| outputs(&edited.document, &[(name, value)])["q"].clone();
        // both sides of no effect, though the range ends there
        let (none, little) = (moved(0.0), moved(1e-6));
        let less = moved(-1e-6);
        let slopes = little.iter().zip(&less).map(|(a, b)| (a - b) / 2e-6);
        let [before_it, after_it] = [&less, &little].map(|other| {
            let way = other.iter().zip(&none).map(|(a, b)| (a - b).abs());
            way.fold(0.0, f64::max)
        });
        let largest = slopes.fold(0.0, |a: f64, b| a.max(b.abs()));
        assert!(largest > 0.01, "{kind:?}: {largest}");
        assert!((before_it / after_it - 1.0).abs() < 0.01, "{kind:?}");
    }
}
