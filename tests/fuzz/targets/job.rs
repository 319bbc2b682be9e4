//! The spec of a job, prepared with models of the catalog (or its own) and two small recordings.
#![no_main]

use std::sync::{Arc, LazyLock};

use libfuzzer_sys::fuzz_target;
use trimtab_core::flight::Maneuver;
use trimtab_core::ingest::{self, Format, Limits};
use trimtab_core::job::{self, JobSpec, MOST_MANEUVERS, ModelSource};
use trimtab_core::model::{ModelDocument, catalog};

/// One without a fault; one with a gap in time and with missing values.
static MANEUVERS: LazyLock<[Arc<Maneuver>; 2]> = LazyLock::new(|| {
    [
        include_bytes!("../maneuvers/whole.csv").as_slice(),
        include_bytes!("../maneuvers/gaps.csv"),
    ]
    .map(|csv| Arc::new(ingest::read(csv, Format::Csv, &Limits::default()).expect("a recording")))
});

static CATALOG: LazyLock<Vec<ModelDocument>> = LazyLock::new(catalog::all);

fuzz_target!(|text: &str| {
    let Ok(spec) = serde_json::from_str::<JobSpec>(text) else {
        return;
    };
    let declared = match &spec.model {
        ModelSource::Document(document) => document,
        ModelSource::Reference(name) => match CATALOG.iter().find(|model| model.name == *name) {
            Some(model) => model,
            None => return,
        },
    };
    // as the service has it: more are refused before they are looked up
    if spec.maneuvers.len() > MOST_MANEUVERS {
        return;
    }
    let maneuvers: Vec<Arc<Maneuver>> = (spec.maneuvers.iter())
        .map(|used| Arc::clone(&MANEUVERS[usize::from(used.id.starts_with('g'))]))
        .collect();
    match job::prepare(&spec, declared, &maneuvers) {
        Ok(plan) => assert!(plan.prepared.samples > 0, "nothing to estimate from"),
        Err(faults) => assert!(!faults.is_empty(), "refused without a reason"),
    }
});
