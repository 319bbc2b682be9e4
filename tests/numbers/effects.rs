//! Each effect of the catalogue on a model that it fits: without effect it is the model before, with effect it
//! does what it says.

use indexmap::IndexMap;
use trimtab_core::flight::Maneuver;
use trimtab_core::flight::Unit;
use trimtab_core::model::{Edit, EditKind, Input, Model, ModelDocument, Start, catalog};
use trimtab_core::simulate::{
    InputInterpolation, Integrator, Scenario, ScenarioEffect, Segment, Steps, Substeps, simulate,
};

const STEP: f64 = 0.02;
const COUNT: usize = 500;

/// An input by its name: around the trim of the catalog's models, none of them zero.
fn input(name: &str, k: usize) -> f64 {
    let t = k as f64 * STEP;
    let pulse = if (1.0..2.0).contains(&t) {
        0.02
    } else if (2.0..3.0).contains(&t) {
        -0.02
    } else {
        0.0
    };
    match name {
        "V" => 105.0 + 2.0 * t,
        "thrust" => 9000.0,
        "az" => -9.7 + 0.5 * (0.7 * t).sin(),
        "ax" | "ay" => 0.3 * (0.5 * t).sin(),
        "de" => -0.02 + pulse,
        "p" | "q" | "r" | "beta" => 0.05 * (0.8 * t).sin(),
        _ => pulse,
    }
}

fn start(model: &Model, name: &str, text: &str) -> f64 {
    let unit = |name: &str| {
        let found = model.parameters.iter().find(|p| p.name == name);
        found.map_or(String::new(), |p| p.document.unit.clone())
    };
    let inside = text
        .trim_start_matches("first(")
        .trim_start_matches("mean(");
    let inside = inside.trim_end_matches(')').trim_end_matches(", 5");
    if model.document.inputs.contains_key(inside) {
        return input(inside, 0);
    }
    match unit(name).as_str() {
        "m/s" if name.starts_with("v_") => 0.0,
        "m/s" if name.starts_with("w_") => 5.0,
        "m/s" => 105.0,
        "m" => 1000.0,
        "rad" if text.contains("alpha") || text.contains("theta") => 0.06,
        _ => 0.0,
    }
}

/// Outputs by name; `values` are in the parameters' units.
pub(crate) fn outputs(
    document: &ModelDocument,
    values: &[(&str, f64)],
) -> IndexMap<String, Vec<f64>> {
    let model = Model::compile(document).unwrap_or_else(|faults| panic!("{faults:#?}"));
    let parameters: Vec<f64> = (model.parameters.iter())
        .map(|info| {
            let given = values.iter().find(|(name, _)| *name == info.name);
            match (given, &info.document.start) {
                (Some((_, value)), _) => info.unit.to_si(*value),
                (None, Start::Value(value)) => info.unit.to_si(*value),
                (None, Start::FromData(text)) => start(&model, &info.name, text),
            }
        })
        .collect();
    for (name, _) in values {
        assert!(document.parameters.contains_key(*name), "no {name}");
    }
    let segment = Segment {
        label: String::new(),
        time: (0..COUNT).map(|k| k as f64 * STEP).collect(),
        steps: Steps::Even(STEP),
        substeps: Substeps::default(),
        inputs: (model.inputs.iter())
            .map(|quantity| (0..COUNT).map(|k| input(&quantity.name, k)).collect())
            .collect(),
        measured: Vec::new(),
    };
    let mut series = vec![Vec::new(); model.outputs.len()];
    simulate(
        &model,
        Integrator::Rk4,
        InputInterpolation::Linear,
        &segment,
        &parameters,
        |_, y: &[f64]| series.iter_mut().zip(y).for_each(|(s, y)| s.push(*y)),
    );
    let names = model.outputs.iter().map(|output| output.name.clone());
    names.zip(series).collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert!(a.iter().chain(b).all(|y| y.is_finite()));
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

fn size(series: &[f64]) -> f64 {
    apart(series, &vec![series[0]; series.len()]).max(1e-3)
}

fn edit(kind: EditKind, target: &str, term: &str) -> Edit {
    let edit = Edit::new(kind, target);
    if term.is_empty() {
        edit
    } else {
        edit.with_term(term)
    }
}

struct Case {
    model: &'static str,
    edit: Edit,
    /// Values of no effect beyond the starts, and how far from the model before they are, by the size of an output.
    none: &'static [(&'static str, f64)],
    tolerance: f64,
    /// Values with effect, and an output that sees it.
    some: &'static [(&'static str, f64)],
    seen: &'static str,
    inputs: &'static [&'static str],
}

