//! A mapping document in the first line, in JSON, and a matrix of numbers as text in the others.
#![no_main]

use libfuzzer_sys::fuzz_target;
use trimtab_core::ingest::{self, Format, Mapping};

#[path = "common/recording.rs"]
mod recording;

fuzz_target!(|bytes: &[u8]| {
    let end = bytes
        .iter()
        .position(|&byte| byte == b'\n')
        .unwrap_or(bytes.len());
    let (first, matrix) = bytes.split_at(end);
    let Ok(text) = std::str::from_utf8(first) else {
        return;
    };
    if let Ok(mapping) = Mapping::named_or_json(text) {
        let limits = recording::LIMITS;
        recording::look_at(ingest::read_mapped(
            matrix,
            Format::Ascii,
            Some(&mapping),
            &limits,
        ));
    }
});
