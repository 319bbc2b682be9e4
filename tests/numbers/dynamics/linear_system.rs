//! A, B, C, D, poles and zeros.

use serde_json::json;
use trimtab_core::dynamics::{LinearSystem, NoLinearSystem, Root, linear_system};
use trimtab_core::estimate::{Estimate, ModeName};
use trimtab_core::job::Plan;
use trimtab_core::model::{Model, Program};
use trimtab_core::simulate::initial_state;

use super::{estimated, navion};
use crate::common::estimation::{fly, scenario};
use crate::common::recordings::maneuver;

fn system(plan: &Plan, estimate: &Estimate) -> LinearSystem {
    linear_system(&plan.problem, estimate, None).expect("a linear system")
}

/// Poles and zeros, each with what is expected of it, fastest first.
fn near(found: &[Root], expected: &[(f64, f64)], within: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (root, &(real, imaginary)) in found.iter().zip(expected) {
        let off = (root.real.value - real).hypot(root.imaginary.value - imaginary);
        assert!(
            off < within * (1.0 + real.hypot(imaginary)),
            "{root} for {real}, {imaginary}"
        );
    }
}

/// Zeros and gains by scipy.signal.ss2zpk and control.zeros, of the matrices written out.
#[test]
fn poles_zeros_and_gains_are_those_of_python_control() {
    let (plan, estimate) = navion();
    let system = system(&plan, &estimate);
    assert!(system.is_everywhere);
    let of = |input: &str, output: &str| {
        let mut all = system.transfer_functions.iter();
        all.find(|function| function.input == input && function.output == output)
            .expect("a transfer function")
    };
    let poles = [
        (-8.432_947_462_676, 0.0),
        (-0.486_051_177_977, 2.333_887_155_501),
        (-0.008_950_181_37, 0.0),
    ];
    type Expected<'a> = (&'a str, &'a str, f64, Option<f64>, &'a [(f64, f64)]);
    let zeros: [Expected<'_>; 7] = [
        (
            "da",
            "beta",
            0.2218,
            Some(9.180_601_581_944),
            &[(-77.797_030_182_193, 0.0), (-0.228_221_461_373, 0.0)],
        ),
        (
            "da",
            "p",
            28.984,
            None,
            &[(-0.498_620_514_767, 2.074_986_213_669), (0.0, 0.0)],
        ),
        (
            "da",
            "r",
            -0.2218,
            Some(53.922_026_183_9),
            &[
                (-54.100_902_507_314, 0.0),
                (-1.540_808_758_553, 0.0),
                (1.251_011_536_381, 0.0),
            ],
        ),
        (
            "da",
            "phi",
            28.984,
            Some(307.722_735_114_3),
            &[(-0.498_620_514_767, 2.074_986_213_669)],
        ),
        (
            "dr",
            "beta",
            0.0708,
            Some(-3.465_169_104_36),
            &[
                (-65.333_474_106_09, 0.0),
                (-8.792_451_727_899, 0.0),
                (0.036_547_302_915_31, 0.0),
            ],
        ),
        (
            "dr",
            "p",
            2.548,
            None,
            &[
                (6.996_810_092_398, 0.0),
                (-3.614_559_699_933, 0.0),
                (0.0, 0.0),
            ],
        ),
        (
            "dr",
            "ay",
            3.798_051_84,
            Some(51.013_680_946_68),
            &[
                (-8.333_202_581_04, 0.0),
                (-3.890_758_606_38, 0.0),
                (3.004_822_646_511, 0.0),
                (0.059_138_540_909, 0.0),
            ],
        ),
    ];
    for (input, output, gain, static_gain, zeros) in zeros {
        let function = of(input, output);
        assert!(
            (function.gain.value / gain - 1.0).abs() < 1e-10,
            "{input} {output}"
        );
        near(&function.zeros, zeros, 1e-9);
        near(&function.poles, &poles, 1e-9);
        let found = function.static_gain.expect("no integrator").value;
        let expected = static_gain.unwrap_or(0.0);
        assert!(
            (found - expected).abs() < 1e-7 * (1.0 + expected.abs()),
            "{input} {output}: {found}"
        );
        // polynomials are these roots multiplied out
        assert_eq!(function.denominator.len(), 5);
        let last = function.numerator.last().expect("one") / function.denominator[4];
        assert!((last - expected).abs() < 1e-6 * (1.0 + expected.abs()));
    }
    // delays of both signals
    assert_eq!(of("dr", "beta").delay.value, 0.05 + 0.12);
    assert_eq!(system.inputs[1].lag.expect("a lag").value, 0.08);
    let names: Vec<_> = system.modes.iter().map(|mode| mode.name).collect();
    let expected = [ModeName::Roll, ModeName::DutchRoll, ModeName::Spiral];
    assert_eq!(names, expected.map(Some));
}

/// All results of a program at a state and inputs, at time zero.
fn results(program: &Program, state: &[f64], inputs: &[f64], parameters: &[f64]) -> Vec<f64> {
    let mut workspace = program.workspace::<f64>();
    program.set_parameters(&mut workspace, parameters);
    program.states(&mut workspace).copy_from_slice(state);
    program.inputs(&mut workspace)[..inputs.len()].copy_from_slice(inputs);
    *program.time(&mut workspace) = 0.0;
    program.run(&mut workspace);
    let mut to = vec![0.0; program.len()];
    program.results(&workspace, &mut to);
    to
}

