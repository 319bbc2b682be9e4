//! Texts of programs whose header says names, times or factors: one byte chooses how it begins.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use trimtab_core::ingest::{self, Format, Mapping};

#[path = "common/beginnings.rs"]
mod beginnings;
#[path = "common/recording.rs"]
mod recording;

static MAPPING: LazyLock<Mapping> = LazyLock::new(|| {
    let text = r#"{"time": {"step": 0.1, "unit": "s"}, "channels": {"a": {"from": ["t", "t.a", "IMU.GyrX", "(:,2)"], "unit": "-"}}, "optional": true}"#;
    Mapping::from_json(text).expect("a mapping")
});

fuzz_target!(|bytes: &[u8]| {
    let Some((first, rest)) = bytes.split_first() else {
        return;
    };
    // the first is that of another target
    let beginnings = &beginnings::BEGINNINGS[1..];
    let (_, beginning) = beginnings[usize::from(*first) % beginnings.len()];
    let file = [beginning.as_bytes(), rest].concat();
    for mapping in [None, Some(&*MAPPING)] {
        let read = ingest::read_mapped(&file, Format::Unstated, mapping, &recording::LIMITS);
        recording::look_at(read);
    }
});
