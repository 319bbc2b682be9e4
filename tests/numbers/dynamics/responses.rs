//! Magnitude and phase, delays exact.

use num_complex::Complex64;
use serde_json::json;
use trimtab_core::dynamics::{
    FrequencyQuestion, FrequencyResponse, FrequencyUnit, NoLinearSystem, frequency_responses,
};
use trimtab_core::estimate::Estimate;
use trimtab_core::job::Plan;

use super::{estimated, navion};
use crate::common::recordings::maneuver;

fn one(plan: &Plan, estimate: &Estimate, input: &str, output: &str, omega: f64) -> [f64; 2] {
    let question = FrequencyQuestion {
        input: Some(input.to_string()),
        output: Some(output.to_string()),
        from: Some(omega),
        to: Some(omega),
        points: Some(1),
        ..FrequencyQuestion::default()
    };
    let responses = frequency_responses(&plan.problem, estimate, &question).expect("a response");
    [responses[0].magnitude_db[0], responses[0].phase_deg[0]]
}

/// python-control's response times exp(-j ω τ)/(1 + j ω T).
#[test]
fn responses_are_those_of_python_control() {
    let (plan, estimate) = navion();
    let omegas = [0.1, 2.3, 20.0];
    let expected = [
        (
            "da",
            "p",
            [8.761_586_461_145, 10.926_753_734_813, 2.537_224_033_135],
            [4.710_576_568_152, 12.729_601_156_581, -67.176_386_539_487],
        ),
        (
            "dr",
            "beta",
            [-0.902_441_527_794, 6.382_519_387_182, -43.692_816_927_947],
            [22.836_325_909_8, -110.299_244_316_46, -53.695_497_530_795],
        ),
        (
            "dr",
            "ay",
            [19.042_231_425_68, 28.893_553_181_749, 6.433_327_528_937],
            [
                -146.438_261_104_208,
                77.988_502_907_783,
                -114.493_994_597_06,
            ],
        ),
    ];
    for (input, output, magnitudes, phases) in expected {
        for ((omega, magnitude), phase) in omegas.into_iter().zip(magnitudes).zip(phases) {
            let [found, turned] = one(&plan, &estimate, input, output, omega);
            assert!(
                (found - magnitude).abs() < 1e-8,
                "{input} {output} at {omega}: {found} dB"
            );
            let off = (turned - phase) / 360.0;
            assert!(
                (off - off.round()).abs() < 1e-10,
                "{input} {output} at {omega}: {turned} deg"
            );
        }
    }
}

/// A phase does not jump, however far apart frequencies are, and hertz are turns a second.
#[test]
fn phases_are_continuous_and_hertz_are_turns() {
    let (plan, estimate) = navion();
    let question = |points: usize, unit: FrequencyUnit, scale: f64| FrequencyQuestion {
        input: Some("dr".to_string()),
        output: Some("beta".to_string()),
        from: Some(0.01 / scale),
        to: Some(200.0 / scale),
        points: Some(points),
        unit,
        ..FrequencyQuestion::default()
    };
    let ask = |question: FrequencyQuestion| -> FrequencyResponse {
        let all = frequency_responses(&plan.problem, &estimate, &question);
        all.expect("a response").remove(0)
    };
    let fine = ask(question(4000, FrequencyUnit::RadiansPerSecond, 1.0));
    for pair in fine.phase_deg.windows(2) {
        assert!((pair[1] - pair[0]).abs() < 20.0, "{pair:?}");
    }
    // 0.17 s of delay turn by some 1950 degrees
    assert!(fine.phase_deg[3999] < -1900.0);
    let coarse = ask(question(2, FrequencyUnit::RadiansPerSecond, 1.0));
    assert!((coarse.phase_deg[1] - fine.phase_deg[3999]).abs() < 1e-9);
    let hertz = ask(question(4000, FrequencyUnit::Hertz, std::f64::consts::TAU));
    assert_eq!(hertz.frequency_unit, FrequencyUnit::Hertz);
    for k in [0, 1234, 3999] {
        let back = hertz.frequency[k] * std::f64::consts::TAU;
        assert!((back / fine.frequency[k] - 1.0).abs() < 1e-12);
        assert!((hertz.magnitude_db[k] - fine.magnitude_db[k]).abs() < 1e-9);
    }
}

