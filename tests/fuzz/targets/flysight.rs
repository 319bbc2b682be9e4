//! SENSOR.CSV of a FlySight 2, as it says itself and with a mapping.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use trimtab_core::ingest::{self, Format, Mapping};

#[path = "common/beginnings.rs"]
mod beginnings;
#[path = "common/recording.rs"]
mod recording;

static MAPPING: LazyLock<Mapping> = LazyLock::new(|| {
    let text = r#"{"channels": {"a": {"from": "IMU.wx", "between": "straight"}, "b": {"from": "BARO.pressure", "unit": "Pa", "time": {"offset": 0.1}}}, "optional": true}"#;
    Mapping::from_json(text).expect("a mapping")
});

fuzz_target!(|bytes: &[u8]| {
    // what begins otherwise is a table of text
    let (_, beginning) = beginnings::BEGINNINGS[0];
    let file = [beginning.as_bytes(), bytes].concat();
    for mapping in [None, Some(&*MAPPING)] {
        let read = ingest::read_mapped(&file, Format::Csv, mapping, &recording::LIMITS);
        recording::look_at(read);
    }
});
