//! A recording as a MAT file of version 5, with mappings that go down all paths into it.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use trimtab_core::ingest::{self, Format, Mapping};

#[path = "common/recording.rs"]
mod recording;

/// The names are those of the files in `tests/ingest/recordings`.
static MAPPINGS: LazyLock<[Mapping; 4]> = LazyLock::new(|| {
    [
        r#"{"time": {"from": "t", "unit": "s"},
            "channels": {"alpha": {"from": "alpha", "unit": "deg"}, "q": {"from": "q", "unit": "deg/s"}}}"#,
        r#"{"time": {"from": "(:,1)", "unit": "s"}, "channels": {"alpha": {"from": "(:,2)", "unit": "deg"}}}"#,
        r#"{"time": {"from": "rec.t", "unit": "ms"},
            "channels": {"ax": {"from": "rec.inner.acc(:,2)", "unit": "g"}, "a": {"from": "rec.alpha", "unit": "-"}}}"#,
        r#"{"time": {"step": 0.04, "unit": "s"}, "channels": {"q": {"from": "data(3,:)", "unit": "deg/s"}}}"#,
    ]
    .map(|text| Mapping::from_json(text).expect("a mapping"))
});

fuzz_target!(|bytes: &[u8]| {
    let limits = recording::LIMITS;
    let listed = ingest::read_mapped(bytes, Format::Mat, None, &limits);
    assert!(listed.is_err(), "a MAT file needs a mapping");
    for mapping in &*MAPPINGS {
        recording::look_at(ingest::read_mapped(
            bytes,
            Format::Mat,
            Some(mapping),
            &limits,
        ));
    }
});
