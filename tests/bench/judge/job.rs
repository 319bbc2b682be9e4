//! Jobs as a user would submit them.

use std::ops::ControlFlow;
use std::sync::Arc;

use serde_json::{Value, json};
use trimtab_core::diagnose::{Diagnosis, Step};
use trimtab_core::flight::Maneuver;
use trimtab_core::job::{self, JobResult, JobSpec, Plan};
use trimtab_core::model::ModelDocument;

use crate::record::Recording;

/// A job's plan; in words why there is none.
pub(crate) fn plan(
    kind: &str,
    document: &ModelDocument,
    recordings: &[&Recording],
    options: &Value,
) -> Result<Plan, String> {
    let uses: Vec<Value> = (recordings.iter())
        .map(|recording| {
            let role = if recording.fitted {
                "estimation"
            } else {
                "validation"
            };
            json!({"id": recording.maneuver.digest(), "label": recording.label, "role": role})
        })
        .collect();
    let spec = json!({"kind": kind, "model": document, "maneuvers": uses, "options": options});
    let spec: JobSpec = serde_json::from_value(spec).map_err(|error| error.to_string())?;
    let maneuvers: Vec<Arc<Maneuver>> = recordings.iter().map(|r| r.maneuver.clone()).collect();
    job::prepare(&spec, document, &maneuvers).map_err(|faults| words(&faults))
}

fn words(faults: &[trimtab_core::flight::Fault]) -> String {
    let all: Vec<String> = faults.iter().map(ToString::to_string).collect();
    all.join("; ")
}

/// An estimation with what was fitted of the recordings.
pub(crate) fn estimate(
    document: &ModelDocument,
    recordings: &[Recording],
    options: &Value,
) -> Result<JobResult, String> {
    let fitted: Vec<&Recording> = recordings.iter().filter(|r| r.fitted).collect();
    let plan = plan("estimate", document, &fitted, options)?;
    job::run(&plan, &mut |_| ControlFlow::Continue(())).map_err(|faults| words(&faults))
}

/// The diagnosis; its steps are told to `watcher`.
pub(crate) fn diagnose(
    document: &ModelDocument,
    recordings: &[Recording],
    watcher: &mut dyn FnMut(&Step),
) -> Result<Diagnosis, String> {
    let all: Vec<&Recording> = recordings.iter().collect();
    let plan = plan("diagnose", document, &all, &json!({}))?;
    let result = job::run_diagnosis(&plan, &mut |step| {
        if let Some(step) = step {
            watcher(step);
        }
        ControlFlow::Continue(())
    });
    let result = result.map_err(|faults| words(&faults))?;
    result.diagnosis.ok_or_else(|| "no diagnosis".to_string())
}
