//! Samples and models that cannot be followed.

use serde_json::{Value, json};
use trimtab_core::flight::Fault;
use trimtab_core::model::{Model, ModelDocument, catalog};
use trimtab_core::recursive::{Sample, SampleFault, Setup, Tracker, TrackingMethod};

use super::changes::changing;
use super::{elevator, filter_options, known_starts, options, push, recorded, tracker};

/// A sample that is refused changes nothing; what is not measured is left out.
#[test]
fn samples_that_cannot_be_taken_are_refused_and_change_nothing() {
    let plan = elevator(recorded(), known_starts());
    let segment = &plan.problem.segments[0];
    let band = json!({"method": "rft", "frequency": {"band_hz": [0.1, 1.5]}});
    for asked in [json!({"method": "rls"}), band.clone(), filter_options()] {
        let (mut clean, mut disturbed) =
            (tracker(&plan, asked.clone()), tracker(&plan, asked.clone()));
        for k in 0..300 {
            push(&mut clean, segment, k).expect("a sample");
            if k % 7 == 3 {
                let sample = |time: f64, inputs: &[f64], outputs: &[f64]| {
                    let sample = Sample {
                        time,
                        inputs,
                        outputs,
                    };
                    disturbed.push(&sample).map(|_| ()).expect_err("a fault")
                };
                let mut refuse = sample;
                let time = segment.time[k];
                assert_eq!(refuse(f64::NAN, &[0.0], &[0.0; 2]), SampleFault::NoTime);
                let before = segment.time[k - 1];
                assert_eq!(
                    refuse(before, &[0.0], &[0.0; 2]),
                    SampleFault::NotLater {
                        time: before,
                        before
                    }
                );
                assert!(
                    matches!(refuse(time, &[f64::NAN], &[0.0; 2]), SampleFault::NoInput { name } if name == "de")
                );
                assert!(matches!(
                    refuse(time, &[0.0; 2], &[0.0; 2]),
                    SampleFault::Width {
                        what: "inputs",
                        found: 2,
                        wanted: 1
                    }
                ));
                if asked["method"] == "rft" {
                    assert!(matches!(
                        refuse(time + 0.04, &[0.0], &[0.0; 2]),
                        SampleFault::Uneven { .. }
                    ));
                }
            }
            push(&mut disturbed, segment, k).expect("a sample");
        }
        // before the maneuver nothing is known of some
        let same = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits());
        assert!(
            same(&clean.estimates().values, &disturbed.estimates().values),
            "{asked}"
        );
        assert!(
            clean
                .estimates()
                .values
                .iter()
                .all(|value| value.is_finite()),
            "{asked}: {:?}",
            clean.estimates()
        );
        let none = [f64::NAN; 2];
        let sample = Sample {
            time: segment.time[300],
            inputs: &[segment.inputs[0][300]],
            outputs: &none,
        };
        let after = clean
            .push(&sample)
            .expect("a sample without outputs")
            .clone();
        assert!(
            after.values.iter().all(|value| value.is_finite()),
            "{asked}: {after:?}"
        );
    }
    // the elevator does not move in the first 6 s
    let mut still = tracker(&plan, json!({"method": "rls"}));
    for k in 0..100 {
        push(&mut still, segment, k).expect("a sample");
    }
    let unknown = still.estimates().clone();
    for (i, parameter) in still.parameters().iter().enumerate() {
        let of_elevator = ["Zde", "Mde"].contains(&parameter.name.as_str());
        assert_eq!(unknown.values[i].is_nan(), of_elevator, "{unknown:?}");
        assert_eq!(
            unknown.standard_errors[i].is_nan(),
            of_elevator,
            "{unknown:?}"
        );
    }
}

