//! Texts of programs whose header says names, times or factors: one byte chooses how it begins.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use trimtab_core::ingest::{self, Format, Mapping};

#[path = "common/recording.rs"]
mod recording;

const BEGINNINGS: [&str; 6] = [
    "# Created by Octave 8.4.0\n# name: t\n# type: ",
    "14 1001\n",
    "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\nFMT, 130, 40, IMU, QBff, TimeUS,I,GyrX,GyrY\n",
    "VARIABLES = \"t [s]\" \"a\"\n",
    "[column names]\n",
    "Interval=\t0.02 s\nChannelTitle=\t",
];

static MAPPING: LazyLock<Mapping> = LazyLock::new(|| {
    let text = r#"{"time": {"step": 0.1, "unit": "s"}, "channels": {"a": {"from": ["t", "t.a", "IMU.GyrX", "(:,2)"], "unit": "-"}}, "optional": true}"#;
    Mapping::from_json(text).expect("a mapping")
});

fuzz_target!(|bytes: &[u8]| {
    let Some((first, rest)) = bytes.split_first() else {
        return;
    };
    let beginning = BEGINNINGS[usize::from(*first) % BEGINNINGS.len()];
    let file = [beginning.as_bytes(), rest].concat();
    for mapping in [None, Some(&*MAPPING)] {
        let read = ingest::read_mapped(&file, Format::Unstated, mapping, &recording::LIMITS);
        recording::look_at(read);
    }
});
