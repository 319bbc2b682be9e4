//! Modes of an estimate: closed form, published eigenvalues, scatter over noise, and where there is no bound.

use std::sync::Arc;

use crate::common::estimation::{compiled, fly, scenario, solve};
use crate::common::recordings::maneuver;
use serde_json::{Map, Value, json};
use trimtab_core::estimate::{Estimate, Measure, Mode};
use trimtab_core::flight::Maneuver;
use trimtab_core::simulate::Scenario;

fn elevator() -> Arc<Maneuver> {
    maneuver(include_bytes!("../../data/elevator.csv"))
}

fn named(estimate: &Estimate, name: &str) -> f64 {
    let row = estimate.parameters.iter().find(|p| p.name == name);
    row.expect("the parameter").estimate
}

/// Standard error of a function of the free parameters with this gradient.
fn deviation(estimate: &Estimate, gradient: &[(&str, f64)]) -> f64 {
    let free: Vec<_> = estimate.parameters.iter().filter(|p| !p.fixed).collect();
    let place = |name: &str| {
        free.iter()
            .position(|p| p.name == name)
            .expect("a free parameter")
    };
    let mut variance = 0.0;
    for &(a, by_a) in gradient {
        for &(b, by_b) in gradient {
            let (i, j) = (place(a), place(b));
            let error = |k: usize| free[k].standard_error.expect("a bound");
            variance += by_a * by_b * estimate.correlation[i][j] * error(i) * error(j);
        }
    }
    variance.sqrt()
}

fn agrees(measure: Option<Measure>, value: f64, error: f64) {
    let measure = measure.expect("a measure");
    let found = measure.standard_error.expect("a bound");
    // eigenvalue algorithm against formula: rounding
    assert!(
        (measure.value / value - 1.0).abs() < 1e-10,
        "{measure} {value}"
    );
    assert!((found / error - 1.0).abs() < 1e-8, "{found} {error}");
}

/// A = [[Za, Zq], [Ma, Mq]]: ωn² = Za Mq - Zq Ma, 2 ζ ωn = -(Za + Mq).
#[test]
fn the_short_period_is_that_of_the_closed_form() {
    let estimate = solve("short-period", &elevator(), &json!({})).estimate;
    let [za, zq, ma, mq] = ["Za", "Zq", "Ma", "Mq"].map(|name| named(&estimate, name));
    let frequency = (za * mq - zq * ma).sqrt();
    let damping = -(za + mq) / (2.0 * frequency);
    let by = [mq, -ma, -zq, za].map(|d| d / (2.0 * frequency));
    let names = ["Za", "Zq", "Ma", "Mq"];
    let frequency_by: Vec<(&str, f64)> = names.into_iter().zip(by).collect();
    let direct = [-1.0, 0.0, 0.0, -1.0].map(|d| d / (2.0 * frequency));
    let damping_by: Vec<(&str, f64)> = (names.into_iter().zip(by).zip(direct))
        .map(|((name, by), direct)| (name, direct - damping / frequency * by))
        .collect();
    assert_eq!(estimate.modes.len(), 1);
    let mode = &estimate.modes[0];
    agrees(
        mode.natural_frequency,
        frequency,
        deviation(&estimate, &frequency_by),
    );
    agrees(
        mode.damping_ratio,
        damping,
        deviation(&estimate, &damping_by),
    );
    let real_by = [("Za", 0.5), ("Mq", 0.5)];
    let half = std::f64::consts::LN_2 / -mode.real.value;
    let half_error = deviation(&estimate, &real_by) * half / -mode.real.value;
    agrees(mode.time_to_half, half, half_error);
    let period = std::f64::consts::TAU / (frequency * (1.0 - damping * damping).sqrt());
    assert!((mode.period.expect("a period").value / period - 1.0).abs() < 1e-10);
    assert_eq!((&mode.segment, mode.remark.as_str()), (&None, ""));
    assert_eq!((mode.time_constant, mode.time_to_double), (None, None));
}

