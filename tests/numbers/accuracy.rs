//! What an answer says beside the estimates: prediction of maneuvers that were not fitted, fits with their shares,
//! error bounds that would mean nothing, near dependencies by name.

use std::ops::ControlFlow;
use std::sync::Arc;

use serde_json::{Value, json};
use trimtab_core::estimate::{ErrorBoundsKind, Outcome, Role};
use trimtab_core::flight::Maneuver;
use trimtab_core::job::{self, Faults, JobResult, JobSpec};
use trimtab_core::model::{Model, ModelDocument, catalog};
use trimtab_core::simulate::Scenario;

/// The short period whose initial angle of attack each maneuver estimates for itself.
fn document() -> ModelDocument {
    let mut document = catalog::find("short-period").expect("a catalog model");
    document.parameters["alpha_0"].fixed = false;
    document.parameters["de_eq"].fixed = true;
    document
}

/// The bundled elevator maneuver with another seed and another start, with or without noise.
fn recording(seed: u64, alpha_0: f64, noise: f64) -> Arc<Maneuver> {
    let mut scenario: Scenario =
        toml::from_str(include_str!("../../data/elevator.toml")).expect("a scenario");
    scenario.seed = seed;
    scenario.truth["alpha_0"] = alpha_0;
    for output in scenario.outputs.values_mut() {
        output.noise *= noise;
    }
    let model = Model::compile(&document()).expect("a model");
    Arc::new(scenario.fly(&model).expect("a maneuver"))
}

fn run(
    document: &ModelDocument,
    spec: Value,
    recordings: &[Arc<Maneuver>],
) -> Result<JobResult, Faults> {
    let spec: JobSpec = serde_json::from_value(spec).expect("a spec");
    let plan = job::prepare(&spec, document, recordings)?;
    job::run(&plan, &mut |_| ControlFlow::Continue(()))
}

#[test]
fn a_maneuver_that_took_no_part_is_predicted() {
    let (first, second) = (recording(1, 0.06, 1.0), recording(2, 0.075, 1.0));
    let alone = json!({"model": "m", "maneuvers": [{"id": "a", "label": "fit"}]});
    let alone = run(&document(), alone, std::slice::from_ref(&first)).expect("a result");
    let both = json!({"model": "m", "maneuvers": [
        {"id": "a", "label": "fit"}, {"id": "b", "label": "other", "role": "validation"},
    ]});
    let both = run(&document(), both, &[first.clone(), second]).expect("a result");

    // it changes nothing of the estimate
    assert_eq!(both.estimate.parameters, alone.estimate.parameters);
    assert_eq!(both.estimate.samples, 626);

    let [prediction] = both.estimate.prediction.as_slice() else {
        panic!("one prediction")
    };
    assert_eq!(prediction.segment, "other");
    assert_eq!(
        prediction.outcome,
        Outcome::Converged,
        "{}",
        prediction.reason
    );
    // its own initial state is estimated on it: 0.075 rad, not the 0.06 of the other
    let [own] = prediction.parameters.as_slice() else {
        panic!("alpha_0 alone")
    };
    let off = (own.estimate - 0.075).abs() / own.standard_error.expect("an error bound");
    assert!(own.name == "alpha_0" && off < 5.0, "{own:?}");
    // the noise is 0.05 and 0.08 deg: an rms of 626 samples is known to 3 %, the prediction adds less
    for (output, noise) in prediction.outputs.iter().zip([0.05_f64, 0.08]) {
        let rms = output.rms.to_degrees();
        assert!((rms / noise - 1.0).abs() < 0.1, "{output:?}");
        assert!(output.r_squared > 0.99);
    }
    let roles: Vec<(&str, Role)> = (both.histories.iter())
        .map(|history| (history.segment.as_str(), history.role))
        .collect();
    assert_eq!(
        roles,
        [("fit", Role::Estimation), ("other", Role::Validation)]
    );

    // with the initial state held there is nothing to estimate on it: it is simulated
    let mut held = json!({"model": "m", "maneuvers": [
        {"id": "a", "label": "fit"}, {"id": "b", "label": "same", "role": "validation"},
    ]});
    held["parameters"] = json!({"alpha_0": {"fixed": true, "start": 0.06}});
    let held = run(&document(), held, &[first.clone(), first.clone()]).expect("a result");
    let (fitted, predicted) = (&held.estimate.outputs, &held.estimate.prediction[0].outputs);
    assert!(
        held.estimate.prediction[0]
            .parameters
            .iter()
            .all(|p| p.fixed)
    );
    for (fitted, predicted) in fitted.iter().zip(predicted) {
        assert!((fitted.rms - predicted.rms).abs() < 1e-12 * fitted.rms);
    }

    let none = json!({"model": "m", "maneuvers": [{"id": "a", "role": "validation"}]});
    let faults = run(&document(), none, &[first]).expect_err("a refusal");
    assert_eq!(
        (faults[0].pointer.as_str(), &*faults[0].code),
        ("/maneuvers", "no_maneuvers")
    );
}

