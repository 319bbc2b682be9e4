//! What is offered for which model, and that names do not matter.

use std::collections::{BTreeMap, BTreeSet};

use indexmap::IndexMap;

use super::{Knowledge, candidates};
use crate::diagnose::{Case, Effect, EffectKind, Flight};
use crate::estimate::{Options, Role};
use crate::flight::{PhysicalQuantity, Unit};
use crate::model::{EditKind, Model, ModelDocument, Quantities, Reference, catalog};
use crate::simulate::Steps;

/// Channels beside the model: name, unit, what they are.
const BESIDE: [(&str, &str, PhysicalQuantity); 9] = [
    ("alpha", "rad", PhysicalQuantity::AngleOfAttack),
    ("beta", "rad", PhysicalQuantity::AngleOfSideslip),
    ("p", "rad/s", PhysicalQuantity::RollRate),
    ("q", "rad/s", PhysicalQuantity::PitchRate),
    ("r", "rad/s", PhysicalQuantity::YawRate),
    ("V", "m/s", PhysicalQuantity::Airspeed),
    ("mach", "-", PhysicalQuantity::Mach),
    ("da", "rad", PhysicalQuantity::Aileron),
    ("df", "rad", PhysicalQuantity::Flap),
];

/// A flight in which everything moves, each channel in its own way.
fn case(document: &ModelDocument, beside: &[(String, &str, PhysicalQuantity)]) -> Case {
    let of_model = (document
        .inputs
        .iter()
        .map(|(name, x)| (name.clone(), x.unit.as_str())))
    .chain(
        document
            .outputs
            .iter()
            .map(|(name, x)| (name.clone(), x.unit.as_str())),
    );
    let all = of_model.chain(beside.iter().map(|(name, unit, _)| (name.clone(), *unit)));
    let mut channels = IndexMap::new();
    for (i, (name, unit)) in all.enumerate() {
        let dimension = Unit::parse(unit).unwrap().dimension;
        let wave = |k: usize| 1.0 + 0.1 * (0.01 * (i + 3) as f64 * k as f64).sin();
        let values: Vec<f64> = (0..200).map(wave).collect();
        channels.entry(name).or_insert((values, dimension));
    }
    let told = beside
        .iter()
        .map(|(name, _, quantity)| (name.clone(), *quantity));
    Case {
        document: document.clone(),
        flights: vec![Flight {
            label: "1".to_string(),
            role: Role::Estimation,
            time: (0..200).map(|k| 0.02 * k as f64).collect(),
            steps: Steps::Even(0.02),
            channels,
        }],
        options: Options::default(),
        candidates: Vec::new(),
        knowledge: Knowledge {
            quantities: told.collect(),
            ..Knowledge::default()
        },
        consumed: Vec::new(),
    }
}

fn beside() -> Vec<(String, &'static str, PhysicalQuantity)> {
    BESIDE
        .map(|(name, unit, quantity)| (name.to_string(), unit, quantity))
        .to_vec()
}

fn offered(case: &Case) -> Vec<Effect> {
    let model = Model::compile(&case.document).unwrap_or_else(|faults| panic!("{faults:#?}"));
    candidates(case, &model)
}

fn of(model: &str) -> Vec<Effect> {
    offered(&case(&catalog::find(model).unwrap(), &beside()))
}

fn names(effects: &[Effect]) -> BTreeSet<String> {
    effects.iter().map(Effect::name).collect()
}

/// Each name in a text by another.
fn renamed(text: &str, by: &BTreeMap<String, String>) -> String {
    let mut result = String::new();
    let mut word = String::new();
    for c in text.chars().chain([' ']) {
        if c.is_ascii_alphanumeric() || c == '_' {
            word.push(c);
            continue;
        }
        result.push_str(by.get(&word).unwrap_or(&word));
        word.clear();
        result.push(c);
    }
    result.trim_end().to_string()
}

