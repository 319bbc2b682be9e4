//! TDMS files; `recordings/make_tdms.py` says what is in each.

use trimtab_core::flight::Maneuver;
use trimtab_core::ingest::{Format, IngestError, Limits, Mapping, Reading, code, read_recording};

use crate::common::repository;

fn bytes(name: &str) -> Vec<u8> {
    let path = repository::path(&format!("tests/ingest/recordings/{name}.tdms"));
    std::fs::read(path).expect("a recording")
}

fn read(bytes: &[u8], mapping: Option<&Mapping>) -> Result<Reading, IngestError> {
    read_recording(bytes, Format::Unstated, None, mapping, &Limits::default())
}

fn reading(name: &str) -> Reading {
    read(&bytes(name), None).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The values that there are, in degrees.
fn degrees(maneuver: &Maneuver, name: &str) -> Vec<f64> {
    let values = maneuver.channels()[name].values.iter();
    let known = values.filter(|value| !value.is_nan());
    known
        .map(|value| (value.to_degrees() * 1e9).round() / 1e9)
        .collect()
}

#[test]
fn channels_say_their_units_and_times() {
    for name in ["times", "stamps"] {
        let Reading { maneuver, .. } = reading(name);
        for (time, expected) in maneuver.time().iter().zip([0.0, 0.04, 0.08, 0.12, 0.16]) {
            assert!((time - expected).abs() < 1e-9, "{name}: {time}");
        }
        assert_eq!(degrees(&maneuver, "alpha"), [1.5, 2.5, 3.5, 4.5], "{name}");
        assert_eq!(
            degrees(&maneuver, "q"),
            [10.0, -20.0, 30.0, -40.0, 50.0],
            "{name}"
        );
    }
    let on = &reading("stamps").maneuver.channels()["on"].values.clone();
    assert_eq!(on[..], [1.0, 0.0, 1.0, 0.0, 1.0]);
}

#[test]
fn groups_of_several_rates_are_one_recording() {
    let Reading {
        maneuver, findings, ..
    } = reading("waveforms");
    assert_eq!(degrees(&maneuver, "alpha"), [1.5, 2.5, 3.5, 4.5]);
    assert_eq!(
        degrees(&maneuver, "Pitch_Rate"),
        [10.0, -20.0, 30.0, -40.0, 50.0]
    );
    assert_eq!(
        maneuver.len(),
        6,
        "one of the slow times is one of the fast"
    );
    let mass = &maneuver.channels()["mass"].values;
    assert_eq!((mass[1], mass[4]), (100.0, 99.5));
    let left_out = findings.iter().find(|finding| finding.code == "left_out");
    let message = &left_out.unwrap().message;
    assert!(
        message.contains("'Fuel/phase' (it does not hold numbers)"),
        "{message}"
    );
}

#[test]
fn values_of_a_device_are_scaled_and_rows_of_the_other_order_read() {
    let Reading { maneuver, .. } = reading("daqmx");
    assert_eq!(degrees(&maneuver, "alpha"), [1.5, 2.5, 3.5, 4.5, 5.5]);
    assert_eq!(degrees(&maneuver, "q"), [-19.5, -9.5, 0.5, 10.5, 20.5]);
    let Reading { maneuver, .. } = reading("rows");
    assert_eq!(
        maneuver.channels()["q"].values,
        [10.0, -20.0, 30.0, -40.0, 50.0]
    );
    assert!(maneuver.channels()["alpha"].values[2].is_nan());
}

#[test]
fn a_mapping_names_groups_and_channels() {
    let text = r#"{"channels": {"q": {"from": "IMU.Pitch_Rate_deg_s", "unit": "rad/s"}, "m": {"from": "mass", "unit": "lb", "between": "held"}}}"#;
    let mapping = Mapping::from_json(text).unwrap();
    let Reading { maneuver, .. } = read(&bytes("waveforms"), Some(&mapping)).unwrap();
    assert_eq!(maneuver.channels()["q"].values[2], -20.0);
    assert!(maneuver.channels()["m"].values[5] < 46.0);
    let missing = Mapping::from_json(&text.replace("mass", "weight")).unwrap();
    let error = read(&bytes("waveforms"), Some(&missing)).unwrap_err();
    assert_eq!(error.faults()[0].code, code::UNKNOWN_SOURCE);
    assert!(error.to_string().contains("Fuel.mass [kg]"), "{error}");
}

#[test]
fn a_file_that_breaks_off_is_read_up_to_there() {
    let whole = bytes("waveforms");
    let cut = read(&whole[..whole.len() - 30], None).unwrap().maneuver;
    assert_eq!(degrees(&cut, "alpha"), [1.5, 2.5], "the first segment");
    let error = read(&whole[..60], None).unwrap_err();
    assert_eq!(error.faults()[0].code, code::DAMAGED_FILE);
    let index = read(b"TDSh\x0e\0\0\0", None).unwrap_err();
    assert!(
        index.to_string().contains("send the .tdms file itself"),
        "{index}"
    );
}

#[test]
fn no_damage_to_a_tdms_file_panics() {
    let limits = Limits {
        max_columns: 100,
        max_samples: 1000,
        max_values: 10_000,
        ..Limits::default()
    };
    for name in ["waveforms", "times", "stamps", "daqmx", "rows"] {
        let good = bytes(name);
        for at in 0..good.len() {
            let mut damaged: Vec<Vec<u8>> = vec![good[..at].to_vec()];
            damaged.extend([0, 1, 0x7f, 0xff].map(|with| {
                let mut bytes = good.clone();
                bytes[at] = with;
                bytes
            }));
            for bytes in damaged {
                let read = read_recording(&bytes, Format::Unstated, None, None, &limits);
                if let Err(error) = read {
                    assert!(!error.faults().is_empty());
                }
            }
        }
    }
}

/// One waveform of three doubles whose axis is in a unit, as NI's "TDMS File Format Internal Structure" has it.
fn waveform(unit: &str) -> Vec<u8> {
    let text = |text: &str| [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat();
    let said = |name: &str, value: &str| {
        [text(name), 0x20u32.to_le_bytes().to_vec(), text(value)].concat()
    };
    let increment = [
        text("wf_increment"),
        10u32.to_le_bytes().to_vec(),
        40f64.to_le_bytes().to_vec(),
    ];
    // doubles in one dimension, three of them
    let index = [20u32, 10, 1, 3, 0].map(u32::to_le_bytes).concat();
    let meta = [
        1u32.to_le_bytes().to_vec(),
        text("/'Air'/'alpha'"),
        index,
        3u32.to_le_bytes().to_vec(),
        increment.concat(),
        said("wf_xunit_string", unit),
        said("unit_string", "deg"),
    ]
    .concat();
    let raw = [1.5f64, 2.5, 3.5].map(f64::to_le_bytes).concat();
    let lengths = [(meta.len() + raw.len()) as u64, meta.len() as u64].map(u64::to_le_bytes);
    let head = [0xeu32, 4713].map(u32::to_le_bytes).concat();
    [&b"TDSm"[..], &head, &lengths.concat(), &meta, &raw].concat()
}

#[test]
fn steps_of_a_waveform_are_in_the_unit_of_its_axis() {
    for (unit, expected) in [("", 40.0), ("s", 40.0), ("ms", 0.04)] {
        let Reading { maneuver, .. } = read(&waveform(unit), None).unwrap();
        let step = maneuver.time()[1] - maneuver.time()[0];
        assert!((step - expected).abs() < 1e-12, "{unit}: {step}");
        assert_eq!(degrees(&maneuver, "alpha"), [1.5, 2.5, 3.5]);
    }
    // a spectrum has no times
    assert!(read(&waveform("Hz"), None).is_err());
}
