//! Logs that are written here, as the format's description has them.

use super::super::{Format, Limits, Mapping, code, fault::places, read_mapped};
use crate::flight::Maneuver;
use crate::ingest::{IngestError, Reading, read_recording};

/// A log in the making.
pub(super) struct Writer(pub(super) Vec<u8>);

impl Writer {
    pub(super) fn new() -> Self {
        let mut log = Self(b"ULog\x01\x12\x35\x01".to_vec());
        log.0.extend(112_u64.to_le_bytes());
        log.message(b'B', &[0; 40]);
        log.message(b'I', b"\x0cchar[3] namex01");
        log
    }

    pub(super) fn message(&mut self, kind: u8, content: &[u8]) {
        self.0.extend((content.len() as u16).to_le_bytes());
        self.0.push(kind);
        self.0.extend(content);
    }

    pub(super) fn subscribe(&mut self, instance: u8, number: u16, name: &str) {
        let number = number.to_le_bytes();
        let content = [&[instance], &number[..], name.as_bytes()].concat();
        self.message(b'A', &content);
    }

    pub(super) fn data(&mut self, number: u16, time: u64, values: &[f32]) {
        let mut content = [&number.to_le_bytes()[..], &time.to_le_bytes()].concat();
        content.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        self.message(b'D', &content);
    }
}