fn with_other_names(document: &ModelDocument, by: &BTreeMap<String, String>) -> ModelDocument {
    let mut value = serde_json::to_value(document).unwrap();
    for section in [
        "constants",
        "inputs",
        "parameters",
        "definitions",
        "states",
        "outputs",
    ] {
        let Some(entries) = value.get(section).and_then(|v| v.as_object()).cloned() else {
            continue;
        };
        let rename = |(name, mut entry): (String, serde_json::Value)| {
            for field in ["equation", "derivative", "initial", "delay", "start"] {
                if let Some(text) = entry.get(field).and_then(|text| text.as_str()) {
                    entry[field] = renamed(text, by).into();
                }
            }
            (renamed(&name, by), entry)
        };
        value[section] = entries
            .into_iter()
            .map(rename)
            .collect::<serde_json::Map<_, _>>()
            .into();
    }
    serde_json::from_value(value).unwrap()
}

/// Every name of a document and of what is recorded beside it, by one that says nothing.
fn opaque_names(document: &ModelDocument) -> BTreeMap<String, String> {
    let all = (document.constants.keys())
        .chain(document.inputs.keys())
        .chain(document.parameters.keys())
        .chain(document.definitions.keys())
        .chain(document.states.keys())
        .chain(document.outputs.keys())
        .cloned()
        .chain(BESIDE.map(|(name, ..)| name.to_string()));
    let all: BTreeSet<String> = all.collect();
    all.into_iter()
        .enumerate()
        .map(|(i, name)| (name, format!("n{i}")))
        .collect()
}

#[test]
fn names_do_not_matter() {
    for document in catalog::all() {
        let by = opaque_names(&document);
        let other = with_other_names(&document, &by);
        let renamed_beside: Vec<_> = (beside().into_iter())
            .map(|(name, unit, is)| (by[&name].clone(), unit, is))
            .collect();
        let wanted: BTreeSet<String> = (offered(&case(&document, &beside())).iter())
            .map(|effect| format!("{} {:?}", renamed(&effect.name(), &by), effect.plausible))
            .collect();
        let found: BTreeSet<String> = (offered(&case(&other, &renamed_beside)).iter())
            .map(|effect| format!("{} {:?}", effect.name(), effect.plausible))
            .collect();
        // products are written in the order of quantities, sensors in that of the document
        let missing: Vec<&String> = wanted.difference(&found).collect();
        let new: Vec<&String> = found.difference(&wanted).collect();
        assert!(
            missing.is_empty() && new.is_empty(),
            "{}: {missing:#?} {new:#?}",
            document.name
        );
    }
}

/// Only the flow angle is declared; all else by equations.
#[test]
fn structure_tells_what_names_do_not() {
    let mut document = catalog::find("short-period").unwrap();
    let by = opaque_names(&document);
    for state in document.states.values_mut() {
        state.quantity = state.quantity.filter(|quantity| quantity.is_flow_angle());
    }
    document
        .inputs
        .values_mut()
        .for_each(|input| input.quantity = None);
    document
        .outputs
        .values_mut()
        .for_each(|output| output.quantity = None);
    let found = names(&offered(&case(&with_other_names(&document, &by), &[])));
    let declared = catalog::find("short-period").unwrap();
    let wanted = names(&offered(&case(&declared, &[])));
    let wanted: BTreeSet<String> = wanted.iter().map(|name| renamed(name, &by)).collect();
    assert_eq!(found, wanted);
}

#[test]
fn candidates_stay_few_and_are_all_fit() {
    for document in catalog::all() {
        let case = case(&document, &beside());
        let effects = offered(&case);
        println!("{}: {}", document.name, effects.len());
        assert!(effects.len() <= 300, "{}: {}", document.name, effects.len());
        let mut seen = BTreeSet::new();
        for effect in &effects {
            assert!(seen.insert(effect.name()), "{} twice", effect.name());
            let edited = effect
                .apply(&document)
                .unwrap_or_else(|e| panic!("{}: {e}", effect.name()));
            Model::compile(&edited).unwrap_or_else(|f| panic!("{}: {f:#?}", effect.name()));
        }
    }
}

#[test]
fn flow_angles_that_are_definitions_take_part() {
    let found = names(&of("six-degrees-of-freedom"));
    for name in [
        "missing_term alpha^2 in Cm",
        "missing_term alpha*beta in Cl",
        "missing_term beta^3 in Cn",
        "missing_term q in Cl",
        "unsteady_aero of Cm (alpha)",
        "sensor_position of alpha (x)",
        "gust of beta",
        "process_noise of w",
    ] {
        assert!(found.contains(name), "no {name}");
    }
    // what the model holds already, with its derivative or through a definition
    for name in [
        "missing_term q in Cm",
        "missing_term alpha in Cm",
        "missing_term p in Cl",
    ] {
        assert!(!found.contains(name), "{name}");
    }
}

