//! Every catalog model finds the truth in a maneuver simulated with it, within its own error bounds.

use std::sync::Arc;

use crate::common::estimation::{compiled, fly, scenario, solve};
use indexmap::IndexMap;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde_json::{Value, json};
use trimtab_core::estimate::{Estimate, Outcome};
use trimtab_core::flight::{Channel, Maneuver};
use trimtab_core::model::{Model, catalog};
use trimtab_core::simulate::{InputInterpolation, Integrator, Segment, Steps, Substeps, simulate};

/// Of some 150 estimates with exact bounds, one beyond 4 is to be expected in a hundred sets of seeds.
const WITHIN_STANDARD_ERRORS: f64 = 4.0;

/// Models whose maneuver is made by [`reconstruction`] rather than by a scenario of their own.
const RECONSTRUCTIONS: [&str; 2] = [
    "flight-path-reconstruction",
    "flight-path-reconstruction-attitude",
];

/// Those whose bundled maneuvers `bundled_data.rs` estimates.
const BUNDLED: [&str; 2] = ["short-period", "lateral-directional-4"];

#[track_caller]
fn finds(estimate: &Estimate, truth: &IndexMap<String, f64>, least: usize) {
    assert_eq!(estimate.outcome, Outcome::Converged, "{}", estimate.reason);
    let mut compared = 0;
    let mut off = Vec::new();
    for parameter in estimate.parameters.iter().filter(|p| !p.fixed) {
        let truth = truth[&parameter.name];
        let error = parameter.standard_error.expect("an error bound");
        let distance = (parameter.estimate - truth).abs() / error;
        if distance > WITHIN_STANDARD_ERRORS {
            off.push(format!(
                "{} {} ± {error}, truth {truth}: {distance:.1} standard errors",
                parameter.name, parameter.estimate
            ));
        }
        compared += 1;
    }
    assert!(off.is_empty(), "{off:#?}");
    assert!(compared >= least, "only {compared} parameters compared");
}

#[test]
fn each_finds_the_truth_of_its_scenario() {
    let mut parameters = 0;
    for document in catalog::all() {
        let name = document.name.as_str();
        if RECONSTRUCTIONS.contains(&name) || BUNDLED.contains(&name) {
            continue;
        }
        let scenario = scenario(name);
        // what is fixed counts as known
        let known: serde_json::Map<String, Value> = (document.parameters.iter())
            .filter(|(name, parameter)| parameter.fixed && scenario.truth.contains_key(*name))
            .map(|(name, _)| (name.clone(), json!({"start": scenario.truth[name]})))
            .collect();
        let result = solve(name, &fly(&scenario), &json!({"parameters": known}));
        let free = document.parameters.values().filter(|p| !p.fixed).count();
        finds(&result.estimate, &scenario.truth, free);
        println!(
            "{name}: {free} parameters, {} iterations; modes {:?}",
            result.estimate.iterations,
            (result.estimate.modes.iter())
                .map(|mode| format!("{} {}", mode.label(), mode.eigenvalue()))
                .collect::<Vec<_>>()
        );
        parameters += free;
    }
    assert!(parameters > 80);
}

/// What sensors record of the flight in `turns.toml`: its specific forces and rates, with the biases of `truth`,
/// drive the reconstruction itself, so that the truth is exactly inside the model; the outputs get noise.
fn reconstruction(
    model: &Model,
    constants: &Value,
    truth: &IndexMap<String, f64>,
    noise: &[f64],
    seed: u64,
) -> Arc<Maneuver> {
    let flight = fly(&scenario("turns"));
    let mut document = model.document.clone();
    for (name, value) in constants.as_object().expect("an object") {
        document.constants[name].value = value.as_f64().expect("a number");
    }
    let model = Model::compile(&document).expect("a model");
    let step = flight.time()[1] - flight.time()[0];
    let recorded = |name: &str| flight.channels()[name].values.clone();
    let inputs: Vec<Vec<f64>> = (model.inputs.iter())
        .map(|input| match input.name.strip_suffix("dot") {
            // angular acceleration, by central differences
            Some(rate) => {
                let rate = recorded(rate);
                let last = rate.len() - 1;
                (0..=last)
                    .map(|k| (rate[(k + 1).min(last)] - rate[k.saturating_sub(1)]) / (2.0 * step))
                    .collect()
            }
            None => {
                let bias = truth[&format!("{}_bias", input.name)];
                recorded(&input.name)
                    .iter()
                    .map(|value| value + bias)
                    .collect()
            }
        })
        .collect();
    let segment = Segment {
        label: String::new(),
        time: flight.time().to_vec(),
        steps: Steps::Even(step),
        substeps: Substeps::default(),
        inputs,
        measured: Vec::new(),
    };
    let parameters: Vec<f64> = model.parameters.iter().map(|p| truth[&p.name]).collect();
    let mut outputs = vec![Vec::new(); model.outputs.len()];
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    simulate(
        &model,
        Integrator::Rk4,
        InputInterpolation::Linear,
        &segment,
        &parameters,
        |_, y: &[f64]| {
            for ((series, y), noise) in outputs.iter_mut().zip(y).zip(noise) {
                let unit: f64 = StandardNormal.sample(&mut random);
                series.push(y + noise * unit);
            }
        },
    );
    let quantities = model.inputs.iter().chain(&model.outputs);
    let channels = quantities.zip(segment.inputs.into_iter().chain(outputs));
    let channels = channels.map(|(quantity, values)| {
        let channel = Channel {
            recorded_unit: quantity.si.clone(),
            unit: quantity.unit,
            values,
        };
        (quantity.name.clone(), channel)
    });
    Arc::new(Maneuver::new(segment.time, channels.collect()).expect("a maneuver"))
}