impl Case {
    /// With a recorded channel that the model does not use.
    fn beside(mut self, channel: &str, unit: &str) -> Self {
        let input = Input {
            unit: unit.into(),
            ..Input::default()
        };
        self.edit.channels.insert(channel.into(), input);
        self
    }
}

#[rustfmt::skip]
fn cases() -> Vec<Case> {
    use EditKind::*;
    type Values = &'static [(&'static str, f64)];
    let case = |model, kind, target, term, none: Values, tolerance, some: Values, seen| Case {
        model, edit: edit(kind, target, term), none, tolerance, some, seen, inputs: &[],
    };
    let sp = "short-period";
    let with = |inputs, case: Case| Case { inputs, ..case };
    vec![
        case(sp, SensorBias, "q", "", &[], 0.0, &[("q_bias_2", 0.01)], "q"),
        case(sp, SensorScale, "q", "", &[], 0.0, &[("q_scale", 0.1)], "q"),
        case(sp, SensorDrift, "alpha", "", &[], 0.0, &[("alpha_drift", 0.01)], "alpha"),
        case(sp, SensorDelay, "alpha+q", "", &[], 1e-12, &[("alpha_q_delay", 0.1)], "q"),
        case(sp, SensorLag, "q", "", &[], 0.0, &[("q_lag", 0.3)], "q"),
        case("longitudinal-nonlinear", SensorLag, "az", "", &[], 0.0, &[("az_lag", 0.3)], "az"),
        with(&["V"], case(sp, SensorPosition, "alpha", "", &[], 0.0, &[("alpha_x", 5.0)], "alpha")),
        case("lateral-directional-4", SensorPosition, "ay", "x", &[], 1e-12, &[("ay_x", 2.0)], "ay"),
        case("lateral-directional-4", SensorPosition, "beta", "z", &[], 1e-12, &[("beta_z", 2.0)], "beta"),
        case("six-degrees-of-freedom", SensorPosition, "az", "x", &[], 1e-12, &[("az_x", 2.0)], "az"),
        case("flight-path-reconstruction", SensorBias, "az", "", &[], 1e-9, &[("az_bias_2", 0.1)], "z"),
        with(&["qdot"], case("flight-path-reconstruction", SensorPosition, "az", "x", &[], 1e-9, &[("az_x", 1.0)], "z")),
        case("lateral-directional-4", SensorCrossAxis, "r", "p", &[], 1e-12, &[("r_sees_p", 0.1)], "r"),
        with(&["p"], case(sp, SensorCrossAxis, "q", "p", &[], 0.0, &[("q_sees_p", 0.1)], "q")).beside("p", "rad/s"),
        case("flight-path-reconstruction", SensorCrossAxis, "ay", "az", &[], 1e-9, &[("ay_sees_az", 0.05)], "beta"),
        case("lateral-directional-4", SwappedChannels, "p+r", "", &[], 1e-12, &[("p_r_swapped", 1.0)], "r"),
        case(sp, SwappedChannels, "alpha+q", "", &[], 1e-12, &[("alpha_q_swapped", 1.0)], "q"),
        case(sp, InputBias, "de", "", &[], 0.0, &[("de_bias", 0.01)], "q"),
        case(sp, InputScale, "de", "", &[], 1e-12, &[("de_scale", 0.2)], "q"),
        case(sp, InputDelay, "de", "", &[], 1e-9, &[("de_delay", 0.1)], "q"),
        case(sp, ActuatorLag, "de", "", &[], 0.0, &[("de_lag", 0.3)], "q"),
        case(sp, ActuatorRateLimit, "de", "", &[("de_rate_limit", 1e9)], 0.0, &[("de_rate_limit", 0.02)], "q"),
        case(sp, Backlash, "de", "", &[], 0.0, &[("de_backlash", 0.01)], "q"),
        with(&["dt"], case(sp, UnrecordedInput, "q", "dt[rad]", &[], 0.0, &[("q_dt", -1.0)], "q")),
        case(sp, MissingTerm, "q", "alpha^2", &[], 0.0, &[("q_term", -10.0)], "q"),
        case(sp, MissingTerm, "q", "alphadot", &[], 0.0, &[("q_term", -1.0)], "q"),
        with(&["V"], case(sp, MissingTerm, "all", "qbar", &[], 1e-12, &[("qbar_share", 1.0), ("V_ref", 100.0)], "q")),
        with(&["V"], case("lateral-directional-4", MissingTerm, "all", "qbar", &[], 1e-12, &[("qbar_share", 1.0)], "p")),
        case(sp, UnsteadyAero, "q", "alpha", &[], 0.0, &[("q_unsteady", -2.0)], "q"),
        case("six-degrees-of-freedom", UnsteadyAero, "Cm", "alpha", &[], 1e-12, &[("Cm_unsteady", -0.5)], "q"),
        case("longitudinal-nonlinear", StallHysteresis, "CL+Cm", "alpha", &[("alpha_stall", 90.0)], 1e-12, &[("alpha_stall", 5.0), ("Cm_X", -0.1)], "alpha"),
        case(sp, StallHysteresis, "alpha+q", "", &[("alpha_stall", 90.0)], 1e-12, &[("alpha_stall", 5.0)], "q"),
        case(sp, Gust, "alpha", "", &[], 0.0, &[("alpha_gust", 0.02), ("alpha_gust_time", 3.0)], "q"),
        case("six-degrees-of-freedom", Gust, "beta", "", &[], 1e-12, &[("beta_gust", 0.02)], "r"),
        case("flight-path-reconstruction", Wind, "Wx", "constant", &[], 1e-9, &[("W_x_constant", 3.0)], "x"),
        case("flight-path-reconstruction", Wind, "W_y", "ramp", &[], 1e-9, &[("W_y_ramp", 0.3)], "beta"),
        case("flight-path-reconstruction", Wind, "W_z", "shear", &[], 1e-9, &[("W_z_shear", 0.05)], "alpha"),
        case("flight-path-reconstruction-attitude", FixedParameter, "b_alpha", "", &[], 0.0, &[("b_alpha", 0.02)], "alpha"),
        case(sp, InitialState, "q", "", &[], 0.0, &[("q_start", 0.01)], "q"),
        case(sp, StructuralMode, "q", "de", &[], 0.0, &[("q_mode_gain", 1.0)], "q"),
    ]
}