#[test]
fn shares_of_the_residual_add_up_and_say_what_is_wrong() {
    let spec = |bias: f64| {
        json!({"model": "m", "maneuvers": [{"id": "a"}],
            "parameters": {"q_bias": {"fixed": true, "start": bias}, "alpha_0": {"fixed": true}}})
    };
    let recordings = [recording(1, 0.06, 1.0)];
    let good = run(&document(), spec(0.002), &recordings).expect("a result");
    let q = &good.estimate.outputs[1];
    assert!(q.theil_shares.covariance > 0.95, "{q:?}");
    // 626 white samples: the autocorrelation scatters by 0.04
    assert!(
        q.autocorrelation.abs() < 0.16 && q.effective_samples > 300.0,
        "{q:?}"
    );
    // a bias that the model is made to have, without a state that could follow it
    let mut rigid = document();
    for name in ["Za", "Zq", "Zde", "Ma", "Mq", "Mde", "alpha_eq"] {
        let truth: Scenario =
            toml::from_str(include_str!("../../data/elevator.toml")).expect("one");
        rigid.parameters[name].fixed = true;
        rigid.parameters[name].start = trimtab_core::model::Start::Value(truth.truth[name]);
    }
    let mut biased = spec(0.02);
    biased["parameters"]["alpha_0"] = json!({"fixed": false});
    let biased = run(&rigid, biased, &recordings).expect("a result");
    for fit in good.estimate.outputs.iter().chain(&biased.estimate.outputs) {
        let shares = fit.theil_shares;
        let sum = shares.bias + shares.variance + shares.covariance;
        assert!((sum - 1.0).abs() < 1e-9, "{fit:?}");
    }
    let q = &biased.estimate.outputs[1];
    assert!(
        q.theil_shares.bias > 0.9 && q.effective_samples < 60.0,
        "{q:?}"
    );
}

#[test]
fn a_perfect_fit_has_no_error_bounds() {
    // made by the model itself at the recording's own step: what is left is rounding
    let with_noise = recording(1, 0.06, 1.0);
    let spec = json!({"model": "m", "maneuvers": [{"id": "a"}]});
    let fitted =
        run(&document(), spec.clone(), std::slice::from_ref(&with_noise)).expect("a result");
    let mut channels = with_noise.channels().clone();
    for output in &fitted.histories[0].outputs {
        channels[&output.name].values.clone_from(&output.model);
    }
    let perfect = Arc::new(Maneuver::new(with_noise.time().to_vec(), channels).expect("one"));
    let exact = run(&document(), spec, std::slice::from_ref(&perfect))
        .expect("a result")
        .estimate;
    assert_eq!(exact.error_bounds, None, "{:?}", exact.outputs);
    assert!(exact.parameters.iter().all(|p| p.standard_error.is_none()));
    assert!(exact.remarks()[0].contains("error bounds would mean nothing"));
    assert!(
        exact
            .parameters
            .iter()
            .all(|p| exact.remark(p) != "not determined by the data")
    );
    // a variance that is given means what it says, fit or no fit
    let given = json!({"model": "m", "maneuvers": [{"id": "a"}],
        "options": {"noise": {"kind": "given", "variance": [1e-6, 1e-6]}}});
    let given = run(&document(), given, &[perfect])
        .expect("a result")
        .estimate;
    assert_eq!(given.error_bounds, Some(ErrorBoundsKind::Conventional));
    assert!(given.parameters.iter().any(|p| p.standard_error.is_some()));
}

#[test]
fn the_conventional_bounds_can_be_asked_for() {
    let spec = json!({"model": "m", "maneuvers": [{"id": "a"}], "options": {"error_bounds": "conventional"}});
    let estimate = run(&document(), spec, &[recording(1, 0.06, 1.0)])
        .expect("a result")
        .estimate;
    assert_eq!(estimate.error_bounds, Some(ErrorBoundsKind::Conventional));
    for parameter in &estimate.parameters {
        assert_eq!(
            parameter.standard_error,
            parameter.conventional_standard_error
        );
    }
}

/// y = a u + b (u + 0.001 u^2): a and b are told apart by a thousandth of the signal only.
#[test]
fn near_dependencies_are_named_and_estimated_all_the_same() {
    let document: ModelDocument = serde_json::from_value(json!({
        "name": "near", "inputs": {"de": {"unit": "rad"}},
        "parameters": {"a": {"start": 1.0}, "b": {"start": 1.0}, "c": {"start": 0.0, "unit": "rad"}},
        "constants": {"k": {"value": 0.05, "unit": "1/rad"}},
        "outputs": {"alpha": {"unit": "rad", "equation": "a*de + b*(de + k*de^2) + c"}},
    }))
    .expect("a document");
    let spec = json!({"model": "m", "maneuvers": [{"id": "a"}]});
    let estimate = run(&document, spec, &[recording(1, 0.06, 1.0)])
        .expect("a result")
        .estimate;
    assert_eq!(estimate.outcome, Outcome::Converged, "{}", estimate.reason);
    let seen = estimate
        .identifiability
        .clone()
        .and_then(|both| both.after)
        .expect("it");
    assert!(seen.redundant.is_empty() && seen.unseen.is_empty());
    assert_eq!(seen.nearly_collinear.len(), 1, "{seen:?}");
    assert_eq!(seen.nearly_collinear[0].parameters, ["a", "b"]);
    assert!(seen.nearly_collinear[0].condition_index > 100.0);
    assert!(seen.condition_number >= seen.nearly_collinear[0].condition_index * (1.0 - 1e-9));
    assert_eq!(seen.highly_correlated[0].parameters, ["a", "b"]);
    assert!(seen.highly_correlated[0].correlation < -0.99);
    assert!(
        estimate
            .remarks()
            .iter()
            .any(|remark| remark.contains("a + b"))
    );
}
