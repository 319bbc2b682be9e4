//! A log of PX4, with the bundled mapping and one that names instances and elements.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use trimtab_core::ingest::{self, Format, Mapping};

#[path = "common/recording.rs"]
mod recording;

static MAPPING: LazyLock<Mapping> = LazyLock::new(|| {
    let text = r#"{"channels": {"a": {"from": "a[1].x[0]", "unit": "-", "between": "held"}, "b": {"from": "a.b.x", "unit": "-"}}, "optional": true}"#;
    Mapping::from_json(text).expect("a mapping")
});

fuzz_target!(|bytes: &[u8]| {
    for mapping in [None, Some(&*MAPPING)] {
        let read = ingest::read_mapped(bytes, Format::Unstated, mapping, &recording::LIMITS);
        recording::look_at(read);
    }
});