/// Six degrees of freedom against central differences of the equations themselves.
#[test]
fn a_nonlinear_model_is_linearised_as_differences_say() {
    let maneuver = fly(&scenario("six-degrees-of-freedom"));
    let (plan, estimate) = estimated(json!("six-degrees-of-freedom"), json!({}), &maneuver);
    let system = system(&plan, &estimate);
    assert!(!system.is_everywhere);
    let model = Model::compile(&plan.problem.model.document).expect("a model");
    let by_rows: Vec<f64> = (estimate.parameters.iter().zip(&plan.problem.unknowns.all))
        .map(|(row, unknown)| model.parameters[unknown.parameter].unit.to_si(row.estimate))
        .collect();
    let unknowns = plan.problem.unknowns.with_starts(&by_rows);
    let mut parameters = Vec::new();
    unknowns.parameters(0, &unknowns.start(), &mut parameters);
    let state = initial_state(&model, &parameters);
    let first: Vec<f64> = plan.problem.segments[0]
        .inputs
        .iter()
        .map(|u| u[0])
        .collect();
    let (n, m) = (state.len(), first.len());
    for column in 0..n + m {
        let at = |sign: f64| {
            let (mut state, mut inputs) = (state.clone(), first.clone());
            let value = if column < n {
                &mut state[column]
            } else {
                &mut inputs[column - n]
            };
            let step = 1e-5 * (1.0 + value.abs());
            *value += sign * step;
            let mut all = results(&model.dynamics, &state, &inputs, &parameters);
            all.extend(results(&model.observation, &state, &inputs, &parameters));
            (all, step)
        };
        let ((above, step), (below, _)) = (at(1.0), at(-1.0));
        for (row, (above, below)) in above.iter().zip(&below).enumerate() {
            let difference = (above - below) / (2.0 * step);
            let matrix = match (row < n, column < n) {
                (true, true) => &system.a,
                (true, false) => &system.b,
                (false, true) => &system.c,
                (false, false) => &system.d,
            };
            let (i, j) = (
                if row < n { row } else { row - n },
                if column < n { column } else { column - n },
            );
            let found = matrix.values[i][j];
            assert!(
                (found - difference).abs() < 1e-5 * (1.0 + found.abs()),
                "{row} {column}: {found} {difference}"
            );
        }
    }
    let names: Vec<_> = system
        .modes
        .iter()
        .map(|mode| mode.name.expect("a name"))
        .collect();
    assert_eq!(
        names[..4],
        [
            ModeName::Roll,
            ModeName::ShortPeriod,
            ModeName::DutchRoll,
            ModeName::Phugoid
        ]
    );
    assert_eq!(names[4], ModeName::Spiral);
}

/// An entry that is a parameter has the parameter's standard error, one that nothing estimated is behind has none to speak of.
#[test]
fn entries_have_the_errors_of_what_is_behind_them() {
    let elevator = maneuver(include_bytes!("../../../data/elevator.csv"));
    let (plan, estimate) = estimated(json!("short-period"), json!({}), &elevator);
    let system = system(&plan, &estimate);
    let error = |name: &str| {
        let row = estimate.parameters.iter().find(|row| row.name == name);
        row.expect("it").standard_error.expect("a bound")
    };
    let expected = [[error("Za"), error("Zq")], [error("Ma"), error("Mq")]];
    for (found, expected) in system.a.standard_errors.iter().zip(expected) {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found.expect("known") / expected - 1.0).abs() < 1e-12);
        }
    }
    assert_eq!(system.c.values, [[1.0, 0.0], [0.0, 1.0]]);
    assert_eq!(system.c.standard_errors, [[Some(0.0); 2]; 2]);
    let zero = &system.transfer_functions[1].zeros[0];
    // q: -Za + Ma Zde/Mde, in closed form with its slopes
    let value = |name: &str| {
        let row = estimate.parameters.iter().find(|row| row.name == name);
        row.expect("it").estimate
    };
    let [za, ma, zde, mde] = ["Za", "Ma", "Zde", "Mde"].map(value);
    assert!((zero.real.value - (za - ma * zde / mde)).abs() < 1e-12);
    let slopes = [
        ("Za", 1.0),
        ("Ma", -zde / mde),
        ("Zde", -ma / mde),
        ("Mde", ma * zde / (mde * mde)),
    ];
    let free: Vec<_> = estimate
        .parameters
        .iter()
        .filter(|row| !row.fixed)
        .collect();
    let place = |name: &str| free.iter().position(|row| row.name == name).expect("free");
    let mut variance = 0.0;
    for (a, by_a) in slopes {
        for (b, by_b) in slopes {
            let correlation = estimate.correlation[place(a)][place(b)];
            variance += by_a * by_b * correlation * error(a) * error(b);
        }
    }
    let found = zero.real.standard_error.expect("a bound");
    assert!(
        (found / variance.sqrt() - 1.0).abs() < 1e-9,
        "{found} {}",
        variance.sqrt()
    );
}

#[test]
fn a_segment_that_is_not_there_is_named() {
    let (plan, estimate) = navion();
    let refused = linear_system(&plan.problem, &estimate, Some("flight 9")).unwrap_err();
    assert!(matches!(
        refused,
        NoLinearSystem::Unknown {
            what: "segment",
            ..
        }
    ));
    assert_eq!(
        refused.to_string(),
        "segment: there is no 'flight 9'; there is 1"
    );
}
