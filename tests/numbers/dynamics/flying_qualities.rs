//! Equivalent systems, control anticipation, bandwidth, levels.

use serde_json::json;
use trimtab_core::dynamics::{
    AirplaneClass, EquivalentForm, FlightPhaseCategory, FlyingQualities, FlyingQualityQuestion,
    flying_qualities,
};
use trimtab_core::estimate::{Estimate, Measure, ModeName};
use trimtab_core::job::Plan;

use super::{estimated, light_airplane, light_airplane_with, navion};

#[track_caller]
fn near(found: Option<Measure>, expected: f64, within: f64) {
    let found = found.expect("a number").value;
    assert!(
        (found / expected - 1.0).abs() < within,
        "{found} for {expected}"
    );
}

/// scipy.optimize.least_squares on the same mismatch, and crossings of python-control's response on 400 000 frequencies.
#[test]
fn equivalent_system_and_bandwidth_are_those_of_scipy() {
    let (plan, estimate) = light_airplane();
    let question = FlyingQualityQuestion {
        category: Some(FlightPhaseCategory::B),
        class: Some(AirplaneClass::I),
        band: [Some(0.5), Some(10.0)],
        ..FlyingQualityQuestion::default()
    };
    let found = flying_qualities(&plan.problem, &estimate, &question).expect("qualities");
    let names: Vec<_> = found.modes.iter().map(|mode| mode.name).collect();
    assert_eq!(
        names,
        [Some(ModeName::ShortPeriod), Some(ModeName::Phugoid)]
    );
    let [system] = &found.equivalent_systems[..] else {
        panic!("one equivalent system: {:?}", found.equivalent_systems);
    };
    assert_eq!(
        (system.form, system.output.as_str()),
        (EquivalentForm::PitchRate, "q")
    );
    near(Some(system.gain), -9.267_252_770, 1e-6);
    near(system.numerator_root, 2.339_203_466, 1e-6);
    near(system.natural_frequency, 3.804_587_980, 1e-6);
    near(system.damping_ratio, 0.582_094_722, 1e-6);
    near(Some(system.delay), 0.107_837_415, 1e-6);
    assert!(
        (system.mismatch - 0.669_916_190).abs() < 1e-6,
        "{}",
        system.mismatch
    );
    near(found.control_anticipation_parameter, 1.132_147_861, 1e-6);
    assert_eq!(found.airspeed, Some(53.6));
    let [bandwidth] = &found.bandwidths[..] else {
        panic!("one bandwidth");
    };
    assert_eq!(bandwidth.output, "theta");
    near(bandwidth.phase, 3.439_538_027, 1e-6);
    near(bandwidth.neutral_frequency, 5.588_603_114, 1e-6);
    near(bandwidth.gain, 3.610_650_467, 1e-6);
    near(bandwidth.bandwidth, 3.439_538_027, 1e-6);
    near(bandwidth.phase_delay, 0.092_453_259, 1e-6);
    let levels: Vec<_> = (found.levels.iter())
        .map(|c| (c.what.as_str(), c.level))
        .collect();
    let expected = [
        ("short period: damping", Some(1)),
        ("phugoid: damping", Some(1)),
        ("short period: control anticipation parameter", Some(1)),
    ];
    assert_eq!(levels, expected);
}

fn of_band(plan: &Plan, estimate: &Estimate, band: [Option<f64>; 2]) -> FlyingQualities {
    let question = FlyingQualityQuestion {
        band,
        ..FlyingQualityQuestion::default()
    };
    flying_qualities(&plan.problem, estimate, &question).expect("qualities")
}

/// A phugoid that grows slowly changes next to nothing of what is judged above it: numpy's response with the phase from its end at
/// high frequency, and scipy.optimize.least_squares.
#[test]
fn an_unstable_phugoid_leaves_bandwidth_and_equivalent_system() {
    let band = [Some(0.5), Some(10.0)];
    let (plan, estimate) = light_airplane_with(0.02, false);
    let found = of_band(&plan, &estimate, band);
    let phugoid = found.modes.last().expect("a phugoid");
    assert_eq!(phugoid.name, Some(ModeName::Phugoid));
    near(Some(phugoid.real), 0.011_299_23, 1e-6);
    let system = &found.equivalent_systems[0];
    near(Some(system.gain), -9.259_623_683, 1e-6);
    near(system.numerator_root, 2.346_602_575, 1e-6);
    near(system.natural_frequency, 3.808_486_848, 1e-6);
    near(system.damping_ratio, 0.581_601_718, 1e-6);
    near(Some(system.delay), 0.107_820_128, 1e-6);
    near(found.control_anticipation_parameter, 1.130_892_342, 1e-6);
    let bandwidth = &found.bandwidths[0];
    near(bandwidth.phase, 3.439_539_454, 1e-6);
    near(bandwidth.neutral_frequency, 5.588_606_349, 1e-6);
    near(bandwidth.gain, 3.610_626_620, 1e-6);
    near(bandwidth.phase_delay, 0.092_453_280, 1e-6);

    let (plan, estimate) = light_airplane();
    let stable = of_band(&plan, &estimate, band);
    let of = |found: &FlyingQualities| {
        let (system, bandwidth) = (&found.equivalent_systems[0], &found.bandwidths[0]);
        [
            system.natural_frequency,
            system.damping_ratio,
            bandwidth.bandwidth,
            bandwidth.phase_delay,
        ]
        .map(|measure| measure.expect("a number").value)
    };
    for (unstable, stable) in of(&found).into_iter().zip(of(&stable)) {
        assert!(
            (unstable / stable - 1.0).abs() < 0.01,
            "{unstable} {stable}"
        );
    }
    assert_eq!(found.remarks, stable.remarks);
    assert!(found.remarks.is_empty(), "{:?}", found.remarks);
}

