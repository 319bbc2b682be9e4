//! A TDMS file, as it says itself and with a mapping.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use trimtab_core::ingest::{self, Format, Mapping};

#[path = "common/recording.rs"]
mod recording;

static MAPPING: LazyLock<Mapping> = LazyLock::new(|| {
    let text = r#"{"channels": {"a": {"from": "IMU.Pitch_Rate_deg_s", "unit": "-", "between": "held"}, "b": {"from": "mass", "unit": "-"}}, "optional": true}"#;
    Mapping::from_json(text).expect("a mapping")
});

fuzz_target!(|bytes: &[u8]| {
    let mut bytes = bytes.to_vec();
    if bytes.len() > 4 {
        bytes[..4].copy_from_slice(b"TDSm");
    }
    for mapping in [None, Some(&*MAPPING)] {
        let read = ingest::read_mapped(&bytes, Format::Unstated, mapping, &recording::LIMITS);
        recording::look_at(read);
    }
});
