//! Texts with something put wrong by chance, from seeds and words of the fuzz targets: each is a recording or a list of faults.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trimtab_core::ingest::{Format, Limits, Mapping, quality, read_recording, summary};

use crate::common::repository;
use beginnings::BEGINNINGS;

#[path = "../fuzz/targets/common/beginnings.rs"]
mod beginnings;

/// As many of each text.
const TRIED: u64 = 2000;

const WORDS: [&str; 16] = [
    "\n",
    "\t",
    ",",
    "nan",
    "1e999",
    "-0",
    "18446744073709551615",
    "# name: ",
    "1001",
    "FMT, 131, 27, ATT, Qcc, ",
    "$UNIT,",
    "$DATA\n",
    "ZONE",
    "hhmmss",
    "Sample rate: 0 Hz\n",
    "\u{b5}",
];

fn mutated(chance: &mut ChaCha8Rng, text: &[u8]) -> Vec<u8> {
    let mut bytes = text.to_vec();
    for _ in 0..chance.random_range(1..5) {
        let at = chance.random_range(0..=bytes.len());
        let end = (at + chance.random_range(0..20)).min(bytes.len());
        match chance.random_range(0..5) {
            0 if at < bytes.len() => bytes[at] = chance.random(),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let again = bytes[at..end].to_vec();
                bytes.splice(at..at, again);
            }
            3 => bytes.truncate(at.max(1)),
            _ => {
                let word = WORDS[chance.random_range(0..WORDS.len())];
                bytes.splice(at..at, word.bytes());
            }
        }
    }
    bytes
}

#[test]
fn whatever_is_put_wrong_is_answered() {
    let mapping = r#"{"time": {"step": 0.1, "unit": "s"}, "channels": {"a": {"from": ["t", "t.a", "IMU.GyrX", "IMU.wx", "(:,2)"], "unit": "-"}}, "optional": true}"#;
    let mapping = Mapping::from_json(mapping).unwrap();
    let limits = Limits {
        max_columns: 16,
        max_samples: 256,
        max_values: 1024,
        ..Limits::default()
    };
    let (mut read, mut refused) = (0, 0);
    for (seed, beginning) in BEGINNINGS {
        let path = repository::path(&format!("tests/fuzz/seeds/{seed}"));
        let mut text = std::fs::read(path).expect("a seed");
        if seed.starts_with("programs") && !text[0].is_ascii_graphic() {
            text.remove(0);
        }
        text.splice(0..0, beginning.bytes());
        let roomy = Limits::default();
        let of_whole = |mapping| read_recording(&text, Format::Unstated, None, mapping, &roomy);
        let is_read = of_whole(None).is_ok() || of_whole(Some(&mapping)).is_ok();
        assert!(is_read, "{seed}: {:?}", of_whole(None).err());
        let mut chance = ChaCha8Rng::seed_from_u64(17);
        for _ in 0..TRIED {
            let bytes = mutated(&mut chance, &text);
            for mapping in [None, Some(&mapping)] {
                match read_recording(&bytes, Format::Unstated, None, mapping, &limits) {
                    Ok(reading) => {
                        assert!(reading.maneuver.len() <= limits.max_samples);
                        quality(&reading.maneuver);
                        summary(&reading.maneuver);
                        read += 1;
                    }
                    Err(error) => {
                        assert!(!error.faults().is_empty(), "{seed}");
                        refused += 1;
                    }
                }
            }
        }
    }
    // neither is the rule
    assert!(
        read > 1000 && refused > 1000,
        "{read} read, {refused} refused"
    );
}