#[test]
fn kinematics_take_no_aerodynamics() {
    let kinematic = ["u", "v", "w", "phi", "theta", "psi", "h", "x", "y", "z"];
    for document in catalog::all() {
        for effect in offered(&case(&document, &beside())) {
            let aerodynamic = matches!(
                effect.kind,
                EffectKind::Edit(
                    EditKind::MissingTerm | EditKind::UnrecordedInput | EditKind::UnsteadyAero
                )
            );
            let kinematic = kinematic.contains(&effect.target.as_str());
            assert!(
                !(aerodynamic && kinematic),
                "{}: {}",
                document.name,
                effect.name()
            );
        }
    }
    for model in [
        "flight-path-reconstruction",
        "flight-path-reconstruction-attitude",
    ] {
        let found = names(&of(model));
        assert!(
            !found.iter().any(|name| name.starts_with("missing_term")),
            "{found:?}"
        );
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
fn what_the_document_fixes_comes_first() {
    let effects = of("six-degrees-of-freedom");
    let fixed = |effect: &&Effect| effect.kind == EffectKind::Edit(EditKind::FixedParameter);
    let first: Vec<&str> = effects
        .iter()
        .take_while(fixed)
        .map(|effect| effect.target.as_str())
        .collect();
    let all = [
        "Cxde", "CxTc", "Cyp", "Cyr", "Cyda", "CyTc", "Czad", "CzTc", "ClTc", "Cmad", "CmTc",
        "CnTc",
    ];
    assert_eq!(first, all);
    let document = catalog::find("six-degrees-of-freedom").unwrap();
    let freed = effects[9].apply(&document).unwrap();
    assert!(!freed.parameters["Cmad"].fixed);
    // the steady flight, starts of maneuvers and what is read off the data are no candidates
    for (model, wanted) in [
        ("lateral-directional-4", vec![]),
        ("lateral-directional-2", vec!["da_bias", "dr_bias"]),
        ("longitudinal", vec!["Xde"]),
        ("flight-path-reconstruction", vec![]),
        (
            "flight-path-reconstruction-attitude",
            vec!["f_alpha", "b_alpha", "f_beta", "b_beta"],
        ),
    ] {
        let effects = of(model);
        let found: Vec<&str> = effects
            .iter()
            .filter(fixed)
            .map(|e| e.target.as_str())
            .collect();
        assert_eq!(found, wanted, "{model}");
    }
}

#[test]
fn products_with_recorded_channels_are_offered_about_a_reference() {
    let effects = of("lateral-directional-2");
    let found = |name: &str| {
        let found = effects.iter().find(|effect| effect.name() == name);
        found.unwrap_or_else(|| panic!("no {name}")).edits[0].clone()
    };
    let product = found("missing_term alpha*p in p");
    assert_eq!(product.channels.keys().collect::<Vec<_>>(), ["alpha"]);
    // the mean of the recorded one; the rate about zero
    assert!(matches!(product.about["alpha"], Reference::Value(mean) if (mean - 1.0).abs() < 0.1));
    assert!(!product.about.contains_key("p"));
    for name in [
        "missing_term alpha*beta in r",
        "missing_term V*beta in ay",
        "missing_term alpha*dr in ay",
        "unrecorded_input of p (q)",
        "unrecorded_input of r (df)",
    ] {
        found(name);
    }
    let effects = of("short-period");
    let square = effects
        .iter()
        .find(|effect| effect.name() == "missing_term alpha^2 in q");
    let edited = square
        .unwrap()
        .apply(&catalog::find("short-period").unwrap())
        .unwrap();
    let equation = &edited.states["q"].derivative;
    assert!(
        equation.contains("q_term*((alpha - alpha_eq)^2)"),
        "{equation}"
    );
    let effects = of("longitudinal-nonlinear");
    let square = effects
        .iter()
        .find(|effect| effect.name() == "missing_term alpha^2 in Cm");
    let edited = square
        .unwrap()
        .apply(&catalog::find("longitudinal-nonlinear").unwrap())
        .unwrap();
    assert!(edited.parameters["alpha_about"].fixed);
    assert!(
        edited.definitions["Cm"]
            .equation
            .contains("(alpha - alpha_about)^2")
    );
}

#[test]
fn what_does_not_move_is_no_input_and_no_factor() {
    let document = catalog::find("lateral-directional-2").unwrap();
    let mut still = case(&document, &beside());
    let channels = &mut still.flights[0].channels;
    for name in ["alpha", "df"] {
        channels[name].0.fill(0.05);
    }
    // a speed that wanders by some parts in a thousand
    (channels["V"].0.iter_mut()).for_each(|v| *v = 100.0 + 0.01 * *v);
    let found = names(&offered(&still));
    for part in ["alpha", "df", "V*"] {
        assert!(
            !found.iter().any(|name| name.contains(part)),
            "{part} in {found:#?}"
        );
    }
    assert!(!found.contains("missing_term qbar in all"));
    // consumed by a formula: there for starts only
    let mut used = case(&document, &beside());
    used.consumed = vec!["df".to_string()];
    assert!(
        !names(&offered(&used))
            .iter()
            .any(|name| name.contains("df"))
    );
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
            "ax+ay+az",
            "p+q+r",
            "phi+theta+psi",
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
    let edited = gyros.apply(&document).unwrap();
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
    let edited = steady.apply(&still).unwrap();
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
    let edited = vane.apply(&document).unwrap();
    assert_eq!(edited.parameters["alpha_x"].upper, Some(15.0));
    assert_eq!(edited.parameters["alpha_x"].prior, None);
    let gyro = find(&usual, "sensor_scale of q").unwrap();
    assert_eq!(gyro.plausible.unwrap().lower, -0.1);
    let vane_delay = find(&usual, "sensor_delay of alpha")
        .unwrap()
        .apply(&document)
        .unwrap();
    assert_eq!(vane_delay.parameters["alpha_delay"].lower, Some(0.0));
    // declared where it is: not moved again
    let mut placed = document.clone();
    placed.constants["x_alpha"].value = 8.0;
    let vane = find(&case(&placed, &beside()), "sensor_position of alpha (x)").unwrap();
    assert!(vane.plausible.unwrap().known);
    assert_eq!(
        vane.apply(&placed).unwrap().parameters["alpha_x"].upper,
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
    let prior = vane.apply(&placed).unwrap().parameters["alpha_x"]
        .prior
        .unwrap();
    assert_eq!((prior.mean, prior.sd), (0.0, 0.1));
    let gyros = find(&told, "sensor_delay of p+q+r")
        .unwrap()
        .apply(&placed)
        .unwrap();
    assert_eq!(gyros.parameters["p_q_r_delay"].upper, Some(0.02));
}

/// Derivatives grow with the speed as their units say: the damping less than the stiffness.
#[test]
fn damping_scales_otherwise_than_stiffness() {
    let effects = of("short-period");
    let all = effects
        .iter()
        .find(|effect| effect.name() == "missing_term qbar in all")
        .unwrap();
    let edited = all.apply(&catalog::find("short-period").unwrap()).unwrap();
    let pitching = &edited.states["q"].derivative;
    assert!(pitching.contains("(Ma*qbar_ratio)") && pitching.contains("(Mq*speed_ratio_1)"));
    assert!(edited.definitions["qbar_ratio"].equation.contains("^2"));
    assert!(
        edited.states["alpha"]
            .derivative
            .contains("(Za*speed_ratio_1)")
    );
}

#[test]
fn the_answer_says_what_was_taken_for_what() {
    let mut document = catalog::find("short-period").unwrap();
    document
        .outputs
        .values_mut()
        .for_each(|output| output.quantity = None);
    let quantities = Quantities::of(&document);
    assert_eq!(quantities.output("q"), Some(PhysicalQuantity::PitchRate));
    let told = super::taken_for(&case(&document, &beside()));
    let of = |name: &str| told.iter().find(|taken| taken.name == name).unwrap();
    assert_eq!(of("de").quantity, PhysicalQuantity::Elevator);
    assert_eq!(of("de").reason, "the model says so");
    assert_eq!(of("V").reason, "the job says so");
}
