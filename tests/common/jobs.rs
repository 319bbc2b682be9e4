//! Jobs on simulated elevator maneuvers.

use serde_json::{Value, json};

/// A short-period job.
pub(crate) fn job(maneuver: &str) -> Value {
    json!({"model": "short-period", "maneuvers": [{"id": maneuver}]})
}

/// A job that never converges by its tolerance, with a technique that takes its time: with a long maneuver it runs until
/// it is stopped.
pub(crate) fn endless_job(maneuver: &str) -> Value {
    json!({
        "model": "short-period",
        "maneuvers": [{"id": maneuver}],
        "options": {
            "tolerance": 1e-300,
            "max_iterations": 1000,
            "derivatives": {"technique": "complex_step"},
        },
    })
}
