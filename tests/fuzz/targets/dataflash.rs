//! A log of ArduPilot, with the bundled mapping and one that names instances.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use trimtab_core::ingest::{self, Format, Mapping};

#[path = "common/recording.rs"]
mod recording;

static MAPPING: LazyLock<Mapping> = LazyLock::new(|| {
    let text = r#"{"channels": {"a": {"from": "IMU[1].GyrY", "unit": "-", "between": "straight"}, "b": {"from": "ATT.Roll", "unit": "deg", "time": {"offset": 0.1}}}, "optional": true}"#;
    Mapping::from_json(text).expect("a mapping")
});

fuzz_target!(|bytes: &[u8]| {
    for mapping in [None, Some(&*MAPPING)] {
        let read = ingest::read_mapped(bytes, Format::Unstated, mapping, &recording::LIMITS);
        recording::look_at(read);
    }
});
