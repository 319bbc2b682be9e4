//! What happens to every recording once it is read.

use trimtab_core::flight::Maneuver;
use trimtab_core::ingest::{self, Format, IngestError, Limits};

/// Small, so that they are reached.
pub const LIMITS: Limits = Limits {
    max_columns: 16,
    max_samples: 256,
    max_values: 1024,
    max_name_length: 32,
    max_bytes: 65_536,
};

/// Looks at a recording as the service does after an upload, and reads it again from what it is handed out as.
pub fn look_at(read: Result<Maneuver, IngestError>) {
    let maneuver = match read {
        Ok(maneuver) => maneuver,
        Err(error) => {
            assert!(!error.faults().is_empty(), "refused without a reason");
            return;
        }
    };
    assert!(maneuver.len() <= LIMITS.max_samples);
    assert!(maneuver.channels().len() < LIMITS.max_columns);
    ingest::summary(&maneuver);
    ingest::quality(&maneuver);
    let roomy = Limits::default();
    for (text, format) in [
        (ingest::to_csv(&maneuver, |_| true), Format::Csv),
        (
            ingest::to_json(&maneuver).expect("a maneuver is written"),
            Format::Json,
        ),
    ] {
        let again = ingest::read(text.as_bytes(), format, &roomy);
        assert!(
            again.is_ok(),
            "{format:?} is not read again: {text}\n{again:?}"
        );
    }
}
