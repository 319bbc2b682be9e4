//! Problems of known truth for benches that need no flight data.

use std::sync::Arc;

use serde_json::json;
use trimtab_core::job::{self, JobSpec, Plan};
use trimtab_core::model::{Model, ModelDocument, catalog};
use trimtab_core::simulate::Scenario;

const SHORT_PERIOD: &str = include_str!("../../data/elevator.toml");
const LATERAL: &str = r#"
    model = "lateral-directional-2"
    seed = 2
    step = 0.04
    duration = 25.0
    [truth]
    [inputs.da]
    unit = "rad"
    design = { shape = "doublet", start = 1.0, unit_time = 1.0, amplitude = 0.05 }
    [inputs.dr]
    unit = "rad"
    design = { shape = "3-2-1-1", start = 5.0, unit_time = 0.8, amplitude = 0.04 }
    [inputs.beta]
    unit = "rad"
    design = { shape = "doublet", start = 6.0, unit_time = 1.5, amplitude = 0.03 }
    [outputs]
    p = { unit = "rad/s", noise = 0.002 }
    r = { unit = "rad/s", noise = 0.002 }
    ay = { unit = "m/s^2", noise = 0.02 }
"#;
const HFB320: &str = r#"
    model = "in the bench"
    seed = 4
    step = 0.1
    duration = 60.0
    [truth]
    [inputs.de]
    unit = "rad"
    trim = -0.01
    design = { shape = "3-2-1-1", start = 2.0, unit_time = 0.6, amplitude = 0.02 }
    [inputs.thrust]
    unit = "N"
    trim = 11000.0
    design = { shape = "constant" }
    [outputs]
    V = { unit = "m/s", noise = 0.1 }
    alpha = { unit = "rad", noise = 0.001 }
    theta = { unit = "rad", noise = 0.001 }
    q = { unit = "rad/s", noise = 0.001 }
    qdot = { unit = "rad/s^2", noise = 0.002 }
    ax = { unit = "m/s^2", noise = 0.02 }
    az = { unit = "m/s^2", noise = 0.05 }
"#;

/// Straight and level: all of it stays in range for hours, which the airplane with its controls held does not.
const FLIGHT_PATH: &str = r#"
    model = "flight-path-reconstruction"
    seed = 5
    step = 0.05
    duration = 60.0
    [truth]
    u_0 = 79.9
    v_0 = 0.0
    w_0 = 4.0
    theta_0 = 0.05
    psi_0 = 0.7
    x_0 = 0.0
    y_0 = 0.0
    z_0 = -1000.0
    [inputs]
    ax = { unit = "m/s^2", trim = 0.490, design = { shape = "constant" } }
    ay = { unit = "m/s^2", design = { shape = "constant" } }
    az = { unit = "m/s^2", trim = -9.794, design = { shape = "constant" } }
    p = { unit = "rad/s", design = { shape = "constant" } }
    q = { unit = "rad/s", design = { shape = "constant" } }
    r = { unit = "rad/s", design = { shape = "constant" } }
    [outputs]
    alpha = { unit = "rad", noise = 0.003 }
    beta = { unit = "rad", noise = 0.003 }
    V = { unit = "m/s", noise = 0.3 }
    x = { unit = "m", noise = 1.0 }
    y = { unit = "m", noise = 1.0 }
    z = { unit = "m", noise = 1.5 }
"#;

/// A problem on `short-period`, `lateral-directional-2`, `flight-path-reconstruction` or
/// `hfb320`, with a recording of `duration` seconds, or of its own length.
pub(crate) fn plan(name: &str, duration: Option<f64>) -> Plan {
    let (document, scenario): (ModelDocument, &str) = match name {
        "hfb320" => {
            let document = toml::from_str(include_str!("hfb320.toml")).expect("a document");
            (document, HFB320)
        }
        "short-period" => (catalog::find(name).expect("a catalog model"), SHORT_PERIOD),
        "flight-path-reconstruction" => {
            (catalog::find(name).expect("a catalog model"), FLIGHT_PATH)
        }
        _ => (catalog::find(name).expect("a catalog model"), LATERAL),
    };
    let model = Model::compile(&document).unwrap_or_else(|faults| panic!("{faults:#?}"));
    let mut scenario: Scenario = toml::from_str(scenario).expect("a scenario");
    scenario.duration = duration.unwrap_or(scenario.duration);
    let maneuver = scenario.fly(&model).expect("a bounded maneuver");
    let spec: JobSpec =
        serde_json::from_value(json!({"model": name, "maneuvers": [{"id": "simulated"}]}))
            .expect("a spec");
    job::prepare(&spec, &document, &[Arc::new(maneuver)])
        .unwrap_or_else(|faults| panic!("{faults:#?}"))
}