#[test]
fn without_effect_an_edited_model_is_the_model_before_and_with_it_is_not() {
    let mut kinds = Vec::new();
    for case in cases() {
        let what = format!("{} {:?}", case.model, case.edit);
        kinds.push(case.edit.kind);
        let before = catalog::find(case.model).expect("a catalog model");
        let added = (case.edit.apply(&before)).unwrap_or_else(|error| panic!("{what}: {error}"));
        let after = added.document.clone();
        let json = serde_json::to_string(&after).expect("JSON");
        assert_eq!(serde_json::from_str::<ModelDocument>(&json).unwrap(), after);
        let text = toml::to_string(&after).expect("TOML");
        assert_eq!(toml::from_str::<ModelDocument>(&text).unwrap(), after);
        assert_eq!(added.inputs, case.inputs, "{what}");
        // new, or no longer fixed
        let is_new = |name: &&String| {
            let known = before.parameters.get(*name);
            known.is_none_or(|known| known.fixed && !after.parameters[*name].fixed)
        };
        let new: Vec<&String> = after.parameters.keys().filter(is_new).collect();
        let named: Vec<&String> = added.added.iter().map(|added| &added.name).collect();
        assert_eq!(named, new, "{what}");
        for name in named {
            let parameter = &after.parameters[name];
            assert!(
                !parameter.description.is_empty() && !parameter.unit.is_empty(),
                "{what}"
            );
            Unit::parse(&parameter.unit).expect("a unit");
        }
        assert_eq!(added.added[0].name, case.some[0].0, "{what}");
        let declared = outputs(&before, &[]);
        let none = outputs(&after, case.none);
        for (name, y) in &declared {
            let distance = apart(y, &none[name]) / size(y);
            assert!(
                distance <= case.tolerance,
                "{what}: {name} is {distance:e} apart"
            );
        }
        let values: Vec<(&str, f64)> = (case.none.iter())
            .filter(|(name, _)| !case.some.iter().any(|(other, _)| other == name))
            .chain(case.some)
            .copied()
            .collect();
        let some = outputs(&after, &values);
        let distance = apart(&declared[case.seen], &some[case.seen]) / size(&declared[case.seen]);
        let least = (5.0 * case.tolerance).clamp(1e-3, 0.2);
        assert!(
            distance > least,
            "{what}: {} is {distance:e} apart",
            case.seen
        );
    }
    for kind in EditKind::ALL {
        assert!(kinds.contains(&kind), "{kind:?} is not tried");
        assert_eq!(EditKind::find(kind.name()), Some(kind));
        assert_eq!(serde_json::to_value(kind).unwrap(), kind.name());
    }
}

