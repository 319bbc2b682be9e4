//! What the bundled flights have in them and the model does not declare is named by a diagnosis.

use std::ops::ControlFlow;

use crate::common::recordings::maneuver;
use crate::common::repository;
use serde_json::{Value, json};
use trimtab_core::diagnose::{Diagnosis, NamedEffect, Verdict};
use trimtab_core::estimate::Role;
use trimtab_core::job::{self, JobSpec};
use trimtab_core::model::catalog;
use trimtab_core::simulate::{Scenario, ScenarioEffect};

fn read(name: &str) -> Vec<u8> {
    std::fs::read(repository::path(&format!("data/effects/{name}"))).expect("a file")
}

fn scenario(name: &str) -> Scenario {
    let text = String::from_utf8(read(&format!("{name}-fit.toml"))).expect("text");
    toml::from_str(&text).expect("a scenario")
}

/// The diagnosis of the three recordings of that name, with these parameters changed.
fn diagnosis(name: &str, parameters: Value) -> Diagnosis {
    let roles = [
        ("fit", "estimation"),
        ("check", "validation"),
        ("final", "final"),
    ];
    let files = roles.map(|(file, role)| (format!("{name}-{file}.csv"), role));
    diagnosis_of(&scenario(name).model, &files, parameters)
}

fn diagnosis_of(model: &str, files: &[(String, &'static str)], parameters: Value) -> Diagnosis {
    diagnosis_in("data/effects", model, files, parameters)
}

fn diagnosis_in(
    folder: &str,
    model: &str,
    files: &[(String, &'static str)],
    parameters: Value,
) -> Diagnosis {
    let read = |(file, role): &(String, &'static str)| {
        let path = repository::path(&format!("{folder}/{file}"));
        (file.clone(), std::fs::read(path).expect("a file"), *role)
    };
    let files: Vec<_> = files.iter().map(read).collect();
    diagnosis_of_tables(model, &files, parameters)
}

/// Of tables with labels and roles.
fn diagnosis_of_tables(
    model: &str,
    tables: &[(String, Vec<u8>, &str)],
    parameters: Value,
) -> Diagnosis {
    let (mut maneuvers, mut uses) = (Vec::new(), Vec::new());
    for (label, table, role) in tables {
        let maneuver = maneuver(table);
        uses.push(json!({"id": maneuver.digest(), "label": label, "role": role}));
        maneuvers.push(maneuver);
    }
    let spec =
        json!({"kind": "diagnose", "model": model, "maneuvers": uses, "parameters": parameters});
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    let document = catalog::find(model).expect("a catalog model");
    let plan = job::prepare(&spec, &document, &maneuvers).expect("a plan");
    let result = job::run_diagnosis(&plan, &mut |_| ControlFlow::Continue(())).expect("a result");
    result.diagnosis.expect("a diagnosis")
}

/// Whether the effect, or one that the data cannot tell from it, is this one.
fn contains(named: &NamedEffect, truth: &ScenarioEffect) -> bool {
    // a scenario says the unit of a channel beside its name
    let bare = |term: &Option<String>| {
        let name = term.as_deref().unwrap_or_default();
        name.split('[').next().unwrap_or_default().to_string()
    };
    (named.group.iter()).any(|member| {
        let effect = &member.effect;
        (effect.word(), &effect.target) == (truth.kind.clone(), &truth.target)
            && (effect.term.is_none()
                // a scenario flies one maneuver, of which it has no label
                || truth.kind == "gust"
                || bare(&effect.term) == bare(&truth.term))
    })
}

/// All effects of the scenario are named, nothing else is, and their size is right.
#[track_caller]
fn names_the_truth(name: &str, diagnosis: &Diagnosis) {
    let truth = scenario(name).effects;
    let said = &diagnosis.sentence;
    assert!(
        matches!(diagnosis.verdict, Verdict::Named | Verdict::NamedGroup),
        "{name}: {said}"
    );
    assert_eq!(diagnosis.effects.len(), truth.len(), "{name}: {said}");
    for effect in truth {
        let named = diagnosis
            .effects
            .iter()
            .find(|named| contains(named, &effect));
        let named = named.unwrap_or_else(|| panic!("{name}, {effect:?}: {said}"));
        if (named.effect.word(), &named.effect.target) != (effect.kind.clone(), &effect.target) {
            continue;
        }
        let mut values = effect
            .value
            .into_iter()
            .chain(effect.values.values().copied());
        for parameter in &named.parameters {
            let value = values.next().expect("as many values as parameters");
            let error = parameter.standard_error.expect("an error bound");
            let off = (parameter.estimate - value).abs() / error;
            assert!(
                off < 4.0,
                "{name}, {parameter:?}: {off:.1} standard errors off"
            );
        }
    }
}

/// RMS errors on the flight that no decision saw, after over before, by output.
fn ratios(diagnosis: &Diagnosis) -> Vec<f64> {
    let last = diagnosis.fits.iter().filter(|fit| fit.role == Role::Final);
    last.map(|fit| fit.after.rms / fit.before.rms).collect()
}

/// Names the truth, and predicts the final flight better: one output clearly, and none noticeably worse.
#[track_caller]
fn closes_the_loop(name: &str) {
    let diagnosis = diagnosis(name, json!({}));
    names_the_truth(name, &diagnosis);
    let ratios = ratios(&diagnosis);
    let best = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let worst = ratios.iter().copied().fold(0.0, f64::max);
    assert!(best < 0.9 && worst < 1.05, "{name}: {ratios:?}");
}

#[test]
fn a_lag_of_the_elevator() {
    closes_the_loop("elevator-lag");
}

#[test]
fn play_in_the_elevator() {
    closes_the_loop("elevator-backlash");
}

#[test]
fn a_curved_pitching_moment() {
    closes_the_loop("pitch-curve");
}

#[test]
fn an_aileron_that_is_recorded_off_its_place() {
    closes_the_loop("aileron-bias");
}

#[test]
fn a_wrong_scale_of_the_yaw_gyro() {
    closes_the_loop("yaw-gyro-scale");
}

#[test]
fn a_vane_on_a_boom() {
    closes_the_loop("vane-arm");
}

#[test]
fn a_late_sideslip_vane() {
    closes_the_loop("beta-delay");
}

#[test]
fn a_spoiler_that_the_model_does_not_have() {
    closes_the_loop("spoiler");
}

#[test]
fn two_effects_at_once() {
    closes_the_loop("two-at-once");
}

/// A declared model that holds a parameter where it is not: freed, it is an effect, and stays one though the declared
/// model, fitted anew from there, would reach as low if it kept the value.
#[test]
fn a_parameter_that_is_held_where_it_is_not() {
    let files = [("elevator.csv".to_string(), "estimation")];
    let found = diagnosis_in(
        "data",
        "short-period",
        &files,
        json!({"Mq": {"start": -0.8, "fixed": true}}),
    );
    let [named] = &found.effects[..] else {
        panic!("{}", found.sentence);
    };
    // one flight cannot tell it from a vane that lags
    let mut members = named.group.iter().map(|member| member.effect.name());
    assert!(
        members.any(|name| name == "fixed_parameter of Mq"),
        "{}",
        found.sentence
    );
}

/// A gust is of its flight alone: what another meets it does not predict.
#[test]
fn a_gust() {
    names_the_truth("gust", &diagnosis("gust", json!({})));
}

/// With all derivatives free the short period imitates nearly all of a late vane; with Zq held it cannot.
#[test]
fn a_late_vane_shows_where_the_model_cannot_imitate_it() {
    let free = diagnosis("alpha-delay", json!({}));
    let truth = &scenario("alpha-delay").effects[0];
    assert!(
        free.effects.iter().all(|named| contains(named, truth)),
        "{}",
        free.sentence
    );
    let held = diagnosis("alpha-delay", json!({"Zq": {"start": 0.97, "fixed": true}}));
    names_the_truth("alpha-delay", &held);
    // its size in milliseconds, as the parameter has it
    let delay = &held.effects[0].parameters[0];
    let said = held.headline();
    let size = said
        .strip_prefix("alpha is recorded ")
        .and_then(|rest| rest.split_once(" ± "));
    let (size, rest) = size.expect("a size with its bound");
    let size: f64 = size.parse().expect("a number");
    assert!((size - 1e3 * delay.estimate).abs() < 0.1, "{said}");
    assert!(
        rest.ends_with(" ms late (alpha_delay)") && held.sentence.starts_with(&said),
        "{said}"
    );
}

#[test]
fn nothing_where_nothing_is_missing() {
    for (model, names) in [
        ("short-period", vec!["elevator"]),
        ("lateral-directional-4", vec!["aileron", "rudder"]),
    ] {
        let files = names
            .iter()
            .map(|name| (format!("../{name}.csv"), "estimation"));
        let files: Vec<_> = files.collect();
        let diagnosis = diagnosis_of(model, &files, json!({}));
        let said = &diagnosis.sentence;
        assert_eq!(
            diagnosis.verdict,
            Verdict::NothingMissing,
            "{model}: {said}"
        );
        assert!(diagnosis.effects.is_empty(), "{model}: {said}");
    }
}

/// A yaw gyro whose scale is wrong in one flight of three has no size that holds in all.
#[test]
fn what_is_in_one_flight_alone_is_no_effect_of_all() {
    let files = [
        ("yaw-gyro-scale-fit.csv", "estimation"),
        ("../aileron.csv", "estimation"),
        ("../rudder.csv", "estimation"),
    ];
    let files = files.map(|(file, role)| (file.to_string(), role));
    let diagnosis = diagnosis_of("lateral-directional-4", &files, json!({}));
    let said = &diagnosis.sentence;
    assert_eq!(diagnosis.verdict, Verdict::Unexplained, "{said}");
    assert!(
        said.contains("but not as such in all") || diagnosis.effects.is_empty(),
        "{said}"
    );
    let gyro = |named: &NamedEffect| named.effect.name() == "sensor_scale of r";
    assert!(!diagnosis.effects.iter().any(gyro), "{said}");
}

/// The lateral flights in which nothing is missing, each line of their tables changed.
fn changed(change: impl Fn(usize, &str) -> String) -> Diagnosis {
    let tables = ["aileron", "rudder"].map(|name| {
        let path = repository::path(&format!("data/{name}.csv"));
        let text = std::fs::read_to_string(path).expect("a file");
        let lines: Vec<String> = (text.lines().enumerate())
            .map(|(number, line)| change(number, line))
            .collect();
        (
            name.to_string(),
            lines.join("\n").into_bytes(),
            "estimation",
        )
    });
    diagnosis_of_tables("lateral-directional-4", &tables, json!({}))
}

/// The gyros of roll and yaw under each other's title.
#[test]
fn channels_under_each_others_name() {
    let diagnosis = changed(|number, line| match number {
        0 => (line.replace(",p[", ",?["))
            .replace(",r[", ",p[")
            .replace(",?[", ",r["),
        _ => line.to_string(),
    });
    let said = &diagnosis.sentence;
    assert_eq!(
        diagnosis.effects[0].effect.name(),
        "swapped_channels of p+r",
        "{said}"
    );
    let share = diagnosis.effects[0].parameters[0].estimate;
    assert!((share - 1.0).abs() < 0.02, "{share}");
}

/// A yaw gyro that sees a tenth of the roll rate.
#[test]
fn a_gyro_off_its_axis() {
    let place = std::cell::OnceCell::new();
    let column = |title: &str, line: &str| {
        let mut titles = line.split(',');
        titles
            .position(|found| found.starts_with(title))
            .expect("a column")
    };
    let diagnosis = changed(|number, line| {
        if number == 0 {
            place.get_or_init(|| (column("p[", line), column("r[", line)));
            return line.to_string();
        }
        let &(p, r) = place.get().expect("titles come first");
        let mut cells: Vec<String> = line.split(',').map(String::from).collect();
        let rates = [p, r].map(|at| cells[at].parse::<f64>().expect("a number"));
        cells[r] = (rates[1] + 0.1 * rates[0]).to_string();
        cells.join(",")
    });
    let said = &diagnosis.sentence;
    assert_eq!(
        diagnosis.effects[0].effect.name(),
        "sensor_cross_axis of r (p)",
        "{said}"
    );
    let size = &diagnosis.effects[0].parameters[0];
    let error = size.standard_error.expect("an error bound");
    assert!(
        (size.estimate - 0.1).abs() < 3.0 * error && error < 0.02,
        "{size:?}"
    );
}
