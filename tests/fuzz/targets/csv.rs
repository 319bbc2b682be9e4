//! A recording as CSV: bytes of a stranger.
#![no_main]

use libfuzzer_sys::fuzz_target;
use trimtab_core::ingest::{self, Format};

#[path = "common/recording.rs"]
mod recording;

fuzz_target!(|bytes: &[u8]| {
    let read = ingest::read(bytes, Format::Csv, &recording::LIMITS);
    recording::look_at(read);
});