fn means(series: &[f64], from: usize, to: usize) -> f64 {
    series[from..to].iter().sum::<f64>() / (to - from) as f64
}

#[test]
fn effects_go_the_right_way() {
    let before = catalog::find("short-period").expect("a model");
    let run = |edit: &Edit, values: &[(&str, f64)]| {
        outputs(&edit.apply(&before).expect("edited").document, values)
    };
    let declared = outputs(&before, &[]);
    // a sensor that lags, an actuator that lags and a delay: what they see is behind
    let delayed = run(&edit(EditKind::SensorDelay, "q", ""), &[("q_delay", 0.2)]);
    assert!((delayed["q"][110] - declared["q"][100]).abs() < 1e-9);
    let lagged = run(&edit(EditKind::SensorLag, "q", ""), &[("q_lag", 0.2)]);
    let fall = 50..80;
    assert!(declared["q"][75] < -1e-3);
    for k in fall {
        assert!(lagged["q"][k] >= declared["q"][k] - 1e-12, "sample {k}");
    }
    // pitching up, a vane ahead of the centre of gravity sees less
    let vane = run(
        &edit(EditKind::SensorPosition, "alpha", "x"),
        &[("alpha_x", 10.0)],
    );
    for (k, y) in vane["alpha"].iter().enumerate() {
        let wanted = declared["alpha"][k] - 10.0 * declared["q"][k] / input("V", k);
        assert!((y - wanted).abs() < 1e-12, "sample {k}");
    }
    // axes that are not the aircraft's, and channels exchanged
    let lateral = catalog::find("lateral-directional-4").expect("a model");
    let own = outputs(&lateral, &[]);
    let run_lateral = |edit: &Edit, values: &[(&str, f64)]| {
        outputs(&edit.apply(&lateral).expect("edited").document, values)
    };
    let turned = run_lateral(
        &edit(EditKind::SensorCrossAxis, "r", "p"),
        &[("r_sees_p", 0.1)],
    );
    let exchanged = run_lateral(
        &edit(EditKind::SwappedChannels, "p+r", ""),
        &[("p_r_swapped", 1.0)],
    );
    for k in 0..COUNT {
        assert!((turned["r"][k] - own["r"][k] - 0.1 * own["p"][k]).abs() < 1e-12);
        assert!((exchanged["r"][k] - own["p"][k]).abs() < 1e-12);
        assert!((exchanged["p"][k] - own["r"][k]).abs() < 1e-12);
    }
    let unfit = |target: &str| edit(EditKind::SwappedChannels, target, "").apply(&lateral);
    for target in ["p", "p+p", "p+ay", "p+q", "p+r+phi"] {
        assert!(unfit(target).is_err(), "{target}");
    }
    // dead band: half of the deflection gets through
    let loose = run(
        &edit(EditKind::Backlash, "de", ""),
        &[("de_backlash", 0.01)],
    );
    let share = means(&loose["q"], 60, 90) / means(&declared["q"], 60, 90);
    assert!((0.3..0.6).contains(&share), "{share}");
    // a gust from below turns the vane up and pitches a stable aircraft down, and neither before it comes
    let gust = run(
        &edit(EditKind::Gust, "alpha", ""),
        &[("alpha_gust", 0.05), ("alpha_gust_time", 4.0)],
    );
    assert!(apart(&gust["q"][..200], &declared["q"][..200]) < 1e-12);
    let height = gust["alpha"][225] - declared["alpha"][225];
    assert!((0.03..0.05).contains(&height), "{height}");
    assert!(means(&gust["q"], 210, 240) < means(&declared["q"], 210, 240) - 1e-3);
    // a mode rings at its frequency
    let ringing = run(
        &edit(EditKind::StructuralMode, "q", "de"),
        &[("q_mode_gain", 1.0)],
    );
    let mode: Vec<f64> = ringing["q"]
        .iter()
        .zip(&declared["q"])
        .map(|(a, b)| a - b)
        .collect();
    assert!(mode[..50].iter().all(|y| y.abs() < 1e-12));
    let changes = mode[170..420]
        .windows(2)
        .filter(|pair| pair[0] * pair[1] < 0.0)
        .count();
    // 5 s at 12 rad/s: 9.5 periods
    assert!((17..=21).contains(&changes), "{changes}");
    let before = catalog::find("flight-path-reconstruction").expect("a model");
    let ramp = edit(EditKind::Wind, "Wx", "ramp")
        .apply(&before)
        .expect("edited")
        .document;
    let (still, ramped) = (outputs(&before, &[]), outputs(&ramp, &[("W_x_ramp", 0.5)]));
    // the air speeds up, the aircraft in it keeps its way over ground
    assert!(ramped["V"][COUNT - 1] < still["V"][COUNT - 1] - 3.0);
    assert!((ramped["x"][COUNT - 1] - still["x"][COUNT - 1]).abs() < 0.5);
}