#[track_caller]
fn near(modes: &[Mode], published: &[(f64, f64)], within: f64) {
    assert_eq!(modes.len(), published.len(), "{modes:#?}");
    for (mode, &(real, imaginary)) in modes.iter().zip(published) {
        let off = (mode.real.value - real).hypot(mode.imaginary.value - imaginary);
        assert!(
            off < within * real.hypot(imaginary),
            "{} where {real} ± {imaginary}i is published",
            mode.eigenvalue()
        );
    }
}

/// Nelson, Flight Stability and Automatic Control, 2nd ed., example 5.4: the Navion's lateral modes, from derivatives with
/// three digits; the spiral mode is a small difference of large numbers.
#[test]
fn the_lateral_modes_of_the_navion_are_those_published() {
    let derivatives = [
        ("Yb", -0.254),
        ("Lb", -16.02),
        ("Lp", -8.40),
        ("Lr", 2.19),
        ("Nb", 4.488),
        ("Np", -0.350),
        ("Nr", -0.760),
        ("V_e", 176.0 * 0.3048),
        ("alpha_e", 0.0),
        ("theta_e", 0.0),
        ("phi_e", 0.0),
    ];
    let known: Map<String, Value> = (derivatives.into_iter())
        .map(|(name, value)| (name.to_string(), json!({"start": value, "fixed": true})))
        .collect();
    // whatever is flown: the controls' derivatives are estimated, the modes are those of what is given
    let maneuver = maneuver(include_bytes!("../../data/aileron.csv"));
    let free = ["Yda", "Ydr", "Ldr", "Ndr"].map(|n| (n.to_string(), json!({"fixed": true})));
    let spec = json!({"parameters": known.into_iter().chain(free).collect::<Map<_, _>>()});
    let modes = solve("lateral-directional-4", &maneuver, &spec)
        .estimate
        .modes;
    near(&modes[..2], &[(-8.435, 0.0), (-0.487, 2.335)], 0.005);
    near(&modes[2..], &[(-0.00877, 0.0)], 0.1);
    assert_eq!(modes[0].states, ["p"]);
    assert!(
        modes[1].states.contains(&"beta".to_string()) && modes[1].states.contains(&"r".to_string())
    );
    assert!(modes[2].time_to_half.is_some() && modes[2].period.is_none());
    // nothing in the matrix was estimated
    assert_eq!(modes[1].real.standard_error, Some(0.0));
}

/// The same aircraft in six degrees of freedom, linearised at its trim: heading and altitude are no modes. The
/// longitudinal ones are those of examples 4.2 and 4.3.
#[test]
fn six_degrees_of_freedom_have_the_five_modes() {
    let scenario = scenario("six-degrees-of-freedom");
    let result = solve(
        "six-degrees-of-freedom",
        &fly(&scenario),
        &json!({"parameters": {
            "Czad": {"start": -1.0}, "Cmad": {"start": -4.36}, "Cnda": {"start": -0.0035},
        }}),
    );
    let modes = result.estimate.modes;
    assert!(
        modes
            .iter()
            .all(|mode| mode.segment.as_deref() == Some("1"))
    );
    near(
        &modes[..4],
        &[
            (-8.435, 0.0),
            (-2.5, 2.59),
            (-0.487, 2.335),
            (-0.0171, 0.213),
        ],
        0.04,
    );
    assert_eq!(modes.len(), 5, "{modes:#?}");
    // the spiral mode: slow, aperiodic
    assert!(modes[4].real.value.abs() < 0.05 && modes[4].imaginary.value == 0.0);
    assert!(
        modes[..4]
            .iter()
            .all(|mode| mode.real.standard_error.is_some())
    );
}

