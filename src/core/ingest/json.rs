//! JSON recordings.
//!
//! ```json
//! { "time": {"unit": "s", "values": [0, 0.04, 0.08]},
//!   "channels": {"alpha": {"unit": "deg", "values": [1.2, null, 1.4]}} }
//! ```
//!
//! `time` may also be even: `{"unit": "s", "start": 0, "step": 0.04}`; `null` is a missing value.

use serde_json::error::Category;
use serde_path_to_error::{Path, Segment};

use crate::flight::{Fault, Maneuver};

use super::{
    IngestError, Limits, code,
    fault::pointer,
    recording::Recording,
    text::{decode, short_message},
};

/// Reads a JSON recording.
///
/// # Errors
/// The first fault of syntax or shape; else every fault of names, units and lengths and the first
/// 20 of the time axis.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Maneuver, IngestError> {
    let text = decode(bytes)?;
    survey(text, limits)?;
    let recording = parse(text, limits)?;
    recording.check_size(limits)?;
    recording.into_maneuver(limits)
}

/// Refuses what can only be too much before anything is built from it: there are no more channels
/// than opening braces and no more values than commas.
fn survey(text: &str, limits: &Limits) -> Result<(), Fault> {
    let (mut braces, mut commas) = (0usize, 0usize);
    for byte in text.bytes() {
        braces += usize::from(byte == b'{');
        commas += usize::from(byte == b',');
    }
    // Braces and commas that are not a channel's or a value's: the document, time, their members.
    let channels = braces.saturating_sub(2);
    limits.columns(channels).map_or(Ok(()), Err)?;
    let between_members = 3 + 2 * channels;
    let values = commas.saturating_sub(between_members);
    limits.values(values).map_or(Ok(()), Err)
}

fn parse(text: &str, limits: &Limits) -> Result<Recording, Fault> {
    let mut deserializer = serde_json::Deserializer::from_str(text);
    let recording: Recording =
        serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
            let place = pointer_of(error.path(), limits);
            fault_of(error.inner(), place)
        })?;
    deserializer
        .end()
        .map_err(|error| fault_of(&error, String::new()))?;
    Ok(recording)
}

fn fault_of(error: &serde_json::Error, place: String) -> Fault {
    let (code, remedy) = match error.classify() {
        Category::Data => (
            code::WRONG_SHAPE,
            r#"a recording is {"time": {"unit", "values" or "start" and "step"}, "channels": {name: {"unit", "values"}}}"#,
        ),
        _ => (code::INVALID_JSON, "send one complete JSON document"),
    };
    let message = format!("{}; {remedy}", short_message(&error.to_string()));
    Fault::new(place, code, message)
}

/// The path as an RFC 6901 pointer, up to a key that is too long to repeat.
fn pointer_of(path: &Path, limits: &Limits) -> String {
    let segments = path.iter().map_while(|segment| match segment {
        Segment::Seq { index } => Some(index.to_string()),
        Segment::Map { key } if key.len() <= limits.max_name_length => Some(key.clone()),
        _ => None,
    });
    pointer(segments)
}

#[cfg(test)]
mod tests {
    use super::super::fault::places;
    use super::*;

    fn read_text(text: &str) -> Result<Maneuver, IngestError> {
        read(text.as_bytes(), &Limits::default())
    }

    fn faults(text: &str) -> Vec<String> {
        places(read_text(text))
    }

