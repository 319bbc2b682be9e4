//! Maneuvers to files, for download. Values are SI, and so are the units in the file.
//!
//! What is written reads back to the same numbers, bit for bit.

use std::iter::once;

use indexmap::IndexMap;
use serde::Serialize;

use super::csv_writer::CsvWriter;
use crate::flight::{Channel, Maneuver, Unit};

#[derive(Serialize)]
struct Document<'a> {
    time: Samples<'a>,
    channels: IndexMap<&'a str, Samples<'a>>,
}

#[derive(Serialize)]
struct Samples<'a> {
    unit: String,
    values: &'a [f64],
}

impl<'a> Samples<'a> {
    fn of(channel: &'a Channel) -> Self {
        Self {
            unit: Unit::si_name(&channel.recorded_unit),
            values: &channel.values,
        }
    }
}

/// The maneuver as a JSON recording, missing values as `null`.
///
/// # Errors
/// Those of the serializer; none is known.
pub fn to_json(maneuver: &Maneuver) -> serde_json::Result<String> {
    let channels = maneuver.channels().iter();
    serde_json::to_string(&Document {
        time: Samples {
            unit: "s".to_string(),
            values: maneuver.time(),
        },
        channels: channels
            .map(|(name, channel)| (name.as_str(), Samples::of(channel)))
            .collect(),
    })
}

/// The maneuver, or those channels of it that `keep` says, as a CSV recording; missing values are
/// empty cells.
pub fn to_csv(maneuver: &Maneuver, keep: impl Fn(&str) -> bool) -> String {
    let channels = maneuver.channels().iter();
    let kept: Vec<(&String, &Channel)> = channels.filter(|(name, _)| keep(name)).collect();
    let titles = kept
        .iter()
        .map(|(name, channel)| title(name, &Unit::si_name(&channel.recorded_unit)));
    let mut csv = CsvWriter::with_header(once(TIME.to_string()).chain(titles));
    for (k, time) in maneuver.time().iter().enumerate() {
        csv.number(*time);
        for (_, channel) in &kept {
            csv.number(channel.values[k]);
        }
        csv.end_row();
    }
    csv.finish()
}

/// The maneuver as a recorder writes it: in the recorded units, with as many digits as sensors have.
pub fn to_csv_as_recorded(maneuver: &Maneuver) -> String {
    let channels = maneuver.channels().iter();
    let titles = channels.map(|(name, channel)| title(name, &channel.recorded_unit));
    let mut csv = CsvWriter::with_header(once(TIME.to_string()).chain(titles));
    for (k, time) in maneuver.time().iter().enumerate() {
        csv.text(&rounded(*time));
        for channel in maneuver.channels().values() {
            csv.text(&rounded(channel.unit.from_si(channel.values[k])));
        }
        csv.end_row();
    }
    csv.finish()
}

const TIME: &str = "t[s]";

fn title(name: &str, unit: &str) -> String {
    format!("{name}[{unit}]")
}

/// To six decimals, without the minus of a zero; nothing, if it is not finite.
fn rounded(value: f64) -> String {
    if value.is_finite() {
        ((value * 1e6).round() / 1e6 + 0.0).to_string()
    } else {
        String::new()
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::super::{Format, Limits, read};
    use super::*;

    fn reread(text: &str, format: Format) -> Maneuver {
        read(text.as_bytes(), format, &Limits::default()).unwrap()
    }

    /// A CSV recording of random size, units and numbers, of any magnitude and with holes.
    fn random_csv(random: &mut ChaCha8Rng, units: &[&str]) -> String {
        let columns = random.random_range(1..6);
        let mut text = String::from("t[s]");
        for k in 0..columns {
            let unit = units[random.random_range(0..units.len())];
            text.push_str(&format!(",c{k}[{unit}]"));
        }
        let mut time = random.random_range(-1e3..1e3);
        for _ in 0..random.random_range(2..40) {
            time += random.random_range(1e-3..1.0);
            text.push_str(&format!("\n{time}"));
            for _ in 0..columns {
                text.push(',');
                if random.random_range(0..5) > 0 {
                    let value: f64 = random.random_range(-1.0..1.0);
                    let magnitude = random.random_range(-290..290);
                    text.push_str(&format!("{:e}", value * 10f64.powi(magnitude)));
                }
            }
        }
        text
    }

    #[test]
    fn csv_to_maneuver_to_json_to_maneuver_is_the_same_content() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        for _ in 0..200 {
            let si = random_csv(&mut random, &["rad", "m/s", "-", "K", "rad/s^2"]);
            let read_in = reread(&si, Format::Csv);
            let json = reread(&to_json(&read_in).unwrap(), Format::Json);
            assert_eq!(json.digest(), read_in.digest(), "{si}");
            let csv = reread(&to_csv(&read_in, |_| true), Format::Csv);
            assert_eq!(csv.digest(), read_in.digest(), "{si}");
        }
    }

    #[test]
    fn units_become_si_and_values_stay_bit_for_bit() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let units = [
            "deg",
            "kt",
            "degC",
            "%",
            "hPa",
            "deg/s",
            "ft",
            "g",
            "slug/ft^3",
        ];
        let bits = |maneuver: &Maneuver| -> Vec<Vec<u64>> {
            let channels = maneuver.channels().values();
            channels
                .map(|channel| channel.values.iter().map(|v| v.to_bits()).collect())
                .collect()
        };
        for _ in 0..200 {
            let recorded = reread(&random_csv(&mut random, &units), Format::Csv);
            let json = reread(&to_json(&recorded).unwrap(), Format::Json);
            let csv = reread(&to_csv(&recorded, |_| true), Format::Csv);
            assert_eq!(bits(&json), bits(&recorded));
            assert_eq!(csv.digest(), json.digest());
            for (name, channel) in json.channels() {
                let dimension = recorded.channels()[name].unit.dimension;
                assert_eq!(
                    (channel.unit.scale, channel.unit.dimension),
                    (1.0, dimension)
                );
            }
        }
    }

    #[test]
    fn a_filter_keeps_the_channels_named() {
        let maneuver = reread("t[s],a[deg],b\n0,180,\n1,0,2\n", Format::Csv);
        let kept = to_csv(&maneuver, |name| name == "b");
        assert_eq!(kept, "t[s],b[-]\n0.0,\n1.0,2.0\n");
        let all = to_csv(&maneuver, |_| true);
        assert!(all.starts_with("t[s],a[rad],b[-]\n0.0,3.141592653589793,\n"));
    }
}