#[test]
fn what_a_method_cannot_follow_is_refused_with_the_remedy() {
    let plan = elevator(recorded(), json!({}));
    let setup = Setup::of_problem(&plan.problem).expect("a segment");
    let refused = |setup: &Setup, asked: Value| -> Vec<(String, String)> {
        let faults: Vec<Fault> = Tracker::new(setup, &options(asked.clone()))
            .err()
            .unwrap_or_else(|| panic!("{asked} is taken"))
            .into();
        faults
            .into_iter()
            .map(|fault| (fault.pointer, fault.message))
            .collect()
    };
    let cases = [
        (
            json!({"method": "rls", "forgetting": 0.0}),
            "/forgetting",
            "above 0",
        ),
        (
            json!({"method": "rls", "forgetting": 1.01}),
            "/forgetting",
            "at most 1",
        ),
        (
            json!({"method": "rls", "half_width": 1}),
            "/half_width",
            "2 to 64",
        ),
        (
            json!({"method": "rls", "frequency": {"band_hz": [0.1, 1.0]}}),
            "/frequency",
            "use rft",
        ),
        (
            json!({"method": "rls", "noise": {"q": 1.0}}),
            "/noise",
            "use ekf",
        ),
        (json!({"method": "rft"}), "/frequency", "band_hz"),
        (
            json!({"method": "rft", "frequency": {"band_hz": [1.0, 0.1]}}),
            "/frequency/band_hz",
            "above that",
        ),
        (
            json!({"method": "rft", "frequency": {"band_hz": [0.1, 9.0], "step_hz": 1e-3}}),
            "/frequency",
            "500",
        ),
        (
            json!({"method": "ekf"}),
            "/noise/alpha",
            "standard deviation",
        ),
        (
            json!({"method": "ekf", "noise": {"alpha": -1.0, "q": 1.0}}),
            "/noise/alpha",
            "above 0",
        ),
        (
            json!({"method": "ekf", "noise": {"alpha": 1.0, "q": 1.0}}),
            "/uncertainty/q_bias",
            "starts from 0",
        ),
        (
            json!({"method": "ekf", "noise": {"alpha": 1.0, "q": 1.0, "x": 1.0}}),
            "/noise/x",
            "alpha, q",
        ),
    ];
    for (asked, pointer, word) in cases {
        let faults = refused(&setup, asked.clone());
        let found = faults.iter().find(|(at, _)| at == pointer);
        let (_, message) = found.unwrap_or_else(|| panic!("{asked}: {faults:?}"));
        assert!(message.contains(word), "{asked}: {message}");
    }
    let model = |change: &dyn Fn(&mut Value)| {
        let (document, _) = changing(1);
        let mut document = serde_json::to_value(document).expect("JSON");
        change(&mut document);
        let document: ModelDocument = serde_json::from_value(document).expect("a document");
        Setup::of_model(Model::compile(&document).expect("a model"))
    };
    let rls = json!({"method": "rls"});
    let product = model(&|document| {
        document["states"]["q"]["derivative"] = json!("Ma*alpha + Mq*Ma/Mde*q + Mde*de")
    });
    assert!(
        refused(&product, rls.clone())[0]
            .1
            .contains("not linear in Ma, Mq, Mde together"),
        "{:?}",
        refused(&product, rls.clone())
    );
    let unseen = model(&|document| document["outputs"]["q"]["equation"] = json!("q + Mq*alpha"));
    assert!(
        refused(&unseen, rls.clone())[0]
            .1
            .contains("no output measures q")
    );
    let late = model(&|document| {
        document["parameters"]["tau"] = json!({"unit": "s", "start": 0.1, "fixed": true});
        document["inputs"]["de"]["delay"] = json!("tau");
    });
    assert!(
        refused(&late, rls.clone())[0].1.contains("de has a delay"),
        "{:?}",
        refused(&late, rls.clone())
    );
    let held = model(&|document| {
        for (_, parameter) in document["parameters"].as_object_mut().expect("parameters") {
            parameter["fixed"] = json!(true);
        }
    });
    assert!(refused(&held, rls)[0].1.contains("no parameter is free"));
    assert_eq!(
        TrackingMethod::ALL.map(TrackingMethod::name),
        ["rls", "rft", "ekf"]
    );
}

/// Short period without a recording: what starts from one has no start, which only a filter misses.
#[test]
fn a_model_without_data_is_followed_where_starts_do_not_matter() {
    let document = catalog::find("short-period").expect("a catalog model");
    let setup = Setup::of_model(Model::compile(&document).expect("a model"));
    let plan = elevator(recorded(), json!({}));
    let segment = &plan.problem.segments[0];
    let mut with_data = tracker(&plan, json!({"method": "rls"}));
    let mut without = Tracker::new(&setup, &options(json!({"method": "rls"}))).expect("a tracker");
    for k in 0..segment.len() {
        push(&mut with_data, segment, k).expect("a sample");
        push(&mut without, segment, k).expect("a sample");
    }
    // a trim value only shifts an equation, which has a constant
    let both = with_data.finish().clone();
    let found = without.finish();
    for (i, error) in both.standard_errors.iter().enumerate() {
        let apart = (found.values[i] - both.values[i]).abs();
        assert!(apart < 1e-8 * error, "{i}: {apart:e}");
    }
    let faults: Vec<Fault> = Tracker::new(&setup, &options(filter_options()))
        .err()
        .expect("faults")
        .into();
    let places: Vec<&str> = faults.iter().map(|fault| fault.pointer.as_str()).collect();
    for name in ["alpha_eq", "de_eq", "alpha_0"] {
        assert!(
            places.contains(&format!("/parameters/{name}/start").as_str()),
            "{places:?}"
        );
    }
}

/// An unstable model that is driven hard: the filter says that it is at an end, and goes on saying so.
#[test]
fn a_filter_that_leaves_the_range_of_numbers_says_so() {
    let (document, _) = changing(1);
    let mut document = serde_json::to_value(document).expect("JSON");
    document["parameters"]["Ma"]["start"] = json!(1e6);
    let document: ModelDocument = serde_json::from_value(document).expect("a document");
    let setup = Setup::of_model(Model::compile(&document).expect("a model"));
    let asked = json!({"method": "ekf", "noise": {"alpha": 1e-3, "q": 1e-3}});
    let mut tracker = Tracker::new(&setup, &options(asked)).expect("a tracker");
    let mut refused = 0;
    for k in 0..200 {
        let none = [f64::NAN; 2];
        let sample = Sample {
            time: f64::from(k),
            inputs: &[1.0],
            outputs: &none,
        };
        match tracker.push(&sample) {
            Ok(_) => assert_eq!(refused, 0, "it takes samples again"),
            Err(fault) => {
                assert_eq!(fault, SampleFault::Diverged);
                refused += 1;
            }
        }
    }
    assert!(refused > 0);
    assert!(
        tracker
            .estimates()
            .standard_errors
            .iter()
            .all(|error| error.is_nan())
    );
}
