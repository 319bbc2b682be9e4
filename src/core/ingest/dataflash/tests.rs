//! Logs that are written here, as the format's description has them.

use super::super::{Format, Limits, Mapping, code, fault::places, read_mapped};
use crate::flight::Maneuver;
use crate::ingest::{IngestError, read_recording};

/// A log in the making.
struct Writer(Vec<u8>);

fn padded<const N: usize>(text: &str) -> [u8; N] {
    let mut bytes = [0; N];
    bytes[..text.len()].copy_from_slice(text.as_bytes());
    bytes
}

impl Writer {
    fn define(&mut self, kind: u8, length: u8, name: &str, letters: &str, columns: &str) {
        self.0.extend([0xa3, 0x95, 128, kind, length]);
        self.0.extend(padded::<4>(name));
        self.0.extend(padded::<16>(letters));
        self.0.extend(padded::<64>(columns));
    }

    fn message(&mut self, kind: u8, parts: &[&[u8]]) {
        self.0.extend([0xa3, 0x95, kind]);
        self.0.extend(parts.concat());
    }
}

/// Two gyros at 50 Hz, attitude at 10 Hz, and a position.
fn log() -> Vec<u8> {
    let mut log = Writer(Vec::new());
    log.define(128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
    log.define(10, 44, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds");
    log.define(11, 76, "UNIT", "QbZ", "TimeUS,Id,Label");
    log.define(12, 20, "MULT", "Qbd", "TimeUS,Id,Mult");
    log.define(20, 16, "IMU", "QBf", "TimeUS,I,GyrY");
    log.define(21, 15, "ATT", "Qcc", "TimeUS,Roll,Pitch");
    log.define(22, 19, "GPS", "QLL", "TimeUS,Lat,Lng");
    log.define(23, 7, "OLD", "I", "TimeMS");
    log.define(24, 15, "MSG", "Qn", "TimeUS,Message");
    let zero = 0u64.to_le_bytes();
    log.message(
        10,
        &[&zero, &[20], &padded::<16>("s#E"), &padded::<16>("F-B")],
    );
    log.message(
        10,
        &[&zero, &[21], &padded::<16>("sdd"), &padded::<16>("FBB")],
    );
    for (id, unit) in [(b's', "s"), (b'E', "rad/s"), (b'd', "deg")] {
        log.message(11, &[&zero, &[id], &padded::<64>(unit)]);
    }
    for (id, factor) in [(b'F', 1e-6f64), (b'B', 1e-2)] {
        log.message(12, &[&zero, &[id], &factor.to_le_bytes()]);
    }
    for k in 0..50u64 {
        let time = (1_000_000 + 20_000 * k).to_le_bytes();
        for instance in 0..2u8 {
            let rate = (k as f32 + 100.0 * f32::from(instance)).to_le_bytes();
            log.message(20, &[&time, &[instance], &rate]);
        }
        if k % 5 == 0 {
            let pitch = (-150 * k as i16 / 5).to_le_bytes();
            log.message(21, &[&time, &250i16.to_le_bytes(), &pitch]);
            let latitude = 481_234_567i32.to_le_bytes();
            log.message(22, &[&time, &latitude, &(-113_000_000i32).to_le_bytes()]);
        }
    }
    log.0
}

fn read(bytes: &[u8], mapping: Option<&str>) -> Result<Maneuver, IngestError> {
    let mapping = mapping.map(|text| Mapping::from_json(text).unwrap());
    read_mapped(
        bytes,
        Format::Unstated,
        mapping.as_ref(),
        &Limits::default(),
    )
}

#[test]
fn messages_keep_their_own_times() {
    let maneuver = read(&log(), None).unwrap();
    let names: Vec<&String> = maneuver.channels().keys().collect();
    assert_eq!(names, ["q", "phi", "theta", "lat", "lon"]);
    assert_eq!((maneuver.len(), maneuver.time()[1]), (50, 1.02));
    let channel = |name: &str| &maneuver.channels()[name].values;
    assert_eq!(channel("q")[7], 7.0);
    assert_eq!(channel("theta")[10], (-3.0f64).to_radians());
    assert!(channel("theta")[11].is_nan());
    assert_eq!(channel("lat")[0], 48.123_456_7_f64.to_radians());
    assert_eq!(channel("phi").iter().filter(|v| !v.is_nan()).count(), 10);
}

#[test]
fn instances_and_old_logs_are_named_by_a_mapping() {
    let text = r#"{"channels": {"second": {"from": "IMU[1].GyrY", "unit": "rad/s"},
        "theta": {"from": "ATT.Pitch", "unit": "deg", "between": "straight"}}}"#;
    let maneuver = read(&log(), Some(text)).unwrap();
    assert_eq!(maneuver.channels()["second"].values[3], 103.0);
    let theta = maneuver.channels()["theta"].values[6].to_degrees();
    assert!((theta - (-1.8)).abs() < 1e-12, "{theta}");

    let table = r#"{"tables": {"ATT": {"offset": 0.01}},
        "channels": {"q": {"from": "IMU.GyrY", "unit": "rad/s"}, "phi": {"from": "ATT.Roll", "unit": "deg"}}}"#;
    let shifted = read(&log(), Some(table)).unwrap();
    assert_eq!(shifted.len(), 60);
    assert!((shifted.time()[1] - 1.01).abs() < 1e-12);

    let error = read(
        &log(),
        Some(r#"{"channels": {"a": {"from": "ATT.Pich", "unit": "deg"}}}"#),
    );
    let error = error.unwrap_err().to_string();
    assert!(
        error.contains("it has TimeUS [0.000001 s], Roll [deg], Pitch [deg]"),
        "{error}"
    );

    let mut old = Writer(Vec::new());
    old.define(1, 11, "IMU", "If", "TimeMS,GyrY");
    for k in 0..3u32 {
        old.message(1, &[&(20 * k).to_le_bytes(), &1f32.to_le_bytes()]);
    }
    assert_eq!(read(&old.0, None).unwrap().time(), [0.0, 0.02, 0.04]);
}

