//! A Parquet file, as its titles say and with a mapping.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use trimtab_core::ingest::{self, Format, Mapping};

#[path = "common/recording.rs"]
mod recording;

static MAPPING: LazyLock<Mapping> = LazyLock::new(|| {
    let text = r#"{"time": {"step": 0.1, "unit": "s"}, "channels": {"a": {"from": "(:,1)", "unit": "-"}}, "others": true}"#;
    Mapping::from_json(text).expect("a mapping")
});

fuzz_target!(|bytes: &[u8]| {
    // whatever the first bytes are: the rest is to be looked at
    let mut bytes = bytes.to_vec();
    if bytes.len() > 16 {
        let end = bytes.len() - 4;
        bytes[..4].copy_from_slice(b"PAR1");
        bytes[end..].copy_from_slice(b"PAR1");
    }
    for mapping in [None, Some(&*MAPPING)] {
        let read = ingest::read_mapped(&bytes, Format::Unstated, mapping, &recording::LIMITS);
        recording::look_at(read);
    }
});
