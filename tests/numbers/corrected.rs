//! What a flight path reconstruction finds wrong with a recording is taken out of it.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::common::plans::{parameter, plan, solve};
use crate::common::reconstruction;
use serde_json::json;
use trimtab_core::flight::{Channel, Maneuver, Unit};
use trimtab_core::job;

#[test]
fn a_corrected_recording_has_no_errors_left() {
    let truth = reconstruction::Truth::new();
    let recorded = truth.recording(7, 1.0);
    let mut channels = recorded.channels().clone();
    let elevator = (0..recorded.len())
        .map(|k| f64::from(k as u32 % 7))
        .collect();
    let elevator = Channel::from_recorded("deg", Unit::parse("deg").unwrap(), elevator);
    channels.insert("de".to_string(), elevator.clone());
    let recorded = Arc::new(Maneuver::new(recorded.time().to_vec(), channels).unwrap());

    let model = json!("flight-path-reconstruction");
    let plan = plan(model.clone(), json!({}), std::slice::from_ref(&recorded));
    let result = job::run(&plan, &mut |_| ControlFlow::Continue(())).unwrap();
    let corrected = job::corrected(&plan, &result.estimate, std::slice::from_ref(&recorded));
    let [made] = &corrected.unwrap()[..] else {
        panic!("one recording");
    };
    assert_eq!((made.segment.as_str(), made.of), ("1", 0));
    let corrected = &made.maneuver;
    // what the model says nothing of is as it was
    assert_eq!(corrected.channels()["de"], elevator);
    let known = corrected.channels();
    for name in [
        "ax", "p", "V", "alpha", "beta", "x", "phi", "theta", "psi", "u", "W_x",
    ] {
        assert!(known.contains_key(name), "no {name} in {:?}", known.keys());
    }

    // the vane is 0.7 deg and 8 % off; what the truth is, a recording without noise and the errors put into it tell
    let clean = truth.recording(7, 0.0);
    let of_truth = |name: &str| truth.parameters[name];
    let vanes = ["alpha", "beta"].map(|name| &clean.channels()[name].values);
    let alpha = |k: usize| {
        let beta = (vanes[1][k] - of_truth("beta_bias")) / (1.0 + of_truth("K_beta"));
        let own = vanes[0][k] - of_truth("alpha_bias") - of_truth("K_beta_alpha") * beta;
        own / (1.0 + of_truth("K_alpha"))
    };
    let rms = |maneuver: &Maneuver| {
        let recorded = maneuver.channels()["alpha"].values.iter().enumerate();
        let squares: f64 = recorded.map(|(k, value)| (value - alpha(k)).powi(2)).sum();
        (squares / maneuver.len() as f64).sqrt().to_degrees()
    };
    let (before, after) = (rms(&recorded), rms(corrected));
    eprintln!("alpha: RMS error {before:.3} deg before, {after:.4} deg after");
    assert!(before > 1.0 && after < 0.05, "{before}, {after}");

    let corrected = Arc::new(corrected.clone());
    let again = solve(model, json!({}), &[corrected]);
    for (name, of_one) in [
        ("ax_bias", 1.0),
        ("az_bias", 1.0),
        ("q_bias", 0.1),
        ("alpha_bias", 0.1),
        ("K_alpha", 1.0),
        ("beta_bias", 0.1),
        ("V_bias", 10.0),
    ] {
        let left = parameter(&again, name).estimate / of_one;
        assert!(left.abs() < 1e-4, "{name}: {left}");
    }
}