#[test]
fn what_does_not_fit_is_refused_with_what_there_is() {
    let refused = |model: &str, kind, target: &str, term: &str| {
        let document = catalog::find(model).expect("a catalog model");
        let error = edit(kind, target, term)
            .apply(&document)
            .expect_err("a refusal");
        (error.code(), error.to_string())
    };
    use EditKind::*;
    let sp = "short-period";
    let cases = [
        (
            refused(sp, SensorLag, "beta", ""),
            "unknown_target",
            "alpha, q",
        ),
        (
            refused(sp, SensorDelay, "alpha+beta", ""),
            "unknown_target",
            "alpha, q",
        ),
        (
            refused(sp, SensorPosition, "q", ""),
            "unfit_target",
            "flow angle",
        ),
        (
            refused(sp, SensorPosition, "alpha", "z"),
            "unfit_target",
            "does not depend",
        ),
        (
            refused(sp, SensorPosition, "alpha", "y"),
            "unfit_target",
            "none of p",
        ),
        (
            refused(sp, SensorPosition, "alpha", "w"),
            "bad_term",
            "\"x\", \"y\" or \"z\"",
        ),
        (
            refused(sp, ActuatorLag, "da", ""),
            "unknown_target",
            "it has de",
        ),
        (
            refused(sp, Backlash, "q", ""),
            "unknown_target",
            "it has de",
        ),
        (refused(sp, UnrecordedInput, "q", "dt"), "bad_term", "unit"),
        (
            refused(sp, UnrecordedInput, "q", "q[rad/s]"),
            "unfit_target",
            "something else",
        ),
        (
            refused(sp, UnrecordedInput, "CL", "dt[rad]"),
            "unknown_target",
            "alpha, q",
        ),
        (
            refused(sp, UnsteadyAero, "q", "beta"),
            "unknown_target",
            "alpha, q",
        ),
        (
            refused(sp, StallHysteresis, "CL", ""),
            "unknown_target",
            "alpha, q",
        ),
        (refused(sp, Gust, "beta", ""), "unknown_target", "alpha, q"),
        (
            refused(sp, Wind, "Wx", "constant"),
            "unknown_target",
            "it has none",
        ),
        (
            refused("flight-path-reconstruction", Wind, "Wv", "constant"),
            "unknown_target",
            "W_x, W_y, W_z",
        ),
        (
            refused("flight-path-reconstruction", Wind, "Wx", "gusty"),
            "bad_term",
            "shear",
        ),
        (
            refused(sp, InitialState, "theta", ""),
            "unknown_target",
            "alpha, q",
        ),
        (
            refused(sp, StructuralMode, "q", "da"),
            "bad_term",
            "it has de",
        ),
        (
            refused(sp, StructuralMode, "q", ""),
            "missing_term_absent",
            "input",
        ),
        (refused(sp, MissingTerm, "all", "alpha"), "bad_term", "qbar"),
        (
            refused("flight-path-reconstruction", MissingTerm, "all", "qbar"),
            "unfit_target",
            "no free parameter",
        ),
    ];
    for ((code, message), wanted, words) in cases {
        assert_eq!(code, wanted, "{message}");
        assert!(message.contains(words), "{message}");
    }
}

