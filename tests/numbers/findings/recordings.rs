//! What recordings show: gaps, held channels, repetitions, clocks, units.

use std::sync::Arc;

use super::{SAMPLES, TRUTH, codes, fit, furthest, maneuver, rows, short_period};
use crate::common::plans::{parameter, plan, solve, try_plan};
use serde_json::{Value, json};
use trimtab_core::flight::{Finding, Maneuver, Severity};
use trimtab_core::job::Plan;

fn warnings(plan: &Plan) -> Vec<&str> {
    let findings = plan.prepared.findings.iter();
    let warnings = findings.filter(|finding| finding.severity > Severity::Note);
    warnings.map(|finding| finding.code.as_str()).collect()
}

#[test]
fn a_clean_flight_raises_nothing() {
    let result = fit(json!({}), &short_period(1.0));
    assert!(furthest(&result) < 3.5, "{}", furthest(&result));
    let warnings = result
        .estimate
        .findings
        .iter()
        .filter(|finding| finding.is_warning());
    assert_eq!(warnings.count(), 0, "{:?}", result.estimate.findings);
}

/// Six of 701 samples are lost in mid-motion. The right value is what the same data give with these rows written as empty
/// cells and the elevator filled in: another path through the code, and the truth beside it.
#[test]
fn a_short_gap_is_integrated_through() {
    let lost = 346..352;
    let dropout = rows(|k| !lost.contains(&k));
    let through = fit(json!({}), &dropout);
    assert!(furthest(&through) < 3.5, "{}", furthest(&through));
    let gap = &through.estimate.findings[0];
    assert_eq!((gap.code.as_str(), gap.severity), ("gap", Severity::Note));
    let mut filled = short_period(1.0);
    for series in &mut filled[1..] {
        series[lost.clone()].fill(f64::NAN);
    }
    let filled = fit(json!({"channels": {"de": "interpolated(de)"}}), &filled);
    for (name, _) in TRUTH {
        let (ours, theirs) = (parameter(&through, name), parameter(&filled, name));
        let error = theirs.standard_error.unwrap();
        assert!(
            (ours.estimate - theirs.estimate).abs() < 1e-4 * error,
            "{name}"
        );
        assert!(
            (ours.standard_error.unwrap() / error - 1.0).abs() < 1e-4,
            "{name}"
        );
    }
    assert!(
        through
            .estimate
            .outputs
            .iter()
            .all(|output| output.r_squared > 0.97)
    );
}

/// Behind a long gap the model is not at its trimmed flight any more: the part's initial state is estimated.
#[test]
fn a_part_that_begins_in_mid_motion_has_an_initial_state_of_its_own() {
    let dropout = rows(|k| !(330..380).contains(&k));
    let spec = |gaps: &str| json!({"maneuvers": [{"id": "a", "gaps": gaps}]});
    let split = fit(spec("split"), &dropout);
    assert!(furthest(&split) < 3.5, "{}", furthest(&split));
    let rows = split
        .estimate
        .parameters
        .iter()
        .filter(|row| row.name.ends_with("_start"));
    let rows: Vec<(Option<&str>, bool)> = rows
        .map(|row| (row.segment.as_deref(), row.fixed))
        .collect();
    let (first, second) = (Some("1.1"), Some("1.2"));
    assert_eq!(
        rows,
        [
            (first, true),
            (second, false),
            (first, true),
            (second, false)
        ]
    );
    assert!(codes(&split.estimate.findings).contains(&"held_initial_state"));
    // held where trimmed flight has it, the same data lead astray
    let held: Value = ["alpha_start", "q_start"]
        .into_iter()
        .map(|name| (name.to_string(), json!({"fixed": true})))
        .collect();
    let mut edits = spec("split");
    edits["edits"] = json!([{"kind": "initial_state", "target": "alpha"}, {"kind": "initial_state", "target": "q"}]);
    edits["parameters"] = held;
    let astray = solve(json!("short-period"), edits, &[maneuver(&dropout)]);
    assert!(
        astray.estimate.outputs[1].r_squared < 0.9,
        "{:?}",
        astray.estimate.outputs
    );
}

/// A part that begins at rest keeps the model's initial state.
#[test]
fn a_part_that_begins_at_rest_is_held() {
    let two = short_period(1.0);
    let mut series = short_period(2.0);
    for (all, more) in series.iter_mut().zip(&two) {
        all.extend(more);
    }
    for t in &mut series[0][SAMPLES..] {
        *t += 100.0;
    }
    let result = fit(json!({}), &series);
    assert!(furthest(&result) < 3.5, "{}", furthest(&result));
    assert_eq!(result.histories.len(), 2);
    assert!(!codes(&result.estimate.findings).contains(&"held_initial_state"));
}