/// Over noise, frequency and damping scatter as their bounds say. 100 seeds give a standard deviation to 7 %.
#[test]
fn the_scatter_over_noise_is_that_of_the_bounds() {
    const SEEDS: u64 = 100;
    let mut scenario: Scenario =
        toml::from_str(include_str!("../../data/elevator.toml")).expect("a scenario");
    scenario.duration = 16.0;
    let model = compiled("short-period");
    let mut found = Vec::new();
    for seed in 0..SEEDS {
        scenario.seed = seed;
        let maneuver = Arc::new(scenario.fly(&model).expect("a maneuver"));
        // the initial state counts as known, so that it has to be
        let spec = json!({"parameters": {"alpha_0": {"start": scenario.truth["alpha_0"]}}});
        let mode = solve("short-period", &maneuver, &spec)
            .estimate
            .modes
            .remove(0);
        found.push(
            [
                mode.natural_frequency,
                mode.damping_ratio,
                mode.time_to_half,
            ]
            .map(|m| m.expect("a measure")),
        );
    }
    for (i, what) in ["frequency", "damping", "time to half"]
        .into_iter()
        .enumerate()
    {
        let n = SEEDS as f64;
        let mean = found.iter().map(|m| m[i].value).sum::<f64>() / n;
        let scatter = (found
            .iter()
            .map(|m| (m[i].value - mean).powi(2))
            .sum::<f64>()
            / (n - 1.0))
            .sqrt();
        let bound = found
            .iter()
            .map(|m| m[i].standard_error.expect("a bound"))
            .sum::<f64>()
            / n;
        println!(
            "{what}: mean {mean:.5}, scatter {scatter:.3e}, bound {bound:.3e}, ratio {:.3}",
            scatter / bound
        );
        assert!(
            (scatter / bound - 1.0).abs() < 0.25,
            "{what}: {scatter:e} where the bound is {bound:e}"
        );
    }
}

/// Two alike roots: the estimate splits them somehow, and a linear bound would be nonsense.
#[test]
fn near_equal_eigenvalues_get_a_remark_in_place_of_a_bound() {
    let model = json!({
        "name": "double-root",
        "inputs": {"u": {}},
        "parameters": {"stiffness": {"unit": "1/s^2", "start": -1.0}, "damping": {"unit": "1/s", "start": -2.01}},
        "states": {
            "x": {"initial": "0", "derivative": "v"},
            "v": {"unit": "1/s", "initial": "0", "derivative": "stiffness*(x - u) + damping*v"},
        },
        "outputs": {"x": {"equation": "x"}},
    });
    let document: trimtab_core::model::ModelDocument =
        serde_json::from_value(model.clone()).expect("a document");
    let scenario: Scenario = serde_json::from_value(json!({
        "model": "", "seed": 1, "step": 0.05, "duration": 20.0,
        "truth": {"stiffness": -1.0, "damping": -2.0},
        "inputs": {"u": {"unit": "-", "design": {"shape": "doublet", "start": 1.0, "unit_time": 4.0, "amplitude": 1.0}}},
        "outputs": {"x": {"unit": "-", "noise": 0.02}},
    }))
    .expect("a scenario");
    let compiled = trimtab_core::model::Model::compile(&document).expect("a model");
    let maneuver = Arc::new(scenario.fly(&compiled).expect("a maneuver"));
    let spec: trimtab_core::job::JobSpec =
        serde_json::from_value(json!({"model": model, "maneuvers": [{"id": maneuver.digest()}]}))
            .expect("a spec");
    let plan = trimtab_core::job::prepare(&spec, &document, &[maneuver])
        .unwrap_or_else(|f| panic!("{f:#?}"));
    let result = trimtab_core::job::run(&plan, &mut |_| std::ops::ControlFlow::Continue(()))
        .expect("a result");
    let modes = &result.estimate.modes;
    assert!(!modes.is_empty());
    for mode in modes {
        assert!(
            mode.remark.contains("near to another eigenvalue"),
            "{mode:#?}"
        );
        assert_eq!(
            (mode.real.standard_error, mode.imaginary.standard_error),
            (None, None)
        );
        assert!((mode.real.value + 1.0).abs() < 0.3);
    }
}
