//! An HDF5 file, as its titles say and with a mapping.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use trimtab_core::ingest::{self, Format, Mapping};

#[path = "common/recording.rs"]
mod recording;

static MAPPING: LazyLock<Mapping> = LazyLock::new(|| {
    let text = r#"{"time": {"step": 0.1, "unit": "s"}, "channels": {"a": {"from": ["gzip", "t", "time", "data(:,2)"], "unit": "-"}, "b": {"from": ["lzf", "single", "z.imag", "rec.q"], "unit": "-"}, "c": {"from": ["shuffled", "fixed", "rec.alpha"], "unit": "-"}, "d": {"from": ["big_endian", "implicit"], "unit": "-"}}, "optional": true}"#;
    Mapping::from_json(text).expect("a mapping")
});

fuzz_target!(|bytes: &[u8]| {
    let mut bytes = bytes.to_vec();
    if bytes.len() > 8 {
        bytes[..8].copy_from_slice(b"\x89HDF\r\n\x1a\n");
    }
    for mapping in [None, Some(&*MAPPING)] {
        let read = ingest::read_mapped(&bytes, Format::Unstated, mapping, &recording::LIMITS);
        recording::look_at(read);
    }
});
