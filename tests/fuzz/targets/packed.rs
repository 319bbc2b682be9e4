//! Anything packed with gzip or zip, and workbooks: whatever the first bytes say.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use trimtab_core::ingest::{self, Format, Mapping};

#[path = "common/recording.rs"]
mod recording;

static MAPPING: LazyLock<Mapping> = LazyLock::new(|| {
    let text = r#"{"time": {"from": "(:,1)", "unit": "s"}, "channels": {"a": {"from": "(:,2)", "unit": "-"}}}"#;
    Mapping::from_json(text).expect("a mapping")
});

fuzz_target!(|bytes: &[u8]| {
    for mapping in [None, Some(&*MAPPING)] {
        let read = ingest::read_mapped(bytes, Format::Unstated, mapping, &recording::LIMITS);
        recording::look_at(read);
    }
});
