//! Two effects in one flight, of known truth: each is named beside the other.

use std::ops::ControlFlow;

use super::declared::Declared;
use super::effect::Effect;
use super::found::{CLEARLY, Found};
use super::report::{Refusal, RefusedEffect};
use super::truth::{Noise, Truth, elevator};
use super::two_at_once::two_at_once;
use super::{Case, Step, candidates, diagnose};
use crate::estimate::Role;
use crate::model::catalog;

const STEP: f64 = 0.04;
const SECONDS: f64 = 24.0;

/// What is flown with the short period, and is not in it; 0 is nothing of the kind.
#[derive(Clone, Copy, Debug, Default)]
struct Undeclared {
    /// Of the pitching moment by the cube of the angle of attack, 1/s^2.
    cube: f64,
    /// By its square.
    square: f64,
    /// Of the vane, rad/s.
    drift: f64,
}

fn flown(undeclared: Undeclared, seed: u64) -> Case {
    let motion = |x: &[f64], u: &[f64], _: f64, _: usize| {
        let (alpha, q, de) = (x[0] - 0.05, x[1], u[0] + 0.03);
        let moment = undeclared.cube * alpha.powi(3) + undeclared.square * alpha * alpha;
        vec![
            -1.2 * alpha + 0.97 * q - 0.12 * de,
            -6.0 * alpha - 1.6 * q - 7.5 * de + moment,
        ]
    };
    let mut document = catalog::find("short-period").unwrap();
    document.parameters.get_mut("alpha_0").unwrap().fixed = false;
    let truth = Truth {
        document,
        start: vec![0.05, 0.0],
        motion: &motion,
        sensors: &|x, _, t| vec![x[0] + undeclared.drift * t, x[1]],
        inputs: &elevator,
        noise: Noise {
            colour: 0.0,
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

/// The names, sorted, and those that were accepted on the way.
fn diagnosed(case: &Case) -> (Vec<String>, Vec<String>) {
    let mut accepted = Vec::new();
    let conclusion = diagnose(case, &mut |step| {
        if let Some(Step::Accepted { name, .. }) = step {
            accepted.push(name.clone());
        }
        ControlFlow::Continue(())
    });
    let Ok(conclusion) = conclusion else {
        panic!("the case cannot be diagnosed");
    };
    let effects = conclusion.diagnosis.effects.iter();
    let mut names: Vec<String> = effects.map(|named| named.effect.name()).collect();
    names.sort();
    (names, accepted)
}

/// Square and cube together look like alpha*|alpha| as long as both are missing: it is accepted first, and goes.
#[test]
fn what_stood_for_two_gives_way_to_each() {
    let compromise = "missing_term alpha*abs(alpha) in q";
    let both = ["missing_term alpha^2 in q", "missing_term alpha^3 in q"];
    let mut gave_way = 0;
    for seed in 1..=4 {
        let undeclared = Undeclared {
            cube: 200.0,
            square: 10.0,
            ..Undeclared::default()
        };
        let (names, accepted) = diagnosed(&flown(undeclared, seed));
        println!("{seed}: {names:?} by way of {accepted:?}");
        assert_eq!(names, both, "seed {seed}");
        gave_way += usize::from(accepted.iter().any(|name| name == compromise));
    }
    assert!(
        gave_way > 0,
        "the way that this test is about was not taken"
    );
}

/// As a round refuses a candidate that other flights deny.
fn denied(effect: &Effect) -> RefusedEffect {
    RefusedEffect {
        effect: effect.clone(),
        reason: Refusal::NotRepeatable,
        sentence: String::new(),
        likelihood_ratio: Some(2.0 * CLEARLY),
        visible_fraction: None,
        smallest_seen: None,
        held_out: None,
    }
}

/// What was denied is put in for the time being: another is found beside it if there is one, and then it passes.
#[test]
fn two_that_hide_each_other_are_found_and_one_alone_is_not_two() {
    for (cube, pair) in [(300.0, true), (0.0, false)] {
        let undeclared = Undeclared {
            cube,
            drift: 2e-4,
            ..Undeclared::default()
        };
        let case = flown(undeclared, 7);
        let quiet = &mut |_: Option<&Step>| ControlFlow::Continue(());
        let Ok(declared) = Declared::of(&case, quiet) else {
            panic!("the declared model is not fitted");
        };
        let base = declared.fitted;
        let catalogue = candidates::candidates(&case, &base.problem.model);
        let drift = (catalogue.iter()).find(|effect| effect.name() == "sensor_drift of alpha");
        let refused = [denied(drift.expect("a drift of the vane"))];
        let mut found = Found::default();
        let two = two_at_once(&case, &base, &found, &refused, &catalogue, 1, quiet);
        let two = two.unwrap_or_else(|_| panic!("stopped"));
        let names = (two.as_ref()).map(|two| [&two[0], &two[1]].map(|one| one.effect.name()));
        println!("{names:?}");
        let expected = ["missing_term alpha^3 in q", "sensor_drift of alpha"].map(String::from);
        assert_eq!(names, pair.then_some(expected));
        // what was denied by itself and stands beside the other is not open any more
        found.refuse(refused.to_vec());
        assert!(found.clear_but_refused().is_some());
        for accepted in two.into_iter().flatten() {
            assert!(found.accept(accepted, 1, quiet).is_ok());
        }
        assert_eq!(found.clear_but_refused().is_none(), pair);
    }
}
