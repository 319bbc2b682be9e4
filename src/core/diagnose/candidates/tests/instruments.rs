//! Instruments, clocks, wind, and how large they may be.

use std::collections::BTreeSet;

use super::{beside, case, names, of, offered};
use crate::diagnose::case::Case;
use crate::diagnose::effect::{Effect, EffectKind};
use crate::model::{EditKind, Model, catalog};

#[test]
fn candidates_stay_few_and_are_all_fit() {
    for document in catalog::all() {
        let case = case(&document, &beside());
        let effects = offered(&case);
        assert!(effects.len() <= 350, "{}: {}", document.name, effects.len());
        let mut seen = BTreeSet::new();
        for effect in &effects {
            assert!(seen.insert(effect.name()), "{} twice", effect.name());
            let edited = effect
                .apply(&document)
                .unwrap_or_else(|e| panic!("{}: {e}", effect.name()))
                .document;
            Model::compile(&edited).unwrap_or_else(|f| panic!("{}: {f:#?}", effect.name()));
        }
    }
}

/// A dynamic pressure and an attitude that are recorded inputs come through no actuator, an elastic state is no motion.
#[test]
fn only_controls_have_actuators() {
    let text = r#"
        name = "elastic"
        inputs.de.unit = "rad"
        inputs.qbar.unit = "Pa"
        inputs.theta.unit = "rad"
        parameters.Ma = { unit = "1/(s^2*Pa)", start = -1e-4 }
        parameters.Mde = { unit = "1/(s^2*Pa)", start = -1e-4 }
        parameters.Mq = { unit = "1/s", start = -1.0 }
        parameters.Za = { unit = "1/s", start = -1.0 }
        parameters.G = { unit = "1/s", start = 0.1 }
        parameters.w = { unit = "rad/s", start = 12.0 }
        parameters.k = { unit = "-", start = 0.1 }
        states.alpha = { unit = "rad", initial = "0", derivative = "Za*alpha + q + G*theta" }
        states.q = { unit = "rad/s", initial = "0", derivative = "qbar*(Ma*alpha + Mde*de) + Mq*q" }
        states.eta = { unit = "rad", initial = "0", derivative = "etadot" }
        states.etadot = { unit = "rad/s", initial = "0", derivative = "w^2*(k*de - eta) - 0.1*w*etadot" }
        outputs.alpha = { unit = "rad", equation = "alpha" }
        outputs.q = { unit = "rad/s", equation = "q + etadot" }
    "#;
    let found = names(&offered(&case(&toml::from_str(text).unwrap(), &[])));
    assert!(found.contains("actuator_lag of de") && found.contains("missing_term alpha^2 in q"));
    for wrong in [
        "actuator_lag of qbar",
        "backlash of theta",
        "actuator_rate_limit of theta",
        "missing_term alpha^2 in etadot",
        "missing_term q in eta",
    ] {
        assert!(!found.contains(wrong), "{wrong}");
    }
}

#[test]
fn each_clock_is_one_candidate() {
    let delays = |effects: &[Effect]| -> Vec<String> {
        let delays = effects.iter().filter(|effect| {
            matches!(
                effect.kind,
                EffectKind::Edit(EditKind::SensorDelay | EditKind::InputDelay)
            ) && effect.target.contains('+')
        });
        delays.map(|effect| effect.target.clone()).collect()
    };
    let found = delays(&of("flight-path-reconstruction"));
    assert_eq!(
        found,
        [
            "alpha+beta+V",
            "ax+ay+az",
            "p+q+r",
            "ax+ay+az+p+q+r",
            "x+y+z",
            "alpha+beta+V+x+y+z"
        ]
    );
    let found = delays(&of("six-degrees-of-freedom"));
    let all = "V+alpha+beta+p+q+r+phi+theta+psi+h+ax+ay+az";
    assert_eq!(
        found,
        [
            "V+alpha+beta+h",
            "V+alpha+beta",
            "ax+ay+az",
            "p+q+r",
            "phi+theta+psi",
            "p+q+r+phi+theta+psi",
            "p+q+r+ax+ay+az",
            "p+q+r+phi+theta+psi+ax+ay+az",
            all,
            "de+da+dr+thrust"
        ]
    );
    // the gyros of a reconstruction are inputs: what is recorded late is used earlier
    let effects = of("flight-path-reconstruction");
    let gyros = effects
        .iter()
        .find(|effect| effect.target == "p+q+r")
        .unwrap();
    let document = catalog::find("flight-path-reconstruction").unwrap();
    let edited = gyros.apply(&document).unwrap().document;
    for name in ["p", "q", "r"] {
        assert_eq!(edited.inputs[name].delay.as_deref(), Some("-p_q_r_delay"));
    }
    // a group of the job's own, and one that is there already
    let mut told = case(&document, &beside());
    let group = |names: [&str; 2]| names.map(ToString::to_string).to_vec();
    told.knowledge.clocks = vec![group(["alpha", "beta"]), group(["beta", "alpha"])];
    assert_eq!(delays(&offered(&told)).last().unwrap(), "alpha+beta");
}