    fn recording(time: &str, channels: &str) -> String {
        format!(r#"{{"time": {{{time}}}, "channels": {{{channels}}}}}"#)
    }

    const EVEN: &str = r#""unit": "ms", "start": 1000, "step": 40"#;
    const ALPHA: &str = r#""alpha": {"unit": "deg", "values": [180, null, 0]}"#;

    #[test]
    fn reads_both_kinds_of_time_and_missing_values() {
        let listed = r#""unit": "s", "values": [1, 1.04, 1.08]"#;
        for time in [EVEN, listed] {
            let maneuver = read_text(&recording(time, ALPHA)).unwrap();
            assert_eq!(maneuver.time(), [1.0, 1.04, 1.08]);
            let alpha = &maneuver.channels()["alpha"].values;
            assert_eq!(alpha[0], std::f64::consts::PI);
            assert!(alpha[1].is_nan());
        }
        let pure = recording(r#""unit": "s", "step": 1"#, r#""mach": {"values": [1, 2]}"#);
        assert_eq!(
            read_text(&pure).unwrap().channels()["mach"].recorded_unit,
            "-"
        );
    }

    #[test]
    fn syntax_and_shape_name_their_place() {
        assert_eq!(faults(" "), ["empty_body "]);
        assert_eq!(faults("{"), ["invalid_json "]);
        assert_eq!(faults("[]"), ["wrong_shape "]);
        let good = recording(EVEN, ALPHA);
        assert_eq!(faults(&format!("{good}{good}")), ["invalid_json "]);
        let cut = &good[..good.len() - 5];
        assert!(
            faults(cut)[0].starts_with("invalid_json /channels"),
            "{:?}",
            faults(cut)
        );
        let text = recording(EVEN, r#""a": {"values": [1, "x"]}"#);
        assert_eq!(faults(&text), ["wrong_shape /channels/a/values/1"]);
        let text = recording(EVEN, r#""a/b~": 3"#);
        assert_eq!(faults(&text), ["wrong_shape /channels/a~1b~0"]);
        assert_eq!(faults(r#"{"time": {"unit": "s"}}"#), ["wrong_shape "]);
        let text = recording(r#""unit": "s", "values": [1], "rate": 1"#, "");
        assert_eq!(faults(&text), ["wrong_shape /time/rate"]);
        let text = recording(r#""unit": "s", "values": [1], "step": 1"#, ALPHA);
        assert!(faults(&text).contains(&"wrong_shape /time".to_string()));
        let deep = "[".repeat(100_000);
        assert!(faults(&deep)[0].starts_with("wrong_shape "));
    }

    #[test]
    fn all_faults_of_content_are_reported_at_once() {
        let channels = r#""a b": {"unit": "deg", "values": [1, 2]},
            "q": {"unit": "warp", "values": [1, 2, 3]},
            "q": {"unit": "deg", "values": [1, 2, 3]}"#;
        let text = recording(r#""unit": "s", "values": [0, null, 0]"#, channels);
        assert_eq!(
            faults(&text),
            [
                "time_missing /time/values/1",
                "invalid_name /channels/a b",
                "length_mismatch /channels/a b/values",
                "unknown_unit /channels/q/unit",
                "duplicate_channel /channels/q",
            ]
        );
        let backwards = recording(r#""unit": "s", "values": [0, 2, 1]"#, ALPHA);
        assert_eq!(faults(&backwards), ["time_not_increasing /time/values/2"]);
        for step in ["0", "-1", "1e-30"] {
            let time = format!(r#""unit": "s", "start": 1, "step": {step}"#);
            let place = ["time_not_increasing /time/step"];
            assert_eq!(faults(&recording(&time, ALPHA)), place);
        }
        let metres = recording(r#""unit": "m", "step": 1"#, ALPHA);
        assert_eq!(faults(&metres), ["time_unit /time/unit"]);
        assert_eq!(faults(&recording(EVEN, "")), ["no_channels /channels"]);
        let one = recording(EVEN, r#""a": {"values": [1]}"#);
        assert_eq!(faults(&one), ["too_few_samples "]);
        let unnamed = recording(EVEN, r#""": {"values": [1, 2]}"#);
        assert_eq!(faults(&unnamed), ["empty_name /channels/"]);
        let beyond = recording(EVEN, r#""a": {"values": [1, 1e999]}"#);
        assert_eq!(faults(&beyond), ["invalid_json /channels/a/values/1"]);
    }

    #[test]
    fn limits_are_named() {
        let limits = Limits {
            max_columns: 3,
            max_samples: 4,
            max_values: 8,
            max_name_length: 5,
            ..Limits::default()
        };
        let refused = |channels: &str, code: &str, bound: &str| {
            let error = read(recording(EVEN, channels).as_bytes(), &limits).unwrap_err();
            assert_eq!(error.faults()[0].code, code, "{error}");
            assert!(error.to_string().contains(bound), "{error}");
        };
        let channel = |name: &str, values: &str| format!(r#""{name}": {{"values": [{values}]}}"#);
        let many: Vec<_> = (0..4).map(|k| channel(&format!("a{k}"), "1,2")).collect();
        refused(
            &many[..3].join(","),
            code::TOO_MANY_COLUMNS,
            "max_columns = 3",
        );
        refused(&many.join(","), code::TOO_MANY_COLUMNS, "max_columns = 3");
        let long = channel("a", "1,2,3,4,5");
        refused(&long, code::TOO_MANY_SAMPLES, "max_samples = 4");
        let huge = channel("a", &vec!["1"; 100].join(","));
        refused(&huge, code::TOO_MANY_VALUES, "max_values = 8");
        let name = channel("abcdef", "1,2");
        refused(&name, code::NAME_TOO_LONG, "max_name_length = 5");
    }

    #[test]
    fn a_huge_key_is_not_repeated() {
        let key = "k".repeat(1_000_000);
        for value in [
            "3",
            r#"{"values": [1, 2]}"#,
            r#"{"unit": "warp", "values": [1]}"#,
        ] {
            let error = read_text(&recording(EVEN, &format!(r#""{key}": {value}"#))).unwrap_err();
            assert!(error.to_string().len() < 3000);
        }
    }
}