/// By name; all others are zero.
fn truth_of(model: &Model, known: &[(&str, f64)]) -> IndexMap<String, f64> {
    let mut truth: IndexMap<String, f64> = (model.parameters.iter())
        .map(|parameter| (parameter.name.clone(), 0.0))
        .collect();
    for &(name, value) in known {
        *truth.get_mut(name).expect("a parameter") = value;
    }
    truth
}

const BIASES: [(&str, f64); 6] = [
    ("ax_bias", 0.08),
    ("ay_bias", -0.05),
    ("az_bias", 0.12),
    ("p_bias", 1.2e-3),
    ("q_bias", -0.9e-3),
    ("r_bias", 0.7e-3),
];

fn gps() -> (Model, IndexMap<String, f64>, Value, Arc<Maneuver>) {
    let model = compiled(RECONSTRUCTIONS[0]);
    let known = [
        ("alpha_bias", 0.012),
        ("beta_bias", -0.010),
        ("K_alpha", 0.08),
        ("K_beta_alpha", 0.03),
        ("K_beta", -0.05),
        ("V_bias", -0.8),
        ("K_V", 1.02),
        ("W_x", 4.0),
        ("W_y", -3.0),
        ("W_z", 0.2),
        ("u_0", 53.64),
        ("v_0", 0.3),
        ("w_0", 0.2),
        ("phi_0", 0.01),
        ("theta_0", 0.005),
        ("psi_0", 0.7),
        ("x_0", 120.0),
        ("y_0", -80.0),
        ("z_0", -1000.0),
    ];
    let truth = truth_of(&model, &[&known[..], &BIASES].concat());
    let constants = json!({"x_alpha": 4.0, "y_alpha": -0.5, "x_beta": 4.0, "z_beta": 0.3});
    let noise = [3e-3, 3e-3, 0.3, 1.0, 1.0, 1.5];
    let maneuver = reconstruction(&model, &constants, &truth, &noise, 6);
    (model, truth, constants, maneuver)
}

#[test]
fn a_flight_path_is_reconstructed_from_airdata_and_position() {
    let (model, truth, constants, maneuver) = gps();
    assert_eq!(model.parameters.len(), 28);
    let name = RECONSTRUCTIONS[0];
    let result = solve(name, &maneuver, &json!({"constants": constants}));
    finds(&result.estimate, &truth, 25);
    assert!(result.estimate.modes.is_empty());
}

#[test]
fn position_biases_are_redundant_with_initial_positions_and_the_result_says_so() {
    let (_, _, constants, maneuver) = gps();
    let freed =
        json!({"x_bias": {"fixed": false}, "y_bias": {"fixed": false}, "z_bias": {"fixed": false}});
    let spec = json!({"constants": constants, "parameters": freed});
    let estimate = solve(RECONSTRUCTIONS[0], &maneuver, &spec).estimate;
    assert_eq!(estimate.outcome, Outcome::Singular, "{}", estimate.reason);
    let mut sets: Vec<Vec<String>> = (estimate.collinear.iter())
        .map(|set| {
            let mut names = set.parameters.clone();
            names.sort();
            names
        })
        .collect();
    sets.sort();
    assert_eq!(
        sets,
        [["x_0", "x_bias"], ["y_0", "y_bias"], ["z_0", "z_bias"]]
    );
}

#[test]
fn a_flight_path_is_reconstructed_from_attitude_and_altitude() {
    let name = RECONSTRUCTIONS[1];
    let model = compiled(name);
    let known = [
        ("f_alpha", 1.06),
        ("b_alpha", 0.01),
        ("f_beta", 0.95),
        ("b_beta", -0.01),
        ("u_0", 53.64),
        ("v_0", 0.3),
        ("w_0", 0.2),
        ("phi_0", 0.01),
        ("theta_0", 0.005),
        ("psi_0", 0.7),
        ("h_0", 1000.0),
    ];
    let truth = truth_of(&model, &[&known[..], &BIASES].concat());
    let constants =
        json!({"x_a": -1.0, "y_a": 0.9, "z_a": 0.1, "x_b": 5.0, "y_b": 0.1, "z_b": -0.2});
    let noise = [0.3, 3e-3, 3e-3, 2e-3, 2e-3, 4e-3, 1.0];
    let maneuver = reconstruction(&model, &constants, &truth, &noise, 7);
    let freed = ["f_alpha", "b_alpha", "f_beta", "b_beta"].map(|n| (n, json!({"fixed": false})));
    let freed: Value = Value::Object(freed.map(|(n, v)| (n.to_string(), v)).into_iter().collect());
    let spec = json!({"constants": constants, "parameters": freed});
    let result = solve(name, &maneuver, &spec);
    finds(&result.estimate, &truth, 17);
    assert!(result.estimate.modes.is_empty());
}