#[test]
fn a_wind_is_one_candidate() {
    let winds = |model: &str| -> Vec<String> {
        let effects = of(model);
        let winds = effects
            .iter()
            .filter(|effect| effect.kind == EffectKind::Edit(EditKind::Wind));
        winds.map(Effect::name).collect()
    };
    // its constant wind is free in each maneuver
    let found = winds("flight-path-reconstruction");
    assert_eq!(
        found,
        ["wind of W_x+W_y+W_z (ramp)", "wind of W_x+W_y+W_z (shear)"]
    );
    let found = winds("six-degrees-of-freedom");
    assert_eq!(found[0], "wind of W_z (constant)");
    // without any wind in it, the positions are carried along
    let mut still = catalog::find("flight-path-reconstruction").unwrap();
    for (state, wind) in [("x", " + W_x"), ("y", " + W_y"), ("z", " + W_z")] {
        let derivative = &mut still.states[state].derivative;
        *derivative = derivative.replace(wind, "");
    }
    still.parameters.retain(|name, _| !name.starts_with("W_"));
    let effects = offered(&case(&still, &beside()));
    let steady = effects
        .iter()
        .find(|e| e.name() == "wind of W_x+W_y+W_z (constant)")
        .unwrap();
    let edited = steady.apply(&still).unwrap().document;
    for (state, wind) in [
        ("x", "W_x_constant"),
        ("y", "W_y_constant"),
        ("z", "W_z_constant"),
    ] {
        assert!(edited.states[state].derivative.ends_with(wind));
        assert!(edited.parameters.contains_key(wind));
    }
}

#[test]
fn what_is_known_bounds_a_size_or_leaves_it_out() {
    let document = catalog::find("flight-path-reconstruction").unwrap();
    let find = |case: &Case, name: &str| offered(case).into_iter().find(|e| e.name() == name);
    let usual = case(&document, &beside());
    let vane = find(&usual, "sensor_position of alpha (x)").unwrap();
    assert_eq!(vane.plausible.unwrap().upper, 15.0);
    let edited = vane.apply(&document).unwrap().document;
    assert_eq!(edited.parameters["alpha_x"].upper, Some(15.0));
    assert_eq!(edited.parameters["alpha_x"].prior, None);
    let gyro = find(&usual, "sensor_scale of q").unwrap();
    assert_eq!(gyro.plausible.unwrap().lower, -0.3);
    let vane_delay = find(&usual, "sensor_delay of alpha")
        .unwrap()
        .apply(&document)
        .unwrap()
        .document;
    assert_eq!(vane_delay.parameters["alpha_delay"].lower, Some(0.0));
    // declared where it is: not moved again
    let mut placed = document.clone();
    placed.constants["x_alpha"].value = 8.0;
    let vane = find(&case(&placed, &beside()), "sensor_position of alpha (x)").unwrap();
    assert!(vane.plausible.unwrap().known);
    assert_eq!(
        vane.apply(&placed).unwrap().document.parameters["alpha_x"].upper,
        Some(0.5)
    );
    // the job knows better
    let mut told = case(&placed, &beside());
    told.knowledge = serde_json::from_value(serde_json::json!({
        "exclude": ["sensor_lag", "x", "sensor_scale of alpha"],
        "known": [
            {"kind": "sensor_position", "target": "alpha", "term": "x", "size_sd": 10.0, "unit": "cm"},
            {"kind": "sensor_bias", "target": "V", "size_sd": 0.0},
            {"kind": "sensor_delay", "target": "p+q+r", "upper": 0.02, "lower": -0.02},
        ],
    }))
    .unwrap();
    let effects = offered(&told);
    let found = names(&effects);
    for gone in [
        "sensor_lag of V",
        "sensor_bias of x",
        "sensor_scale of alpha",
        "sensor_bias of V",
    ] {
        assert!(
            names(&offered(&case(&placed, &beside()))).contains(gone),
            "{gone}"
        );
        assert!(!found.contains(gone), "{gone}");
    }
    let vane = find(&told, "sensor_position of alpha (x)").unwrap();
    let prior = vane.apply(&placed).unwrap().document.parameters["alpha_x"]
        .prior
        .unwrap();
    assert_eq!((prior.mean, prior.sd), (0.0, 0.1));
    let gyros = find(&told, "sensor_delay of p+q+r")
        .unwrap()
        .apply(&placed)
        .unwrap()
        .document;
    assert_eq!(gyros.parameters["p_q_r_delay"].upper, Some(0.02));
}
