//! The unmodelled force against flights of known truth.

use std::ops::ControlFlow;

use super::left_over::{LeftOver, all};
use super::truth::{Noise, Truth, steps};
use crate::diagnose::declared::Declared;
use crate::diagnose::{Case, Fitted};
use crate::estimate::Role;
use crate::model::catalog;

/// What is flown with the short period, and is not in it.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Undeclared {
    Nothing,
    /// A pitching moment by the cube of the angle of attack.
    CubicMoment,
    /// The elevator's effect saturates, as by a hinge moment.
    Saturation,
    /// The centre of gravity wanders.
    WanderingBalance,
    /// A pitching moment for two seconds of one flight.
    Once,
    /// A force that swings by itself, as of fuel.
    Slosh,
}

/// A 3-2-1-1 and a doublet on the elevator, later and larger from flight to flight.
fn elevator(t: f64, flight: usize) -> Vec<f64> {
    let size = [0.05, -0.04, 0.065, 0.045][flight];
    let t = t - [0.0, 0.7, 0.3, 1.1][flight];
    let moves = [
        (5.5, 7.0, size),
        (7.0, 8.0, -size),
        (8.0, 8.5, size),
        (8.5, 9.0, -size),
        (13.0, 14.0, 0.7 * size),
        (14.0, 15.0, -0.7 * size),
    ];
    vec![-0.03 + steps(t, &moves)]
}

/// Flights of 20 s at 25 Hz, with noise of 0.06 deg and 0.09 deg/s or so many times as much.
fn flown(undeclared: Undeclared, noise: f64, colour: f64, roles: &[Role], seed: u64) -> Case {
    let motion = |x: &[f64], u: &[f64], t: f64, flight: usize| {
        let (alpha, q, mut de) = (x[0] - 0.05, x[1], u[0] + 0.03);
        let (mut stiffness, mut force, mut moment) = (-6.0, 0.0, 0.0);
        match undeclared {
            Undeclared::Nothing => {}
            Undeclared::CubicMoment => moment += 240.0 * alpha.powi(3),
            Undeclared::Saturation => de = de.clamp(-0.037, 0.037),
            Undeclared::WanderingBalance => {
                stiffness *= 1.0 + 0.2 * (0.4 * t + flight as f64).sin();
            }
            Undeclared::Once if flight == 0 && (9.0..11.0).contains(&t) => moment += 0.06,
            Undeclared::Once => {}
            Undeclared::Slosh => force += 0.02 * (2.5 * t).sin() * (t / 5.0).min(1.0),
        }
        vec![
            -1.2 * alpha + 0.97 * q - 0.12 * de + force,
            stiffness * alpha - 1.6 * q - 7.5 * de + moment,
        ]
    };
    let mut document = catalog::find("short-period").unwrap();
    document.parameters.get_mut("alpha_0").unwrap().fixed = false;
    let truth = Truth {
        document,
        start: vec![0.05, 0.0],
        motion: &motion,
        sensors: &|x, _, _| x.to_vec(),
        inputs: &elevator,
        noise: Noise {
            colour,
            deviations: vec![0.001 * noise, 0.0015 * noise],
        },
        seconds: 20.0,
        step: 0.04,
    };
    truth.fly(roles, seed)
}

fn fitted(case: &Case) -> Fitted {
    let Ok(declared) = Declared::of(case, &mut |_| ControlFlow::Continue(())) else {
        panic!("the declared model is not fitted");
    };
    declared.fitted
}

fn best_first(case: &Case) -> Vec<LeftOver> {
    let mut found = all(case, &fitted(case)).unwrap();
    found.sort_by(|a, b| b.likelihood_ratio.total_cmp(&a.likelihood_ratio));
    found
}

/// Noise alone leaves nothing, whatever its colour; the statistic does not grow with it.
#[test]
fn noise_of_any_colour_leaves_nothing() {
    for colour in [0.0, 0.8, 0.9, 0.96] {
        let mut ratios = Vec::new();
        for seed in 1..=6 {
            let case = flown(
                Undeclared::Nothing,
                2.0,
                colour,
                &[Role::Estimation; 2],
                seed,
            );
            let found = best_first(&case);
            assert!(
                !found[0].is_significant(),
                "colour {colour}, seed {seed}: {found:?}"
            );
            ratios.push(found[0].likelihood_ratio);
        }
        ratios.sort_by(f64::total_cmp);
        assert!(ratios[3] < 8.0, "colour {colour}: {ratios:?}");
    }
}

/// Whatever is missing, it is the equation in which it acts that a force explains best.
#[test]
fn a_force_is_found_in_the_equation_in_which_it_acts() {
    let expected = [
        (Undeclared::CubicMoment, "the equation of q"),
        (Undeclared::Saturation, "the equation of q"),
        (Undeclared::WanderingBalance, "the equation of q"),
        (Undeclared::Once, "the equation of q"),
        (Undeclared::Slosh, "the equation of alpha"),
    ];
    for (undeclared, words) in expected {
        for colour in [0.0, 0.9] {
            let case = flown(undeclared, 1.0, colour, &[Role::Estimation; 2], 11);
            let found = best_first(&case);
            assert_eq!(found[0].words, words, "{undeclared:?}, {colour}: {found:?}");
            assert!(
                found[0].is_significant(),
                "{undeclared:?}, {colour}: {found:?}"
            );
        }
    }
}