#[test]
fn bytes_that_are_no_message_are_passed_over() {
    let whole = read(&log(), None).unwrap();
    let mut log = log();
    log.extend([1, 2, 0xa3, 0x95, 99, 0xa3]);
    assert_eq!(read(&log, None).unwrap().digest(), whole.digest());
    let cut = read(&log[..log.len() - 6 - 10], None).unwrap();
    assert_eq!(cut.len(), 50, "the last message of the second gyro is lost");
    // a message that comes again is one
    let again = [&log[..], &log[..]].concat();
    assert_eq!(read(&again, None).unwrap().digest(), whole.digest());
}

/// A clock that starts again: the longer part is read, and what was left out is told.
#[test]
fn messages_out_of_order_are_told() {
    let mut log = Writer(Vec::new());
    log.define(20, 15, "IMU", "Qf", "TimeUS,GyrY");
    for k in (900..930u64).chain(0..100) {
        log.message(
            20,
            &[&(20_000 * k).to_le_bytes(), &(k as f32).to_le_bytes()],
        );
    }
    let limits = Limits::default();
    let reading = read_recording(&log.0, Format::Unstated, None, None, &limits).unwrap();
    assert_eq!(reading.maneuver.len(), 100);
    assert_eq!(reading.maneuver.channels()["q"].values[99], 99.0);
    let told = reading.findings.iter();
    let told: Vec<_> = told
        .map(|finding| (&*finding.code, finding.count))
        .collect();
    assert_eq!(told, [("out_of_order", 30)]);
}

#[test]
fn what_is_no_log_is_said() {
    let refused = |bytes: &[u8]| {
        let error = read(bytes, None).unwrap_err();
        assert_eq!(error.faults()[0].code, code::DAMAGED_FILE);
        assert!(error.to_string().contains("mavlogdump.py"), "{error}");
    };
    refused(b"\xa3\x95\x80\x80\x59FMT\0\0");
    let mut empty = Writer(Vec::new());
    empty.define(20, 16, "IMU", "QBf", "TimeUS,I,GyrY");
    refused(&empty.0);
    let mut odd = Writer(Vec::new());
    odd.define(20, 4, "IMU", "QBf", "TimeUS,I,GyrY");
    odd.message(20, &[&[1]]);
    refused(&odd.0);
    let mut none = Writer(Vec::new());
    none.define(20, 15, "ODD", "Qf", "TimeUS,x");
    none.message(20, &[&[0; 12]]);
    assert_eq!(places(read(&none.0, None)), ["mapping_needed "]);
}

#[test]
fn no_damage_to_a_log_panics() {
    let good = log();
    let good = &good[89 * 4..1900];
    for at in 0..good.len() {
        let _ = read(&good[..at], None);
        for with in [0, 1, 0x7f, 0x80, 0xff, good[at] ^ 1] {
            let mut damaged = good.to_vec();
            damaged[at] = with;
            if let Err(error) = read(&damaged, None) {
                assert!(!error.faults().is_empty());
            }
        }
    }
}
