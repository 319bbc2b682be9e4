//! The unmodelled force against flights of known truth.

use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector};

use super::left_over::{LeftOver, left_over};
use super::picture::found;
use super::report::{ForceIn, Unmodelled};
use crate::diagnose::case::Case;
use crate::diagnose::declared::Declared;
use crate::diagnose::fitted::Fitted;
use crate::diagnose::truth::{Noise, Truth, steps};
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

fn left(case: &Case) -> LeftOver {
    left_over(case, &fitted(case)).expect("a model with room for a force")
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
            let found = left(&case);
            assert!(
                !found.is_significant(),
                "colour {colour}, seed {seed}: {found:?}"
            );
            ratios.push(found.likelihood_ratio);
        }
        ratios.sort_by(f64::total_cmp);
        assert!(ratios[3] < 8.0, "colour {colour}: {ratios:?}");
    }
}

/// Whatever is missing, it is the equation in which it acts that a force explains best.
#[test]
fn a_force_is_found_in_the_equation_in_which_it_acts() {
    let expected = [
        (Undeclared::CubicMoment, "q"),
        (Undeclared::Saturation, "q"),
        (Undeclared::WanderingBalance, "q"),
        (Undeclared::Once, "q"),
        (Undeclared::Slosh, "alpha"),
    ];
    for (undeclared, equation) in expected {
        for colour in [0.0, 0.9] {
            let case = flown(undeclared, 1.0, colour, &[Role::Estimation; 2], 11);
            let found = left(&case);
            let place = (found.equation.as_str(), found.force_in);
            assert_eq!(
                place,
                (equation, ForceIn::State),
                "{undeclared:?}, {colour}: {found:?}"
            );
            assert!(
                found.is_significant(),
                "{undeclared:?}, {colour}: {found:?}"
            );
        }
    }
}

/// What is left of a series besides a constant and some others.
fn besides(series: &[f64], others: &[&[f64]]) -> DVector<f64> {
    let ones = vec![1.0; series.len()];
    let columns: Vec<DVector<f64>> = std::iter::once(ones.as_slice())
        .chain(others.iter().copied())
        .map(DVector::from_column_slice)
        .collect();
    let columns = DMatrix::from_columns(&columns);
    let series = DVector::from_column_slice(series);
    let fit = columns
        .clone()
        .svd(true, true)
        .solve(&series, 1e-12)
        .unwrap();
    series - columns * fit
}

fn correlation(a: &DVector<f64>, b: &DVector<f64>) -> f64 {
    a.dot(b) / (a.norm() * b.norm())
}

/// Quantities with their shares, the best first.
fn shares(force: &Unmodelled) -> Vec<(&str, f64)> {
    let all = force.depends_on.iter();
    all.map(|d| (d.quantity.as_str(), d.share)).collect()
}

/// A cubic moment: its course over time, what it depends on and its term are found, in flights that were not fitted too.
#[test]
fn a_cubic_moment_is_seen_for_what_it_is() {
    let roles = [Role::Estimation, Role::Estimation, Role::Validation];
    let case = flown(Undeclared::CubicMoment, 0.3, 0.0, &roles, 5);
    let picture = found(&case, &fitted(&case)).expect("something is left");
    let force = &picture.unmodelled;
    assert_eq!(
        (force.equation.as_str(), force.unit.as_str()),
        ("q", "rad/s^2")
    );
    assert_eq!(force.flights.len(), 3);
    for flight in &force.flights {
        let recorded = case
            .flights
            .iter()
            .find(|f| f.label == flight.segment)
            .unwrap();
        let every = recorded.time.len().div_ceil(flight.time.len());
        let channel = |name: &str| -> Vec<f64> {
            let (values, _) = &recorded.channels[name];
            values.iter().step_by(every).copied().collect()
        };
        let (alpha, q, de) = (channel("alpha"), channel("q"), channel("de"));
        let truth: Vec<f64> = alpha.iter().map(|a| 240.0 * (a - 0.05).powi(3)).collect();
        // the declared derivatives imitate what is linear
        let known = [alpha.as_slice(), &q, &de];
        let like = correlation(&besides(&flight.value, &known), &besides(&truth, &known));
        assert!(like > 0.9, "{}: {like}", flight.segment);
    }
    let best = &force.depends_on[0];
    assert!(
        best.quantity == "alpha" && best.share > 0.5,
        "{:?}",
        shares(force)
    );
    let curve = best.curve.as_ref().unwrap();
    let truth: Vec<f64> = curve.x.iter().map(|x| 240.0 * (x - 0.05).powi(3)).collect();
    let like = correlation(
        &besides(&curve.y, &[&curve.x]),
        &besides(&truth, &[&curve.x]),
    );
    assert!(like > 0.9, "the curve: {like}");
    let names: Vec<String> = picture.unmodelled.proposals.clone();
    assert!(
        names.iter().any(|name| name.contains("alpha^3")),
        "{names:?}"
    );
    assert!(picture.unmodelled.proposals.len() <= 8);
}

/// One flight alone: a quarter of it at a time is predicted from the rest.
#[test]
fn a_lone_flight_is_its_own_judge() {
    let case = flown(Undeclared::CubicMoment, 0.3, 0.0, &[Role::Estimation], 5);
    let picture = found(&case, &fitted(&case)).expect("something is left");
    let best = &picture.unmodelled.depends_on[0];
    assert!(
        best.quantity == "alpha" && best.share > 0.5,
        "{:?}",
        shares(&picture.unmodelled)
    );
}

/// What acts once depends on nothing, and is said when it acts.
#[test]
fn what_depends_on_nothing_is_said_when_it_acts() {
    let roles = [Role::Estimation, Role::Estimation, Role::Validation];
    let case = flown(Undeclared::Once, 0.5, 0.0, &roles, 5);
    let picture = found(&case, &fitted(&case)).expect("something is left");
    let force = &picture.unmodelled;
    assert_eq!(force.equation, "q");
    let best = force.depends_on.first().map_or(0.0, |best| best.share);
    assert!(best < 0.3, "{:?}", shares(force));
    assert_eq!(force.strongest.segment, "A");
    let (from, to) = (force.strongest.from, force.strongest.to);
    assert!(from > 8.5 && to < 11.5 && to - from < 2.0, "{from} to {to}");
    assert!(
        force.sentence.contains("depends on nothing"),
        "{}",
        force.sentence
    );
}