fn scenario() -> Scenario {
    toml::from_str(include_str!("../../data/elevator.toml")).expect("a scenario")
}

fn fly(scenario: &Scenario) -> Maneuver {
    let document = catalog::find(&scenario.model).expect("a catalog model");
    let model = Model::compile(&document).expect("a model");
    (scenario.fly(&model)).unwrap_or_else(|error| panic!("{error}"))
}

fn recorded<'m>(maneuver: &'m Maneuver, channel: &str) -> &'m [f64] {
    &maneuver.channels()[channel].values
}

#[test]
fn a_scenario_with_an_effect_differs_by_the_effect_alone() {
    let plain = fly(&scenario());
    let with = |effects: &str| {
        let text = format!("{}\n{effects}", include_str!("../../data/elevator.toml"));
        let scenario: Scenario = toml::from_str(&text).expect("a scenario");
        let made = fly(&scenario);
        assert_eq!(made.digest(), fly(&scenario).digest());
        made
    };
    let biased = with("[[effects]]\nkind = \"sensor_bias\"\ntarget = \"alpha\"\nvalue = 0.01");
    assert_eq!(recorded(&biased, "q"), recorded(&plain, "q"));
    for (a, b) in recorded(&biased, "alpha")
        .iter()
        .zip(recorded(&plain, "alpha"))
    {
        assert!((a - b - 0.01).abs() < 1e-12);
    }
    // the model sees the channel's true value, the recording has its noise
    let vane = with(
        "[[effects]]\nkind = \"sensor_position\"\ntarget = \"alpha\"\nvalues = { alpha_x = 6.5 }",
    );
    assert_eq!(recorded(&vane, "V"), recorded(&plain, "V"));
    assert_eq!(recorded(&vane, "q"), recorded(&plain, "q"));
    let clean: Scenario = Scenario {
        outputs: scenario()
            .outputs
            .into_iter()
            .map(|(name, output)| {
                (
                    name,
                    trimtab_core::simulate::ScenarioOutput {
                        noise: 0.0,
                        ..output
                    },
                )
            })
            .collect(),
        ..scenario()
    };
    let rates = fly(&clean);
    for (k, (a, b)) in recorded(&vane, "alpha")
        .iter()
        .zip(recorded(&plain, "alpha"))
        .enumerate()
    {
        let q = recorded(&rates, "q")[k] - 0.002;
        assert!((a - b + 6.5 * q / 130.0).abs() < 1e-9, "sample {k}");
    }
    // a parameter that starts at what is recorded is read off the designed input
    let slow = with("[[effects]]\nkind = \"actuator_lag\"\ntarget = \"de\"\nvalue = 0.3");
    assert_eq!(recorded(&slow, "de"), recorded(&plain, "de"));
    assert_eq!(recorded(&slow, "q")[..150], recorded(&plain, "q")[..150]);
    assert!(apart(recorded(&slow, "q"), recorded(&plain, "q")) > 0.01);
    // data effects: some samples, by their size
    let spiky = with(
        "[[effects]]\nkind = \"sensor_outliers\"\ntarget = \"q\"\nvalues = { spikes = 0.02, size = 5.0 }",
    );
    assert_eq!(recorded(&spiky, "alpha"), recorded(&plain, "alpha"));
    let size = 5.0_f64.to_radians();
    let pairs = recorded(&spiky, "q").iter().zip(recorded(&plain, "q"));
    let spikes: Vec<f64> = pairs
        .map(|(a, b)| (a - b).abs())
        .filter(|d| *d > 0.0)
        .collect();
    assert!((3..30).contains(&spikes.len()) && spikes.iter().all(|d| (d - size).abs() < 1e-12));
    let turbulent =
        with("[[effects]]\nkind = \"process_noise\"\ntarget = \"alpha\"\nvalue = 0.005");
    assert!(apart(recorded(&turbulent, "alpha"), recorded(&plain, "alpha")) > 1e-3);
}

