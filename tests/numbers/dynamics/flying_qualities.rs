//! Equivalent systems, control anticipation, bandwidth, levels.

use trimtab_core::dynamics::{
    AirplaneClass, EquivalentForm, FlightPhaseCategory, FlyingQualityQuestion, flying_qualities,
};
use trimtab_core::estimate::{Measure, ModeName};

use super::{light_airplane, navion};

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
        band: Some([0.5, 10.0]),
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