/// The six-degrees-of-freedom document solves dw/dt = ... + z_lag dα/dt for dα/dt. Put back into the force equation as
/// the thesis prints it (eq. 2.8d, 2.10c, 2.12f), nothing may be left.
#[test]
fn the_rate_of_the_angle_of_attack_solves_its_implicit_equation() {
    let mut document = catalog::find("six-degrees-of-freedom").expect("a catalog model");
    document.constants["Ixz"].value = 150.0;
    let model = Model::compile(&document).expect("a model");
    let value = |name: &str| -> f64 {
        match name {
            "Czad" => -6.0,
            "Cmad" => -4.4,
            "CzTc" => 0.2,
            _ => match &document.parameters[name].start {
                trimtab_core::model::Start::Value(value) => *value,
                trimtab_core::model::Start::FromData(_) => 0.0,
            },
        }
    };
    let parameters: Vec<f64> = model.parameters.iter().map(|p| value(&p.name)).collect();
    let state = [50.0, 3.0, 6.0, 0.2, 0.15, -0.1, 0.4, 0.12, 0.8, 900.0];
    let input = [-0.05, 0.03, 0.02, 1800.0];
    let dynamics = &model.dynamics;
    let mut workspace = dynamics.workspace::<f64>();
    dynamics.set_parameters(&mut workspace, &parameters);
    dynamics.states(&mut workspace).copy_from_slice(&state);
    dynamics.inputs(&mut workspace).copy_from_slice(&input);
    dynamics.run(&mut workspace);
    let mut rates = [0.0; 10];
    dynamics.results(&workspace, &mut rates);

    let constant = |name: &str| document.constants[name].value;
    let [u, v, w, p, q, r, phi, theta, ..] = state;
    let [de, _, _, thrust] = input;
    let (udot, wdot) = (rates[0], rates[2]);
    let speed = (u * u + v * v + w * w).sqrt();
    let pressure_area = 0.5 * constant("rho") * speed * speed * constant("S");
    let alpha_rate = (u * wdot - w * udot) / (u * u + w * w);
    let half_chord = constant("c") / (2.0 * speed);
    let lift = value("Cz0")
        + value("Cza") * (w / u).atan()
        + value("Czde") * de
        + value("CzTc") * thrust / pressure_area
        + half_chord * (value("Czq") * q + value("Czad") * alpha_rate);
    let left = q * u - p * v
        + constant("g") * f64::cos(phi) * f64::cos(theta)
        + pressure_area * lift / constant("m")
        - wdot;
    assert!(left.abs() < 1e-11, "{left:e}");
    assert!((pressure_area * half_chord * value("Czad") * alpha_rate / constant("m")).abs() > 1e-3);

    // the moments: Ix dp/dt - Ixz dr/dt and so on (Góes, Hemerly, Maciel eq. 2)
    let (ix, iy, iz, ixz) = (
        constant("Ix"),
        constant("Iy"),
        constant("Iz"),
        constant("Ixz"),
    );
    let (phat, rhat) = (
        constant("b") * p / (2.0 * speed),
        constant("b") * r / (2.0 * speed),
    );
    let beta = (v / speed).asin();
    let about = |axis: &str| {
        pressure_area
            * constant("b")
            * (value(&format!("{axis}0"))
                + value(&format!("{axis}b")) * beta
                + value(&format!("{axis}p")) * phat
                + value(&format!("{axis}r")) * rhat
                + value(&format!("{axis}da")) * input[1]
                + value(&format!("{axis}dr")) * input[2])
    };
    let rolling = ix * rates[3] - (iy - iz) * q * r - ixz * (rates[5] + p * q);
    let yawing = iz * rates[5] - (ix - iy) * p * q - ixz * (rates[3] - q * r);
    assert!((rolling - about("Cl")).abs() < 1e-9 * about("Cl").abs());
    assert!((yawing - about("Cn")).abs() < 1e-9 * about("Cn").abs());
    let pitch = value("Cm0")
        + value("Cma") * (w / u).atan()
        + value("Cmde") * de
        + half_chord * (value("Cmq") * q + value("Cmad") * alpha_rate);
    let pitching = iy * rates[4] - (iz - ix) * r * p - ixz * (r * r - p * p);
    let expected = pressure_area * constant("c") * pitch;
    assert!((pitching - expected).abs() < 1e-9 * expected.abs());
}
