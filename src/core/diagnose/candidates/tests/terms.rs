//! Which equations may lack which terms.

use super::{beside, case, names, of, offered};
use crate::diagnose::effect::{Effect, EffectKind};
use crate::model::{EditKind, ModelDocument, Reference, catalog};

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
        "gust of beta (1)",
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
    let freed = effects[9].apply(&document).unwrap().document;
    assert!(!freed.parameters["Cmad"].fixed);
    // the steady flight, starts of maneuvers and what is read off the data are no candidates
    for (model, wanted) in [
        ("lateral-directional-4", vec!["Yp", "Yr"]),
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
        "missing_term p*abs(p) in p",
        "missing_term q in p",
        "missing_term V in r",
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
    let equation = &edited.document.states["q"].derivative;
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
    assert!(edited.document.parameters["alpha_about"].fixed);
    assert!(
        edited.document.definitions["Cm"]
            .equation
            .contains("(alpha - alpha_about)^2")
    );
}

/// Near the hover no flow angle is of use: the velocities take its place.
#[test]
fn velocities_take_part_where_there_is_no_flow_angle() {
    let document: ModelDocument = toml::from_str(HOVER).unwrap();
    let found = names(&offered(&case(&document, &[])));
    for name in [
        "missing_term u^2 in q",
        "missing_term w*abs(w) in w",
        "missing_term u*w in q",
        "missing_term w*dlon in w",
        "missing_term w in q",
        "unsteady_aero of q (w)",
        "unsteady_aero of q (dcol)",
    ] {
        assert!(found.contains(name), "no {name} in {found:#?}");
    }
    // a product with a rate is kinematics
    assert!(!found.contains("missing_term q*w in q"));
}

const HOVER: &str = r#"
name = "hover"
[inputs]
dlon = { unit = "-", quantity = "elevator" }
dcol = { unit = "-", quantity = "thrust" }
[parameters]
Xu = { unit = "1/s", start = -0.05 }
Zw = { unit = "1/s", start = -0.5 }
Zcol = { unit = "m/s^2", start = -25.0 }
Mu = { unit = "1/(m*s)", start = 0.01 }
Mq = { unit = "1/s", start = -2.0 }
Mlon = { unit = "1/s^2", start = 5.0 }
[states]
u = { unit = "m/s", initial = "0", derivative = "Xu*u" }
w = { unit = "m/s", initial = "0", derivative = "Zw*w + Zcol*dcol" }
q = { unit = "rad/s", initial = "0", derivative = "Mu*u + Mq*q + Mlon*dlon" }
[outputs]
q = { unit = "rad/s", equation = "q" }
u = { unit = "m/s", equation = "u" }
"#;

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

/// Derivatives grow with the speed as their units say: the damping less than the stiffness.
#[test]
fn damping_scales_otherwise_than_stiffness() {
    let effects = of("short-period");
    let all = effects
        .iter()
        .find(|effect| effect.name() == "missing_term qbar in all")
        .unwrap();
    let edited = all.apply(&catalog::find("short-period").unwrap()).unwrap();
    let pitching = &edited.document.states["q"].derivative;
    assert!(pitching.contains("(Ma*qbar_ratio)") && pitching.contains("(Mq*speed_ratio_1)"));
    assert!(
        edited.document.definitions["qbar_ratio"]
            .equation
            .contains("^2")
    );
    assert!(
        edited.document.states["alpha"]
            .derivative
            .contains("(Za*speed_ratio_1)")
    );
}
