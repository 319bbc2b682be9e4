//! A file packed with gzip (RFC 1952), of one member or of several.

use flate2::bufread::MultiGzDecoder;

use super::super::Limits;
use super::bounded::read;
use crate::flight::Fault;

/// The file, and its name where the header says it.
pub(super) fn unpack(bytes: &[u8], limits: &Limits) -> Result<(Vec<u8>, Option<String>), Fault> {
    let mut unpacking = MultiGzDecoder::new(bytes);
    let unpacked = read(&mut unpacking, limits.max_bytes, "gzip file")?;
    let name = unpacking.header().and_then(|header| header.filename());
    let name = name.map(|name| String::from_utf8_lossy(name).into_owned());
    Ok((unpacked, name))
}

/// `flight.csv` of `flight.csv.gz`.
pub(super) fn name_within(name: &str) -> Option<String> {
    name.strip_suffix(".gz").map(str::to_string)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::{Compression, GzBuilder, write::GzEncoder};

    use super::super::super::{Format, code, fault::places, read as read_recording};
    use super::*;

    const CSV: &[u8] = b"t[s],q[deg/s]\n0,1\n0.1,2\n";

    fn packed(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn a_packed_recording_is_the_recording() {
        let limits = Limits::default();
        let plain = read_recording(CSV, Format::Csv, &limits).unwrap();
        let twice = packed(&packed(CSV));
        // as a logger that appends writes it
        let members = [packed(&CSV[..14]), packed(&CSV[14..])].concat();
        for bytes in [packed(CSV), twice, members] {
            for format in [Format::Csv, Format::Unstated] {
                let read = read_recording(&bytes, format, &limits).unwrap();
                assert_eq!(read.digest(), plain.digest());
            }
        }
        let json =
            br#"{"time":{"unit":"s","step":0.1},"channels":{"q":{"unit":"deg/s","values":[1,2]}}}"#;
        let mut named = GzBuilder::new()
            .filename("flight.json")
            .write(Vec::new(), Compression::fast());
        named.write_all(json).unwrap();
        let named = named.finish().unwrap();
        for bytes in [named, packed(json)] {
            let read = read_recording(&bytes, Format::Unstated, &limits).unwrap();
            assert_eq!(read.digest(), plain.digest());
        }
    }

    #[test]
    fn bombs_and_damage_are_refused_by_name() {
        let limits = Limits {
            max_bytes: 1000,
            ..Limits::default()
        };
        let bomb = packed(&vec![b'1'; 1_000_000]);
        assert!(bomb.len() < 2000);
        let refused = |bytes: &[u8]| places(read_recording(bytes, Format::Csv, &limits));
        assert_eq!(refused(&bomb), [format!("{} ", code::UNPACKED_TOO_LARGE)]);
        assert_eq!(
            refused(&packed(&bomb)),
            [format!("{} ", code::UNPACKED_TOO_LARGE)]
        );
        let good = packed(CSV);
        assert_eq!(refused(&good[..good.len() - 9]), ["damaged_file "]);
        let mut four = good.clone();
        for _ in 0..3 {
            four = packed(&four);
        }
        assert_eq!(refused(&four), ["format_not_read "]);
        for at in 0..good.len() {
            for with in [0, 0xff, good[at] ^ 1] {
                let mut damaged = good.clone();
                damaged[at] = with;
                let _ = read_recording(&damaged, Format::Csv, &limits);
            }
        }
    }
}
