//! SENSOR.CSV of a FlySight 2: records of several kinds in one text, each kind with its columns, units and times.
//!
//! The layout is that which the device's firmware writes (github.com/flysight/flysight-2-firmware, `log.c`): lines of `$COL` and
//! `$UNIT` for each kind, `$DATA`, then records that begin with their kind. TRACK.CSV has one kind alone, and is a table of
//! text like any other. Stamps have milliseconds, coarser than the fastest rate: records of one stamp are spread evenly up to
//! the next.

mod clock;
mod scan;

use super::text::decode;
use super::{IngestError, Limits, groups, mapping::Mapping, reading::Reading};

/// How such a file begins.
const BEGINS: &[u8] = b"$FLYS,";
/// Bytes in which its header ends.
const LONGEST_HEADER: usize = 20_000;

/// Whether it is a file of a FlySight 2 with several kinds of records.
pub(super) fn is_of_several(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(LONGEST_HEADER)];
    let end = memchr::memmem::find(head, b"$DATA").unwrap_or(head.len());
    let kinds = memchr::memmem::find_iter(&head[..end], b"$COL,").take(2);
    bytes.starts_with(BEGINS) && kinds.count() == 2
}

/// Reads all channels; or those that a mapping names as `IMU.wx`, as it says.
///
/// # Errors
/// A record has not the cells that its kind has; or there is more than the limits allow.
pub(super) fn read(
    bytes: &[u8],
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    let (groups, findings) = scan::scan(decode(bytes)?, limits)?;
    let mut reading = groups::read(groups, mapping, limits)?;
    reading.findings.splice(0..0, findings);
    Ok(reading)
}

#[cfg(test)]
mod tests {
    use super::super::fault::places;
    use super::*;

    const FILE: &str = "$FLYS,1\n$VAR,DEVICE_ID,00\n$COL,BARO,time,pressure,temperature\n$UNIT,BARO,s,Pa,deg C\n\
        $COL,IMU,time,wx,ax,temperature\n$UNIT,IMU,s,deg/s,g,deg C\n$COL,TIME,time,tow,week\n$UNIT,TIME,s,s,\n$DATA\n\
        $IMU,10.000,1.0,0.01,25\n$BARO,10.001,90000,20\n$IMU,10.000,2.0,0.02,25\n$IMU,99.001,9,9,9\n$IMU,10.002,3.0,0.03,25\n\
        $TIME,10.003,316515.000,2311\n$IMU,10.002,4.0,,25\n$BARO,10.101,90010,20\n$IMU,10.004,5";

    fn known(reading: &Reading, name: &str) -> Vec<(f64, f64)> {
        let times = reading.maneuver.time().iter().copied();
        let values = reading.maneuver.channels()[name].values.iter().copied();
        times
            .zip(values)
            .filter(|(_, value)| !value.is_nan())
            .collect()
    }

    #[test]
    fn each_kind_keeps_its_times() {
        assert!(is_of_several(FILE.as_bytes()));
        let reading = read(FILE.as_bytes(), None, &Limits::default()).unwrap();
        assert_eq!(
            known(&reading, "pressure"),
            [(10.001, 90000.0), (10.101, 90010.0)]
        );
        let rates = known(&reading, "wx");
        let degrees: Vec<f64> = rates
            .iter()
            .map(|(_, rate)| rate.to_degrees().round())
            .collect();
        assert_eq!(degrees, [1.0, 2.0, 3.0, 4.0]);
        // two of one stamp, as far apart as the next stamp says; behind the last as before
        let times: Vec<f64> = rates
            .iter()
            .map(|(time, _)| (time * 1e6).round() / 1e6)
            .collect();
        assert_eq!(times, [10.0, 10.001, 10.002, 10.003]);
        assert_eq!(known(&reading, "ax").len(), 3, "a cell is empty");
        let codes: Vec<&str> = reading
            .findings
            .iter()
            .map(|finding| finding.code.as_str())
            .collect();
        for code in ["repeated_time", "out_of_order", "incomplete_line"] {
            assert!(codes.contains(&code), "{codes:?}");
        }
    }

    #[test]
    fn a_mapping_names_kinds_and_columns() {
        let text = "[channels]\nq = {from = \"IMU.wx\", unit = \"deg/s\"}\n";
        let mapping = Mapping::from_toml(text).unwrap();
        let reading = read(FILE.as_bytes(), Some(&mapping), &Limits::default()).unwrap();
        assert_eq!(reading.maneuver.len(), 4);
    }

    #[test]
    fn what_does_not_fit_names_its_line() {
        let long = FILE.replace("$BARO,10.001,90000,20", "$BARO,10.001,90000,20,1");
        let refused = read(long.as_bytes(), None, &Limits::default());
        assert_eq!(places(refused), ["row_length /rows/11"]);
        let limits = Limits {
            max_samples: 3,
            ..Limits::default()
        };
        assert_eq!(
            places(read(FILE.as_bytes(), None, &limits)),
            ["too_many_samples "]
        );
    }

    #[test]
    fn kinds_are_described_once_and_are_as_few_as_columns() {
        let twice = FILE.replace("$DATA", "$COL,IMU,time,wz\n$DATA");
        let refused = read(twice.as_bytes(), None, &Limits::default());
        assert_eq!(places(refused), ["duplicate_channel /rows/9"]);
        let of = |kinds: usize| {
            let kinds: String = (0..kinds).map(|kind| format!("$COL,K{kind}\n")).collect();
            FILE.replace("$DATA", &format!("{kinds}$DATA"))
        };
        let limits = Limits {
            max_columns: 100,
            ..Limits::default()
        };
        // the file has ten columns itself
        assert!(read(of(80).as_bytes(), None, &limits).is_ok());
        let refused = read(of(91).as_bytes(), None, &limits);
        assert_eq!(places(refused), ["too_many_columns "]);
    }

    #[test]
    fn no_damage_panics() {
        let good = FILE.as_bytes();
        for at in 0..good.len() {
            let _ = read(&good[..at], None, &Limits::default());
            for with in [0, b',', b'\n', b'$', b'-', 0xff] {
                let mut damaged = good.to_vec();
                damaged[at] = with;
                let _ = read(&damaged, None, &Limits::default());
            }
        }
    }
}
