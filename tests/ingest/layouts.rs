//! Layouts of loggers, simulators and programs: small files of our own making go in without editing.

use std::io::Write;

use flate2::{Compression, write::GzEncoder};
use trimtab_core::flight::{Maneuver, Unit};
use trimtab_core::ingest::{Format, Limits, Mapping, Reading, read_recording};

use crate::common::layouts::{Layout, layouts};

fn read(layout: &Layout, format: Format) -> Maneuver {
    read_bytes(layout, layout.file.as_bytes(), format).maneuver
}

fn read_bytes(layout: &Layout, bytes: &[u8], format: Format) -> Reading {
    let mapping = layout.mapping.map(|text| Mapping::from_toml(text).unwrap());
    let read = read_recording(bytes, format, None, mapping.as_ref(), &Limits::default());
    read.unwrap_or_else(|error| panic!("{}: {error}", layout.name))
}

#[test]
fn files_of_known_layouts_go_in_without_editing() {
    for layout in layouts() {
        let name = layout.name;
        let maneuver = read(&layout, Format::Csv);
        assert_eq!(maneuver.len(), layout.samples, "{name}");
        assert!(
            (maneuver.duration() - layout.duration).abs() < 1e-9,
            "{name}: {} s",
            maneuver.duration()
        );
        let (channel, first, unit) = layout.channel;
        let names: Vec<&String> = maneuver.channels().keys().collect();
        let found = maneuver
            .channels()
            .get(channel)
            .unwrap_or_else(|| panic!("{name}: {names:?}"));
        let expected = Unit::parse(unit).unwrap().to_si(first);
        assert!(
            (found.values[0] - expected).abs() < 1e-12,
            "{name}: {} is not {expected}",
            found.values[0]
        );
        println!(
            "| {name} | {} |",
            if layout.mapping.is_some() {
                "with a mapping by numbers"
            } else {
                "yes"
            }
        );
    }
}

#[test]
fn as_plain_text_they_are_the_same() {
    for layout in layouts() {
        let (csv, text) = (read(&layout, Format::Csv), read(&layout, Format::Ascii));
        assert_eq!(csv.digest(), text.digest(), "{}", layout.name);
    }
}

#[test]
fn packed_or_in_another_encoding_they_are_the_same() {
    for layout in layouts() {
        let plain = read_bytes(&layout, layout.file.as_bytes(), Format::Csv);
        let utf_16: Vec<u8> = "\u{feff}"
            .encode_utf16()
            .chain(layout.file.encode_utf16())
            .flat_map(u16::to_le_bytes)
            .collect();
        for bytes in [layout.file.as_bytes(), &utf_16] {
            let mut packing = GzEncoder::new(Vec::new(), Compression::fast());
            packing.write_all(bytes).unwrap();
            let packed = packing.finish().unwrap();
            let read = read_bytes(&layout, &packed, Format::Unstated);
            assert_eq!(
                read.maneuver.digest(),
                plain.maneuver.digest(),
                "{}",
                layout.name
            );
            assert_eq!(read.findings, plain.findings, "{}", layout.name);
        }
    }
}

#[test]
fn no_damage_to_a_layout_panics() {
    let limits = Limits::default();
    for layout in layouts() {
        let bytes = layout.file.as_bytes();
        for at in (0..bytes.len()).step_by(19) {
            let _ = read_recording(&bytes[..at], Format::Csv, None, None, &limits);
            for with in [0, b'"', b',', b'\n', b'|', b':', b'9', 0xff] {
                let mut damaged = bytes.to_vec();
                damaged[at] = with;
                let _ = read_recording(&damaged, Format::Csv, None, None, &limits);
            }
        }
    }
}
