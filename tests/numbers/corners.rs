//! Where the cost has a corner no derivative vanishes, and a fit has to end all the same.

use serde_json::{Value, json};
use trimtab_core::estimate::Outcome;

use crate::common::plans::{parameter, recording, scatter, solve};

fn model() -> Value {
    json!({
        "name": "corner",
        "inputs": {"u": {}, "v": {}},
        "parameters": {"p": {"start": 1.7}, "k": {"start": 0.5}},
        "outputs": {"y": {"equation": "abs(p - 1)*u + k*v"}},
    })
}

/// The gain of u is less than nothing, and |p - 1| cannot be: the least squares are at p = 1, where they slope to either side. Bad
/// steps had been made there until the budget was used up.
#[test]
fn a_fit_ends_in_a_corner_before_its_budget() {
    let count = 400;
    let at = |k: usize| 0.05 * k as f64;
    let input = |rate: f64| move |k: usize| (rate * at(k)).sin();
    let (u, v) = (input(1.3), input(0.4));
    let series = |f: &dyn Fn(usize) -> f64| (0..count).map(f).collect::<Vec<f64>>();
    let measured = series(&|k| -0.02 * u(k) + 2.0 * v(k) + 0.1 * scatter(k, 2.0));
    let flight = recording(
        series(&at),
        &[("u", series(&u)), ("v", series(&v)), ("y", measured)],
    );
    let options = json!({"options": {"max_iterations": 100, "start": {"kind": "document"}}});
    let found = solve(model(), options, &[flight]);
    let estimate = &found.estimate;
    println!(
        "{:?} after {}: {}",
        estimate.outcome, estimate.iterations, estimate.reason
    );
    assert_eq!(estimate.outcome, Outcome::Stalled);
    assert!(estimate.reason.contains("corner"), "{}", estimate.reason);
    assert!(estimate.iterations < 60, "{}", estimate.iterations);
    let gain = parameter(&found, "p").estimate;
    assert!((gain - 1.0).abs() < 1e-4, "{gain}");
    // by least squares of y on v alone
    assert!((parameter(&found, "k").estimate - 2.0).abs() < 0.02);
}