#[test]
fn a_scenario_names_what_is_wrong_with_an_effect() {
    let refused = |text: &str| {
        let mut scenario = scenario();
        scenario.effects = vec![ScenarioEffect::parse(text).expect("an effect")];
        let document = catalog::find(&scenario.model).expect("a catalog model");
        let model = Model::compile(&document).expect("a model");
        scenario.fly(&model).expect_err("a refusal").to_string()
    };
    assert!(
        refused("sensor_noise:q=1")
            .contains("there is no effect 'sensor_noise'; choose one of fixed_parameter")
    );
    assert!(refused("sensor_bias:beta=1").contains("it has alpha, q"));
    assert!(refused("sensor_outliers:beta=0.1").contains("recorded are de, alpha, q, V"));
    assert!(
        refused("unrecorded_input:q:dt[rad]=1")
            .contains("inputs.dt: the model's input is not designed")
    );
    assert!(ScenarioEffect::parse("sensor_bias").is_err());
    let effect = ScenarioEffect::parse("missing_term:q:alpha^2=-8").expect("an effect");
    assert_eq!(
        (effect.term.as_deref(), effect.value),
        (Some("alpha^2"), Some(-8.0))
    );
}

#[test]
fn inputs_are_designed_or_recorded() {
    let design = |text: &str| {
        let mut scenario = scenario();
        scenario.inputs["de"].design = toml::from_str(text).expect("a design");
        scenario.inputs["de"].trim = 0.0;
        scenario
    };
    let degrees = |maneuver: &Maneuver| -> Vec<f64> {
        recorded(maneuver, "de")
            .iter()
            .map(|de| de.to_degrees())
            .collect()
    };
    let steps = degrees(&fly(&design(
        "shape = \"steps\"\nsteps = [[1.0, 2.0], [2.0, -1.0]]",
    )));
    assert!(
        steps[24].abs() < 1e-12
            && (steps[25] - 2.0).abs() < 1e-12
            && (steps[600] + 1.0).abs() < 1e-12
    );
    let text = "shape = \"multisine\"\nstart = 5.0\nduration = 10.0\nfrequencies = [0.2, 0.5, 0.9, 1.3]\namplitude = 1.0";
    let sines = degrees(&fly(&design(text)));
    let power = sines[125..375].iter().map(|u| u * u).sum::<f64>() / 250.0;
    assert!((power - 0.5).abs() < 0.01 && sines[400] == 0.0, "{power}");
    let text =
        "shape = \"sweep\"\nstart = 5.0\nduration = 10.0\nfrom = 0.1\nto = 2.0\namplitude = 1.0";
    let sweep = degrees(&fly(&design(text)));
    let changes = sweep[126..375]
        .windows(2)
        .filter(|pair| pair[0] * pair[1] < 0.0)
        .count();
    assert!((19..=22).contains(&changes), "{changes}");
    let inline = degrees(&fly(&design(
        "shape = \"recorded\"\ntime = [0.0, 1.0, 25.0]\nvalues = [0.0, 1.0, 1.0]",
    )));
    assert!((inline[10] - 0.4).abs() < 1e-12);
    // the recording of another maneuver
    let mut again = design("shape = \"recorded\"\nfile = \"elevator.csv\"");
    let original = fly(&scenario());
    let document = catalog::find("short-period").expect("a model");
    let model = Model::compile(&document).expect("a model");
    assert!(again.fly(&model).is_err());
    again
        .read_recorded(|file| {
            assert_eq!(file, "elevator.csv");
            Ok(original.clone())
        })
        .expect("read");
    assert!(apart(recorded(&fly(&again), "q"), recorded(&original, "q")) < 1e-9);
}