#[test]
fn a_held_channel_is_named_with_its_rate_and_the_remedy() {
    let mut series = short_period(1.0);
    for k in 0..SAMPLES {
        series[2][k] = series[2][k / 5 * 5];
    }
    let plan = plan(json!("short-period"), json!({}), &[maneuver(&series)]);
    let [held] = &plan.prepared.findings[..] else {
        panic!("{:#?}", plan.prepared.findings);
    };
    assert_eq!(
        (held.code.as_str(), held.channel.as_deref()),
        ("held_channel", Some("alpha"))
    );
    assert!(
        held.message
            .contains("every 5th row only (10.0000 Hz in a recording of 50.0000 Hz)"),
        "{}",
        held.message
    );
    assert!(held.remedy.contains("fresh(alpha)"), "{}", held.remedy);
    assert_eq!(held.recording.as_deref(), Some("1"));
    // and a job that does not put up with it is refused
    for strict in [json!(true), json!(["held_channel"])] {
        let refused = try_plan(
            json!("short-period"),
            json!({"strict": strict}),
            &[maneuver(&series)],
        );
        let faults = refused.err().expect("a fault");
        assert_eq!((faults.len(), &*faults[0].code), (1, "held_channel"));
    }
    assert!(
        try_plan(
            json!("short-period"),
            json!({"strict": ["spikes"]}),
            &[maneuver(&series)]
        )
        .is_ok()
    );
}

/// Two of the same: bounds come out smaller by the root of two, which is said.
#[test]
fn the_same_samples_twice_are_told() {
    let both = [maneuver(&short_period(1.0)), maneuver(&short_period(1.0))];
    let plan = |changes: Value, maneuvers: &[Arc<Maneuver>]| {
        plan(json!("short-period"), changes, maneuvers)
    };
    assert_eq!(warnings(&plan(json!({}), &both)), ["repeated_maneuver"]);
    // another recording of it: its clock began elsewhere, and it is a little longer
    let mut later = short_period(1.0);
    later[0].iter_mut().for_each(|t| *t += 1000.0);
    let other = [both[0].clone(), maneuver(&later)];
    assert_eq!(warnings(&plan(json!({}), &other)), ["repeated_maneuver"]);
    let overlap = json!({"maneuvers": [
        {"id": "a", "rows": [1, 500], "label": "a"}, {"id": "a", "rows": [400, 701], "label": "b"}]});
    let overlapping = plan(overlap, &both);
    let overlapping: Vec<&Finding> = overlapping
        .prepared
        .findings
        .iter()
        .filter(|f| f.is_warning())
        .collect();
    assert_eq!(overlapping[0].code, "overlapping_rows");
    assert_eq!(
        (overlapping[0].count, overlapping[0].pointer.as_deref()),
        (101, Some("/maneuvers/1"))
    );
    let apart = [both[0].clone(), maneuver(&short_period(2.0))];
    assert_eq!(warnings(&plan(json!({}), &apart)), [""; 0]);
}

/// 50 Hz told in ticks of 1/512 s: the estimates are those of the exact clock.
#[test]
fn a_clock_in_ticks_changes_nothing() {
    let exact = short_period(1.0);
    let mut ticks = exact.clone();
    for t in &mut ticks[0] {
        *t = (*t * 512.0).floor() / 512.0;
    }
    let (exact, ticks) = (fit(json!({}), &exact), fit(json!({}), &ticks));
    assert_eq!(ticks.estimate.findings[0].code, "coarse_clock");
    assert!(!ticks.estimate.findings.iter().any(Finding::is_warning));
    for (name, _) in TRUTH {
        let (a, b) = (parameter(&exact, name), parameter(&ticks, name));
        assert!(
            (a.estimate - b.estimate).abs() < 1e-6 * a.standard_error.unwrap(),
            "{name}"
        );
    }
}

#[test]
fn units_that_slipped_are_told_by_what_channels_say_of_each_other() {
    let found = |slip: &dyn Fn(&mut [Vec<f64>; 4])| {
        let mut series = short_period(1.0);
        slip(&mut series);
        let plan = plan(json!("short-period"), json!({}), &[maneuver(&series)]);
        let findings = plan.prepared.findings.iter();
        let words = findings.map(|finding| format!("{}: {}", finding.code, finding.message));
        words.collect::<Vec<String>>().join("\n")
    };
    let time = found(&|series| series[0].iter_mut().for_each(|t| *t *= 1000.0));
    assert!(
        time.contains("implausible_rate: samples are 20.000 s apart"),
        "{time}"
    );
    assert!(
        time.contains("time in milliseconds declared as seconds"),
        "{time}"
    );
    let q = found(&|series| series[3].iter_mut().for_each(|q| *q = q.to_radians()));
    assert!(
        q.contains("channels_disagree") && q.contains("q in radians declared as degrees"),
        "{q}"
    );
    let sign = found(&|series| series[3].iter_mut().for_each(|q| *q = -*q));
    assert!(sign.contains("the other sign"), "{sign}");
    let sentinel = found(&|series| {
        [120, 300, 301, 555]
            .into_iter()
            .for_each(|k| series[2][k] = -9999.0)
    });
    assert!(
        sentinel.contains("sentinel: 4 value(s) are -9999 exactly"),
        "{sentinel}"
    );
    assert!(!sentinel.contains("implausible"), "{sentinel}");
}