/// H of the short period with a vane that is late, in closed form, with central differences for its slopes.
#[test]
fn standard_errors_are_those_of_the_closed_form() {
    let elevator = maneuver(include_bytes!("../../../data/elevator.csv"));
    let edits = json!({"edits": [{"kind": "sensor_delay", "target": "alpha"}]});
    let (plan, estimate) = estimated(json!("short-period"), edits, &elevator);
    let free: Vec<_> = estimate
        .parameters
        .iter()
        .filter(|row| !row.fixed)
        .collect();
    let place = |name: &str| free.iter().position(|row| row.name == name);
    let delay = free
        .iter()
        .position(|row| row.unit == "s")
        .expect("the delay");
    let theta: Vec<f64> = free.iter().map(|row| row.estimate).collect();
    let errors: Vec<f64> = free
        .iter()
        .map(|row| row.standard_error.expect("a bound"))
        .collect();
    for omega in [0.3, 2.0, 9.0] {
        let of_alpha = |theta: &[f64]| {
            let at = |name: &str| theta[place(name).expect("free")];
            let s = Complex64::new(0.0, omega);
            let [za, zq, zde, ma, mq, mde] = ["Za", "Zq", "Zde", "Ma", "Mq", "Mde"].map(at);
            let determinant = (s - za) * (s - mq) - zq * ma;
            let alpha = ((s - mq) * zde + zq * mde) / determinant;
            (alpha * (-s * theta[delay]).exp()).ln()
        };
        let slopes: Vec<Complex64> = (0..theta.len())
            .map(|i| {
                let step = 1e-6 * (1.0 + theta[i].abs());
                let at = |sign: f64| {
                    let mut moved = theta.clone();
                    moved[i] += sign * step;
                    of_alpha(&moved)
                };
                (at(1.0) - at(-1.0)) / (2.0 * step)
            })
            .collect();
        let deviation = |of: fn(&Complex64) -> f64| {
            let mut variance = 0.0;
            for (i, a) in slopes.iter().enumerate() {
                for (j, b) in slopes.iter().enumerate() {
                    variance += of(a) * of(b) * errors[i] * errors[j] * estimate.correlation[i][j];
                }
            }
            variance.sqrt()
        };
        let question = FrequencyQuestion {
            output: Some("alpha".to_string()),
            from: Some(omega),
            to: Some(omega),
            points: Some(1),
            ..FrequencyQuestion::default()
        };
        let all = frequency_responses(&plan.problem, &estimate, &question).expect("a response");
        let magnitude = 20.0 / std::f64::consts::LN_10 * of_alpha(&theta).re;
        assert!((all[0].magnitude_db[0] - magnitude).abs() < 1e-9);
        let expected = 20.0 / std::f64::consts::LN_10 * deviation(|z| z.re);
        let found = all[0].magnitude_db_standard_error[0];
        assert!(
            (found / expected - 1.0).abs() < 1e-5,
            "{omega}: {found} dB for {expected}"
        );
        let expected = deviation(|z| z.im).to_degrees();
        let found = all[0].phase_deg_standard_error[0];
        assert!(
            (found / expected - 1.0).abs() < 1e-5,
            "{omega}: {found} deg for {expected}"
        );
    }
}

#[test]
fn what_cannot_be_asked_for_says_why() {
    let (plan, estimate) = navion();
    let ask = |question: FrequencyQuestion| {
        frequency_responses(&plan.problem, &estimate, &question)
            .unwrap_err()
            .to_string()
    };
    let question = FrequencyQuestion::default;
    let unknown = ask(FrequencyQuestion {
        output: Some("q".to_string()),
        ..question()
    });
    assert_eq!(
        unknown,
        "output: there is no 'q'; there is beta, p, r, phi, ay"
    );
    let below = ask(FrequencyQuestion {
        from: Some(0.0),
        ..question()
    });
    assert!(below.contains("above 0"), "{below}");
    let not_a_number = ask(FrequencyQuestion {
        from: Some(f64::NAN),
        ..question()
    });
    assert!(not_a_number.contains("above 0"), "{not_a_number}");
    let turned = ask(FrequencyQuestion {
        from: Some(5.0),
        to: Some(2.0),
        ..question()
    });
    assert!(turned.contains("5 is above 2"), "{turned}");
    let many = FrequencyQuestion {
        points: Some(1_000_000),
        ..question()
    };
    let refused = frequency_responses(&plan.problem, &estimate, &many).unwrap_err();
    assert!(
        matches!(refused, NoLinearSystem::Frequencies(_)),
        "{refused}"
    );
}