/// Rates at 250 Hz, airspeed at 10 Hz, two barometers, and what else a log has.
fn log() -> Vec<u8> {
    let mut log = Writer::new();
    log.message(
        b'F',
        b"vehicle_angular_velocity:uint64_t timestamp;float[3] xyz;uint8_t[4] _padding0;",
    );
    log.message(b'F', b"pair:float a;float b;");
    log.message(
        b'F',
        b"airspeed:uint64_t timestamp;float true_airspeed_m_s;pair[2] pairs;",
    );
    log.message(b'F', b"vehicle_air_data:uint64_t timestamp;float rho;");
    log.message(b'P', b"\x0cint32_t A\x01\0\0\0");
    log.subscribe(0, 7, "vehicle_angular_velocity");
    log.subscribe(0, 3, "airspeed");
    log.subscribe(0, 4, "vehicle_air_data");
    log.subscribe(1, 5, "vehicle_air_data");
    for k in 0..50u64 {
        let time = 2_000_000 + 4000 * k;
        log.data(7, time, &[0.1, k as f32, -0.1]);
        if k % 25 == 0 {
            log.data(3, time + 1000, &[20.0 + k as f32, 1.0, 2.0, 3.0, 4.0]);
            log.data(4, time, &[1.2]);
            log.data(5, time, &[1.1]);
            log.message(b'L', b"6\0\0\0\0\0\0\0\0text");
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
fn topics_keep_their_own_times() {
    let maneuver = read(&log(), None).unwrap();
    assert_eq!(
        maneuver.len(),
        52,
        "50 times of the rates, two of the airspeed between"
    );
    assert_eq!(maneuver.time()[..3], [2.0, 2.001, 2.004]);
    let there = |name: &str| {
        let values = &maneuver.channels()[name].values;
        values.iter().filter(|value| !value.is_nan()).count()
    };
    assert_eq!((there("q"), there("V_true"), there("rho")), (50, 2, 2));
    assert_eq!(maneuver.channels()["q"].values[2], 1.0);
    assert_eq!(maneuver.channels()["V_true"].values[1], 20.0);
    assert_eq!(
        maneuver.channels()["rho"].unit.dimension.to_string(),
        "kg/m^3"
    );
    // the same, whatever the sender says it is
    let again = read_mapped(&log(), Format::Csv, None, &Limits::default()).unwrap();
    assert_eq!(again.digest(), maneuver.digest());
}

#[test]
fn a_mapping_names_instances_and_elements() {
    let channels = r#""rho": {"from": "vehicle_air_data_1.rho", "unit": "kg/m^3", "between": "held"},
        "same": {"from": "vehicle_air_data[1].rho", "unit": "kg/m^3"},
        "rates": {"from": "vehicle_angular_velocity.xyz", "unit": "rad/s"},
        "b": {"from": "airspeed.pairs[1].b", "unit": "-", "time": {"offset": -0.001}}"#;
    let text = format!(r#"{{"channels": {{{channels}}}}}"#);
    let maneuver = read(&log(), Some(&text)).unwrap();
    let names: Vec<&String> = maneuver.channels().keys().collect();
    assert_eq!(names, ["rho", "same", "rates_1", "rates_2", "rates_3", "b"]);
    assert_eq!(
        maneuver.len(),
        50,
        "with its offset the airspeed is on the axis of the rates"
    );
    assert_eq!(maneuver.channels()["b"].values[25], 4.0);
    assert_eq!(maneuver.channels()["rho"].values[24], f64::from(1.1f32));
    assert!(maneuver.channels()["same"].values[24].is_nan());

    let one = r#"{"time": {"from": "airspeed.timestamp", "unit": "us"},
        "channels": {"V": {"from": "airspeed.true_airspeed_m_s", "unit": "m/s"}}}"#;
    assert_eq!(read(&log(), Some(one)).unwrap().time(), [2.001, 2.101]);

    let refused = |from: &str, expected: &str| {
        let text = format!(r#"{{"channels": {{"a": {{"from": "{from}", "unit": "-"}}}}}}"#);
        let error = read(&log(), Some(&text)).unwrap_err();
        assert_eq!(error.faults()[0].pointer, "/channels/a/from");
        assert!(error.to_string().contains(expected), "{error}");
    };
    refused(
        "air_speed.rho",
        "no messages 'air_speed'; 'airspeed' is near",
    );
    refused(
        "airspeed.rho",
        "airspeed has no field 'rho'; it has timestamp, true_airspeed_m_s",
    );
    refused("vehicle_air_data[2].rho", "vehicle_air_data[1]");
}

#[test]
fn a_log_without_the_usual_says_what_it_has() {
    let mut log = Writer::new();
    log.message(b'F', b"odd:uint64_t timestamp;float x;");
    log.subscribe(0, 1, "odd");
    log.data(1, 5, &[1.0]);
    let error = read(&log.0, None).unwrap_err();
    assert_eq!(error.faults()[0].code, code::MAPPING_NEEDED);
    assert!(error.to_string().ends_with("It has odd"), "{error}");
}

#[test]
fn a_log_that_breaks_off_is_read_up_to_there() {
    let bytes = log();
    let whole = read(&bytes, None).unwrap();
    let cut = read(&bytes[..bytes.len() - 5], None).unwrap();
    assert_eq!(cut.len(), whole.len() - 1);
    let mut padded = bytes.clone();
    padded.extend([0; 4096]);
    assert_eq!(read(&padded, None).unwrap().digest(), whole.digest());

    // behind damage reading goes on at a synchronisation message
    let mut damaged = bytes.clone();
    damaged.extend([9, 9, 9, 1, 2, 3]);
    assert_eq!(places(read(&damaged, None)), ["damaged_file "]);
    let mut mended = Writer(damaged);
    mended.message(b'S', &[0x2f, 0x73, 0x13, 0x20, 0x25, 0x0c, 0xbb, 0x12]);
    mended.data(7, 9_000_000, &[0.0, 77.0, 0.0]);
    let mended = read(&mended.0, None).unwrap();
    assert_eq!(mended.channels()["q"].values.last(), Some(&77.0));
}

#[test]
fn data_that_were_appended_are_read() {
    let mut bytes = log();
    let whole = read(&bytes, None).unwrap().len();
    // cut off inside a message, and more behind it
    bytes.extend([200, 0, b'D', 1, 2]);
    let offset = bytes.len() as u64;
    let mut log = Writer(bytes);
    log.data(7, 8_000_000, &[0.0, 5.0, 0.0]);
    let flags = 16 + 3 + 8;
    log.0[flags] = 1;
    log.0[flags + 8..flags + 16].copy_from_slice(&offset.to_le_bytes());
    assert_eq!(read(&log.0, None).unwrap().len(), whole + 1);
    log.0[flags] = 2;
    let error = read(&log.0, None).unwrap_err();
    assert!(error.to_string().contains("newer reader"), "{error}");
}

#[test]
fn what_a_log_says_of_itself_does_not_grow() {
    let refused = |definitions: &[&str], expected: &str| {
        let mut log = Writer::new();
        for definition in definitions {
            log.message(b'F', definition.as_bytes());
        }
        log.subscribe(0, 1, "a");
        log.data(1, 5, &[1.0]);
        let error = read(&log.0, None).unwrap_err();
        assert_eq!(error.faults()[0].code, code::DAMAGED_FILE);
        assert!(error.to_string().contains(expected), "{error}");
    };
    refused(&["a:uint64_t timestamp;a next;"], "nested too deep");
    refused(
        &["a:uint64_t timestamp;b[60000] x;", "b:c[60000] x;", "c:"],
        "longer than a message",
    );
    refused(
        &["a:uint64_t timestamp;float[9999999] x;"],
        "longer than a message",
    );
    let long = format!(
        "a:uint64_t timestamp;uint8_t[20000] {};",
        "x".repeat(40_000)
    );
    refused(&[&long], "a field has a longer name than any");
    let prefix = format!("a:uint64_t timestamp;b[2000] {};", "x".repeat(200));
    let nested = format!("b:uint8_t {};", "y".repeat(200));
    refused(&[&prefix, &nested], "a field has a longer name than any");
    let nothing = format!("b:{}", "char[0] a;".repeat(6000));
    refused(
        &["a:uint64_t timestamp;b[6000] x;", &nothing],
        "longer than a message",
    );
    refused(&["a:float x;"], "no timestamp");
    refused(&["a:uint64_t timestamp;nothing x;"], "not defined");
    refused(&[], "no definition");
    let only_a_header = b"ULog\x01\x12\x35\x01\0\0\0\0\0\0\0\0";
    assert_eq!(places(read(only_a_header, None)), ["damaged_file "]);
}

#[test]
fn definitions_together_have_a_bound() {
    let mut log = Writer::new();
    log.message(b'F', format!("b:{}", "char[0] a;".repeat(6000)).as_bytes());
    for number in 0..40 {
        let name = format!("a{number}");
        log.message(
            b'F',
            format!("{name}:uint64_t timestamp;b[9] x;").as_bytes(),
        );
        log.subscribe(0, number, &name);
    }
    log.data(1, 5, &[1.0]);
    let error = read(&log.0, None).unwrap_err();
    assert!(
        error.to_string().contains("more fields than any"),
        "{error}"
    );
}

/// One bit of one time is wrong: its message is left out, not all those behind it.
#[test]
fn one_wrong_time_costs_one_message() {
    let mut log = Writer::new();
    log.message(
        b'F',
        b"airspeed:uint64_t timestamp;float true_airspeed_m_s;",
    );
    log.message(b'F', b"unused:uint64_t timestamp;float x;");
    log.subscribe(0, 1, "airspeed");
    log.subscribe(0, 2, "unused");
    for k in 0..1000u64 {
        let wrong = if k == 10 { 1 << 60 } else { 0 };
        log.data(1, (4000 * k) | wrong, &[k as f32]);
        log.data(2, 4000 * (k % 2), &[0.0]);
    }
    let reading = read_recording(&log.0, Format::Unstated, None, None, &Limits::default());
    let Reading {
        maneuver, findings, ..
    } = reading.unwrap();
    assert_eq!((maneuver.len(), maneuver.duration()), (999, 3.996));
    assert_eq!(maneuver.channels()["V_true"].values[10], 11.0);
    let [finding] = &findings[..] else {
        panic!("{findings:#?}");
    };
    assert_eq!((&*finding.code, finding.count), ("out_of_order", 1));
    assert!(
        finding.message.contains("1 of airspeed"),
        "{}",
        finding.message
    );
}

#[test]
fn no_damage_to_a_log_panics() {
    let good = log();
    let good = &good[..700];
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
