//! Many flights: 40 simulated ones over angle of attack and Mach number, two of them spoiled, six with other flaps.

use std::sync::Arc;

use indexmap::IndexMap;
use serde_json::json;
use trimtab_core::estimate::Outcome;
use trimtab_core::job::{CampaignQuestion, Flown, UsedRecording, campaign, conditions_of};
use trimtab_core::simulate::Scenario;

use crate::common::estimation::{compiled, solve};

const SPOILED: [usize; 2] = [11, 26];

/// Static stability over the conditions, 1/s².
fn truth(alpha: f64, mach: f64, flaps: bool) -> f64 {
    let change = if flaps { -0.8 } else { 0.0 };
    -3.4 - 0.12 * alpha - 1.5 * (mach - 0.4) + 0.02 * alpha * alpha + change
}

fn place(k: usize) -> (f64, f64, bool) {
    (
        f64::from(k as u32 % 8) - 2.0,
        0.3 + 0.05 * f64::from(k as u32 / 8),
        (34..).contains(&k),
    )
}

/// The first flights of the campaign, of 40 at most.
fn flown(count: usize) -> Vec<Flown> {
    let mut scenario: Scenario =
        toml::from_str(include_str!("../../data/elevator.toml")).expect("a scenario");
    scenario.duration = 16.0;
    let model = compiled("short-period");
    let fly = |k: usize| {
        let (alpha, mach, flaps) = place(k);
        let mut scenario = Scenario {
            seed: 500 + k as u64,
            ..scenario.clone()
        };
        let spoiled = if SPOILED.contains(&k) { 0.35 } else { 0.0 };
        scenario.truth["Ma"] = truth(alpha, mach, flaps) + spoiled;
        let maneuver = Arc::new(scenario.fly(&model).expect("a maneuver"));
        let spec = json!({"parameters": {"alpha_0": {"start": scenario.truth["alpha_0"]}}});
        let tags = [
            format!("alpha={alpha}"),
            format!("mach={mach}"),
            format!("flaps={}", if flaps { 14 } else { 0 }),
            "campaign 7".to_string(),
        ];
        Flown {
            job: format!("job {k}"),
            name: format!("flight {k}"),
            conditions: conditions_of(&tags),
            recordings: vec![UsedRecording {
                id: maneuver.digest(),
                rows: None,
                seconds: None,
            }],
            estimate: solve("short-period", &maneuver, &spec).estimate,
        }
    };
    (0..count).map(fly).collect()
}

#[test]
fn the_curve_is_within_its_bands_and_the_outliers_are_named() {
    let all = flown(40);
    let question = CampaignQuestion {
        by: vec!["alpha".to_string(), "mach".to_string()],
        group: vec!["flaps".to_string()],
        parameters: vec!["Ma".to_string(), "Mq".to_string()],
        degree: None,
    };
    assert_eq!(question.fault(), None);
    let found = campaign(&all, &question);
    assert_eq!(found.left_out, []);
    let of = |parameter: &str, flaps: &str| {
        let mut curves = found.curves.iter();
        curves
            .find(|curve| curve.parameter == parameter && curve.group["flaps"] == flaps)
            .expect("a curve")
    };
    let clean = of("Ma", "0");
    let outliers: Vec<&str> = clean
        .points
        .iter()
        .filter(|point| point.is_outlier)
        .map(|point| point.job.as_str())
        .collect();
    assert_eq!(outliers, ["job 11", "job 26"]);
    let mut outside = 0;
    for point in &clean.points {
        let truth = truth(point.conditions["alpha"], point.conditions["mach"], false);
        outside += usize::from((point.curve - truth).abs() > 2.0 * point.curve_standard_error);
    }
    // errors of a curve are alike along it: few of 34, or it is off altogether
    assert!(outside <= 6, "{outside} of {}", clean.points.len());
    assert!(clean.probability.expect("freedom") > 0.001, "{clean:#?}");
    let curvature = clean
        .terms
        .iter()
        .find(|term| term.term == "alpha^2")
        .expect("a term");
    assert!(
        (curvature.value - 0.02).abs() < 3.0 * curvature.standard_error,
        "{curvature:?}"
    );
    // the other flaps are curves of their own, the other parameter one that nothing spoils
    for curve in [of("Ma", "14"), of("Mq", "0"), of("Mq", "14")] {
        assert!(
            curve.points.iter().all(|point| !point.is_outlier),
            "{curve:#?}"
        );
    }
}