/// Lag and delay of a sensor are none of the aircraft's.
#[test]
fn a_slow_sensor_changes_no_flying_quality() {
    let band = [Some(0.5), Some(10.0)];
    let (plan, estimate) = light_airplane();
    let without = of_band(&plan, &estimate, band);
    let (plan, estimate) = light_airplane_with(-0.0451, true);
    let with = of_band(&plan, &estimate, band);
    assert_eq!(with.equivalent_systems[0].output, "q");
    for (with, without) in [
        (
            &with.equivalent_systems[0].delay,
            &without.equivalent_systems[0].delay,
        ),
        (
            &with.bandwidths[0].phase_delay.expect("one"),
            &without.bandwidths[0].phase_delay.expect("one"),
        ),
        (
            &with.control_anticipation_parameter.expect("one"),
            &without.control_anticipation_parameter.expect("one"),
        ),
    ] {
        near(Some(*with), without.value, 1e-9);
    }
}

/// An end of the band that is not said is what it is where neither is.
#[test]
fn one_end_of_the_band_alone_leaves_the_other() {
    let (plan, estimate) = light_airplane();
    let ends = |band| of_band(&plan, &estimate, band).equivalent_systems[0].band;
    let [low, high] = ends([None, None]);
    // five times the phugoid's frequency, of numpy.linalg.eigvals
    let phugoid = f64::hypot(0.021_232_47, 0.106_325_69);
    assert!((low / (5.0 * phugoid) - 1.0).abs() < 1e-6, "{low}");
    assert_eq!(high, 10.0);
    assert_eq!(ends([None, Some(8.0)]), [low, 8.0]);
    assert_eq!(ends([Some(0.7), None]), [0.7, 10.0]);
}

/// An elevator without lag or delay: the phase of the attitude never comes to −180°.
#[test]
fn a_bandwidth_that_is_not_there_is_said() {
    let elevator =
        crate::common::recordings::maneuver(include_bytes!("../../../data/elevator.csv"));
    let (plan, estimate) = estimated(json!("short-period"), json!({}), &elevator);
    let found = of_band(&plan, &estimate, [None, None]);
    assert_eq!(found.bandwidths[0].neutral_frequency, None);
    let said = |remark: &String| remark.contains("−180°") && remark.starts_with("q over de");
    assert!(found.remarks.iter().any(said), "{:?}", found.remarks);
}

/// Without a word of the flight phase there are numbers, and no levels.
#[test]
fn levels_want_category_and_class() {
    let (plan, estimate) = navion();
    let ask = |category, class| {
        let question = FlyingQualityQuestion {
            category,
            class,
            ..FlyingQualityQuestion::default()
        };
        flying_qualities(&plan.problem, &estimate, &question).expect("qualities")
    };
    assert!(ask(None, Some(AirplaneClass::I)).levels.is_empty());
    let found = ask(Some(FlightPhaseCategory::A), Some(AirplaneClass::I));
    let levels: Vec<_> = (found.levels.iter())
        .map(|c| (c.what.as_str(), c.level))
        .collect();
    let expected = [
        ("roll mode: time constant", Some(1)),
        ("Dutch roll: damping and frequency", Some(1)),
        ("spiral: time to double", Some(1)),
    ];
    assert_eq!(levels, expected);
    let forms: Vec<_> = found
        .equivalent_systems
        .iter()
        .map(|system| system.form)
        .collect();
    assert_eq!(forms, [EquivalentForm::RollRate, EquivalentForm::Sideslip]);
    // the Dutch roll in the roll rate leaves no first-order system that responds alike, as scipy finds, too
    let roll = &found.equivalent_systems[0];
    near(roll.time_constant, 0.047_474_27, 1e-4);
    assert!(
        (roll.mismatch - 42.723_823).abs() < 1e-4,
        "{}",
        roll.mismatch
    );
    assert_eq!(found.control_anticipation_parameter, None);
}
