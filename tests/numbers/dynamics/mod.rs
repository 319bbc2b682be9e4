//! Linear systems, responses and flying qualities of estimates, against python-control 0.10.2, scipy 1.17.1, closed forms
//! and noise.

mod bands;
mod flying_qualities;
mod linear_system;
mod responses;

use std::ops::ControlFlow;
use std::sync::Arc;

use serde_json::{Value, json};
use trimtab_core::estimate::Estimate;
use trimtab_core::flight::Maneuver;
use trimtab_core::job::{self, Plan};
use trimtab_core::model::catalog;

use crate::common::plans::plan;

/// A catalog model to be changed.
fn document(name: &str) -> Value {
    serde_json::to_value(catalog::find(name).expect("a catalog model")).expect("a document")
}

/// The model with all parameters held, these ones at these values, but for one that has nothing to do with the motion.
fn held(mut model: Value, values: &[(&str, &str, f64)], free: &str) -> Value {
    for &(name, unit, value) in values {
        model["parameters"][name] = json!({"unit": unit, "start": value});
    }
    let parameters = model["parameters"].as_object_mut().expect("a table");
    for (name, parameter) in parameters {
        parameter["fixed"] = json!(name != free);
    }
    model
}

fn estimated(model: Value, changes: Value, maneuver: &Arc<Maneuver>) -> (Plan, Estimate) {
    let plan = plan(model, changes, std::slice::from_ref(maneuver));
    let result = job::run(&plan, &mut |_| ControlFlow::Continue(()));
    let estimate = result
        .unwrap_or_else(|faults| panic!("{faults:#?}"))
        .estimate;
    (plan, estimate)
}

/// The Navion (Nelson, Flight Stability and Automatic Control, 2nd ed., example 5.4) with controls of its size, the rudder
/// behind a lag and a delay and the sideslip vane late.
fn navion() -> (Plan, Estimate) {
    let mut model = document("lateral-directional-4");
    model["inputs"]["dr"]["lag"] = json!("T_dr");
    model["inputs"]["dr"]["delay"] = json!("tau_dr");
    model["outputs"]["beta"]["delay"] = json!("tau_beta");
    let values = [
        ("Yb", "1/s", -0.254),
        ("Lb", "1/s^2", -16.02),
        ("Lp", "1/s", -8.40),
        ("Lr", "1/s", 2.19),
        ("Nb", "1/s^2", 4.488),
        ("Np", "1/s", -0.350),
        ("Nr", "1/s", -0.760),
        ("Yda", "1/s", 0.0),
        ("Ydr", "1/s", 0.0708),
        ("Lda", "1/s^2", 28.984),
        ("Ldr", "1/s^2", 2.548),
        ("Nda", "1/s^2", -0.2218),
        ("Ndr", "1/s^2", -4.597),
        ("V_e", "m/s", 176.0 * 0.3048),
        ("alpha_e", "rad", 0.0),
        ("theta_e", "rad", 0.0),
        ("phi_e", "rad", 0.0),
        ("T_dr", "s", 0.08),
        ("tau_dr", "s", 0.05),
        ("tau_beta", "s", 0.12),
    ];
    let maneuver = crate::common::recordings::maneuver(include_bytes!("../../../data/aileron.csv"));
    estimated(held(model, &values, "beta_bias"), json!({}), &maneuver)
}

/// A light airplane with short period and phugoid, the elevator behind a lag and a delay.
fn light_airplane() -> (Plan, Estimate) {
    let mut model = document("longitudinal");
    model["inputs"]["de"]["lag"] = json!("T_de");
    model["inputs"]["de"]["delay"] = json!("tau_de");
    let values = [
        ("XV", "1/s", -0.0451),
        ("Xa", "m/s^2", -6.348),
        ("Xde", "m/s^2", 0.0),
        ("ZV", "1/m", -0.002),
        ("Za", "1/s", -2.03),
        ("Zq", "-", 0.98),
        ("Zde", "1/s", -0.16),
        ("MV", "1/(m*s)", 0.0),
        ("Ma", "1/s^2", -8.8),
        ("Mq", "1/s", -2.98),
        ("Mde", "1/s^2", -11.2),
        ("V_e", "m/s", 53.6),
        ("V_0", "m/s", 53.6),
        ("gamma_e", "rad", 0.0),
        ("T_de", "s", 0.07),
        ("tau_de", "s", 0.06),
    ];
    let scenario = crate::common::estimation::scenario("longitudinal");
    let maneuver = crate::common::estimation::fly(&scenario);
    let mut model = held(model, &values, "theta_e");
    for name in ["V_e", "V_0", "gamma_e"] {
        model["parameters"][name]["per"] = json!("maneuver");
    }
    estimated(model, json!({}), &maneuver)
}