/// Jobs that do not say where they were flown, or did not converge, are named and do not count.
#[test]
fn what_cannot_be_used_says_why() {
    let mut all = flown(5);
    all[3].estimate.outcome = Outcome::Budget;
    all[1].conditions = IndexMap::new();
    all[2].conditions["alpha"] = "five".to_string();
    let question = CampaignQuestion {
        by: vec!["alpha".to_string()],
        parameters: vec!["Ma".to_string()],
        ..CampaignQuestion::default()
    };
    let found = campaign(&all, &question);
    let reasons: Vec<&str> = found
        .left_out
        .iter()
        .map(|job| job.reason.as_str())
        .collect();
    assert_eq!(
        reasons,
        [
            "it has no tag alpha=...",
            "its tag alpha=five is no number",
            &format!("its fit has not converged: {}", all[3].estimate.reason)
        ]
    );
    assert_eq!(found.curves[0].points.len(), 2);
    // two points carry no parabola: a mean, with its degree of freedom
    assert_eq!(
        (
            found.curves[0].terms.len(),
            found.curves[0].degrees_of_freedom
        ),
        (1, 1)
    );
}

/// A job that was run again on the same recording is one observation: of degree 0, n flights leave n − 1 degrees of freedom.
#[test]
fn a_rerun_does_not_count_twice() {
    let again = |has_converged: bool| {
        let mut all = flown(5);
        let mut again = flown(2).remove(1);
        again.job = "again".to_string();
        if !has_converged {
            again.estimate.outcome = Outcome::Budget;
        }
        all.push(again);
        let question = CampaignQuestion {
            parameters: vec!["Ma".to_string()],
            ..CampaignQuestion::default()
        };
        campaign(&all, &question)
    };
    let found = again(true);
    assert_eq!(found.curves[0].degrees_of_freedom, 4);
    let [left_out] = &found.left_out[..] else {
        panic!("one is left out: {:?}", found.left_out);
    };
    assert_eq!(left_out.job, "job 1");
    assert!(
        left_out.reason.starts_with("job again is newer"),
        "{left_out:?}"
    );
    let found = again(false);
    assert_eq!(found.curves[0].degrees_of_freedom, 4);
    assert_eq!(found.left_out[0].job, "again");
}

#[test]
fn what_a_campaign_cannot_be_asked_says_why() {
    let names = |all: &[&str]| all.iter().map(ToString::to_string).collect::<Vec<_>>();
    let fault = |by: &[&str], group: &[&str], degree| {
        let question = CampaignQuestion {
            by: names(by),
            group: names(group),
            parameters: Vec::new(),
            degree,
        };
        question.fault()
    };
    let many = ["a", "b", "c", "d", "e", "f", "g", "h", "i"];
    assert_eq!(fault(&many[..4], &many[..8], Some(3)), None);
    for (found, field, said) in [
        (fault(&many[..5], &[], None), "by", "at most 4"),
        (fault(&[], &many, None), "group", "at most 8"),
        (
            fault(&["a", "b", "a"], &[], None),
            "by",
            "'a' is there twice",
        ),
        (fault(&[], &["b", "b"], None), "group", "'b' is there twice"),
        (
            fault(&["mean(V)"], &["flaps", "mean(alpha)"], None),
            "group",
            "'mean(alpha)': a mean is a number: name it under \"by\"",
        ),
        (fault(&[], &[], Some(4)), "degree", "between 0 and 3"),
    ] {
        let (place, message) = found.expect("a fault");
        assert_eq!(place, field);
        assert!(message.contains(said), "{message}");
    }
}
