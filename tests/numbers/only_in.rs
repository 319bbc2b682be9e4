//! Parameters that are free in some maneuvers of a job only.

use crate::common::plans::{recording, scatter, solve};
use serde_json::json;

#[test]
fn a_parameter_is_zero_where_it_is_not_meant() {
    let time: Vec<f64> = (0..50).map(|k| 0.1 * f64::from(k)).collect();
    let line = |slope: f64| {
        let y = |(k, t): (usize, &f64)| 0.4 + slope * t + 0.1 * scatter(k, 2.0);
        recording(
            time.clone(),
            &[("y", time.iter().enumerate().map(y).collect())],
        )
    };
    let [first, second, third] = [0.0, 1.2, 0.7].map(line);
    let model = |labels: &[&str]| {
        json!({
            "name": "line",
            "parameters": {
                "a": {"start": 0.0},
                "b": {"unit": "1/s", "start": 1.0, "per": "maneuver", "only_in": labels},
            },
            "outputs": {"y": {"equation": "a + b*t"}},
        })
    };
    let used = [&first, &second, &third].map(|maneuver| maneuver.digest().to_string());
    let maneuvers = json!([
        {"id": used[0], "label": "first"},
        {"id": used[1], "label": "second"},
        {"id": used[2], "label": "third", "role": "validation"},
    ]);
    let changes = json!({"maneuvers": maneuvers, "options": {"noise": {"kind": "given", "variance": [0.001]}}});
    let recordings = [first, second, third];
    let result = solve(model(&["second", "third"]), changes.clone(), &recordings);
    let rows = &result.estimate.parameters;
    let slopes: Vec<(&str, bool, f64)> = (rows.iter())
        .filter(|row| row.name == "b")
        .map(|row| (row.segment.as_deref().unwrap(), row.fixed, row.estimate))
        .collect();
    let [("first", true, 0.0), ("second", false, slope)] = slopes[..] else {
        panic!("{slopes:?}");
    };
    assert!((slope - 1.2).abs() < 0.02, "{slope}");
    let [prediction] = &result.estimate.prediction[..] else {
        panic!("one prediction");
    };
    let [predicted] = &prediction.parameters[..] else {
        panic!("{:?}", prediction.parameters);
    };
    assert!((predicted.estimate - 0.7).abs() < 0.02, "{predicted:?}");

    // a label that nothing has is said, and what there is
    let lost = solve(model(&["fourth"]), changes, &recordings);
    let told = lost
        .estimate
        .findings
        .iter()
        .find(|finding| finding.code == "elsewhere");
    let told = told.expect("a finding");
    assert!(told.remedy.contains("first, second, third"), "{told:?}");
    let codes = result
        .estimate
        .findings
        .iter()
        .map(|finding| &*finding.code);
    assert!(!codes.collect::<Vec<_>>().contains(&"elsewhere"));
}
