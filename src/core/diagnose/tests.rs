//! Names against flights of known truth: what is in no catalogue is not given one with confidence, and turbulence is told
//! from coloured noise.

use std::ops::ControlFlow;

use super::declared::Declared;
use super::elsewhere::Elsewhere;
use super::fitted::Fitted;
use super::truth::{Chance, Noise, Truth, elevator};
use super::{Case, Diagnosis, Verdict, candidates, diagnose};
use crate::estimate::Role;
use crate::model::catalog;

const STEP: f64 = 0.04;
const SECONDS: f64 = 24.0;

/// What is flown with the short period, and is not in it.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Undeclared {
    /// A pitching moment that wanders: fuel that is pumped.
    WanderingBalance,
    /// A pitching moment that lags behind the angle of attack by an amount, not by a time (Bouc and Wen).
    Hysteresis,
    /// A load on a rope, driven by the pitch acceleration.
    Slosh,
    /// A rough air that the vane and the wing feel.
    Turbulence,
    /// The same, and a pitching moment by the cube of the angle of attack.
    TurbulenceAndCube,
    /// The moment alone: in all flights, or in those that are fitted.
    Cube(bool),
}

fn flown(undeclared: Undeclared, colour: f64, seed: u64) -> Case {
    use Undeclared::*;
    let mut chance = Chance(seed + 77);
    (0..20).for_each(|_| {
        chance.uniform();
    });
    let count = 3 * (SECONDS / STEP) as usize + 3;
    let rough: Vec<f64> = (0..count).map(|_| chance.normal()).collect();
    let gust = |t: f64, flight: usize| {
        let at = (t / STEP) as usize + flight * (SECONDS / STEP) as usize;
        rough[at.min(count - 1)]
    };
    let motion = |x: &[f64], u: &[f64], t: f64, flight: usize| {
        let (alpha, q, de) = (x[0] - 0.05, x[1], u[0] + 0.03);
        let (mut force, mut moment) = (0.0, 0.0);
        let plain = -1.2 * alpha + 0.97 * q - 0.12 * de;
        let (mut first, mut second) = (0.0, 0.0);
        match undeclared {
            WanderingBalance => {
                moment += 0.02 * ((0.37 * t + 2.0 * flight as f64).sin() + t / 20.0);
            }
            Hysteresis => {
                let (z, w) = (x[2] / 0.015, plain);
                first = w - 0.5 * (w.abs() * z.abs() * z + w * z * z);
                moment -= 4.0 * x[2];
            }
            Slosh => {
                first = x[3];
                second = -9.0 * x[2] - 0.2 * x[3] + 40.0 * alpha;
                moment += 0.1 * x[2];
            }
            Turbulence => force += 0.02 * gust(t, flight),
            TurbulenceAndCube => {
                force += 0.04 * gust(t, flight);
                moment += 300.0 * alpha.powi(3);
            }
            Cube(everywhere) if everywhere || flight < 2 => moment += 450.0 * alpha.powi(3),
            Cube(_) => {}
        }
        let acceleration = -6.0 * alpha - 1.6 * q - 7.5 * de + moment;
        vec![plain + force, acceleration, first, second]
    };
    let mut document = catalog::find("short-period").unwrap();
    document.parameters.get_mut("alpha_0").unwrap().fixed = false;
    let truth = Truth {
        document,
        start: vec![0.05, 0.0, 0.0, 0.0],
        motion: &motion,
        sensors: &|x, _, _| x[..2].to_vec(),
        inputs: &elevator,
        noise: Noise {
            colour,
            deviations: vec![0.001, 0.0015],
        },
        seconds: SECONDS,
        step: STEP,
    };
    truth.fly(
        &[Role::Estimation, Role::Estimation, Role::Validation],
        seed,
    )
}

fn diagnosed(case: &Case) -> Diagnosis {
    let Ok(conclusion) = diagnose(case, &mut |_| ControlFlow::Continue(())) else {
        panic!("the case cannot be diagnosed");
    };
    conclusion.diagnosis
}

fn names(diagnosis: &Diagnosis) -> Vec<String> {
    let effects = diagnosis.effects.iter();
    effects.map(|named| named.effect.name()).collect()
}

/// The worst answer is a wrong name. The catalogue's relatives of these (lags of the flow, biases, process noise) had been
/// named in one of three of an independent simulator's flights.
#[test]
fn what_is_in_no_catalogue_is_not_named_with_confidence() {
    use Undeclared::{Hysteresis, Slosh, WanderingBalance};
    let mut wrong = Vec::new();
    for undeclared in [WanderingBalance, Hysteresis, Slosh] {
        for seed in 1..=4 {
            let diagnosis = diagnosed(&flown(undeclared, 0.0, seed));
            let is_confident = matches!(diagnosis.verdict, Verdict::Named | Verdict::NamedGroup);
            println!(
                "{undeclared:?} {seed}: {:?} {:?} {}",
                diagnosis.verdict,
                names(&diagnosis),
                diagnosis.sentence
            );
            assert_ne!(diagnosis.verdict, Verdict::NothingMissing, "{undeclared:?}");
            if is_confident && !names(&diagnosis)[0].starts_with("process_noise") {
                wrong.push((undeclared, seed, names(&diagnosis)));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// Errors of measuring of lag-1 correlation 0.8: a filter that believes them white puts them into the air.
#[test]
fn turbulence_is_told_from_coloured_noise() {
    let case = flown(Undeclared::Turbulence, 0.8, 3);
    let diagnosis = diagnosed(&case);
    println!("{:?} {}", names(&diagnosis), diagnosis.sentence);
    assert_eq!(names(&diagnosis), ["process_noise of alpha"]);
}

/// A pair with turbulence: the filter that knows of it is asked for what else there is.
#[test]
fn what_is_there_beside_turbulence_is_named_too() {
    let diagnosis = diagnosed(&flown(Undeclared::TurbulenceAndCube, 0.0, 5));
    println!("{:?} {}", names(&diagnosis), diagnosis.sentence);
    let expected = ["process_noise of alpha", "missing_term alpha^3 in q"];
    assert_eq!(names(&diagnosis), expected);
}

/// Flights that were not fitted are fitted too, where noise is coloured and plain errors say little: an effect that is in
/// all flights is found there with the same size, one that is not is not.
#[test]
fn a_flight_shows_an_effect_by_itself_or_it_does_not() {
    for everywhere in [true, false] {
        let case = flown(Undeclared::Cube(everywhere), 0.9, 2);
        let Ok(declared) = Declared::of(&case, &mut |_| ControlFlow::Continue(())) else {
            panic!("the declared model is not fitted");
        };
        let base = declared.fitted;
        let catalogue = candidates::candidates(&case, &base.problem.model);
        let effect = (catalogue.iter())
            .find(|effect| effect.name() == "missing_term alpha^3 in q")
            .expect("a term about the trimmed flight");
        let edited = effect.apply(&base.document).unwrap();
        let settled = Fitted::settled(&case, edited.document, &base.values()).unwrap();
        let elsewhere = Elsewhere::of(&case, &base).expect("a flight that was not fitted");
        let worth = elsewhere.shows(&settled, &edited.added, 1);
        assert_eq!(worth.is_some(), everywhere, "{worth:?}");
    }
}
