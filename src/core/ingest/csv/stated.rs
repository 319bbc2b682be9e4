//! What a file says of its sampling in the lines before its table: an interval, or a rate.

use super::super::units::RecordedUnit;
use super::sample::Looked;

/// A step between samples, and the line that says it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Stated {
    /// Seconds.
    pub(super) step: f64,
    /// The number of the line.
    pub(super) line: usize,
}

const INTERVALS: [&str; 9] = [
    "interval",
    "sampleinterval",
    "samplinginterval",
    "samplingperiod",
    "sampleperiod",
    "sampletime",
    "timestep",
    "timeinterval",
    "deltax",
];
const RATES: [&str; 10] = [
    "samplerate",
    "samplingrate",
    "samplefrequency",
    "samplingfrequency",
    "updaterate",
    "outputrate",
    "datarate",
    "rate",
    "messrate",
    "abtastrate",
];
/// LabVIEW's of a channel, in the unit of `X_Dimension`, which is time.
const OF_LABVIEW: &str = "deltax";
const OF_RATES: [(&str, f64); 9] = [
    ("", 1.0),
    ("hz", 1.0),
    ("khz", 1e3),
    ("s/s", 1.0),
    ("sps", 1.0),
    ("samples/s", 1.0),
    ("samples/sec", 1.0),
    ("samples/second", 1.0),
    ("1/s", 1.0),
];

/// The step that lines say; `None` where they say none, or several.
pub(super) fn step(lines: &[Looked]) -> Option<Stated> {
    let mut all = lines.iter().filter_map(|looked| {
        let step = of_line(looked.line.text)?;
        let line = looked.line.number;
        (step.is_finite() && step > 0.0).then_some(Stated { step, line })
    });
    let first = all.next()?;
    all.all(|other| (other.step / first.step - 1.0).abs() < 1e-6)
        .then_some(first)
}

fn of_line(line: &str) -> Option<f64> {
    let said = line.trim_start_matches(|c: char| "#%/!; \t\"".contains(c));
    per_sample(said).or_else(|| {
        let at = said.find([':', '=', '\t', ';', ','])?;
        let (label, rest) = said.split_at(at);
        let letters = label.chars().filter(char::is_ascii_alphabetic);
        let label: String = letters.map(|letter| letter.to_ascii_lowercase()).collect();
        let cells = rest[1..].split(['\t', ';']).map(str::trim);
        let cells: Vec<&str> = cells.filter(|cell| !cell.is_empty()).collect();
        let (first, others) = cells.split_first()?;
        let is_one = others.iter().all(|other| other == first) || label != OF_LABVIEW;
        let (value, unit) = number(first.trim_matches('"'))?;
        match () {
            () if !is_one => None,
            () if RATES.contains(&label.as_str()) => Some(1.0 / (value * of_rate(unit)?)),
            () if label == OF_LABVIEW && unit.is_empty() => Some(value),
            () if INTERVALS.contains(&label.as_str()) => in_seconds(value, unit),
            () => None,
        }
    })
}

/// `20 msec/sample`.
fn per_sample(line: &str) -> Option<f64> {
    let before = line.trim_end().strip_suffix("/sample")?;
    let (value, unit) = number(before)?;
    in_seconds(value, unit)
}

fn in_seconds(value: f64, unit: &str) -> Option<f64> {
    let unit = RecordedUnit::parse_time(unit).ok()?.unit();
    Some(unit.to_si(value))
}

fn of_rate(unit: &str) -> Option<f64> {
    let unit = unit.to_ascii_lowercase();
    let known = OF_RATES.iter().find(|(name, _)| *name == unit);
    known.map(|(_, factor)| *factor)
}

/// A number and the word behind it.
fn number(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let is_of_number = |c: char| c.is_ascii_digit() || "+-.,eE".contains(c);
    let end = text.find(|c| !is_of_number(c)).unwrap_or(text.len());
    let value = text[..end].trim_end_matches([',', '.']).replace(',', ".");
    Some((value.parse().ok()?, text[end..].trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_and_rates_are_steps() {
        for (line, expected) in [
            ("Interval=\t0.02 s", Some(0.02)),
            ("Sample rate;50", Some(0.02)),
            ("//  Update Rate: 50.0Hz", Some(0.02)),
            ("# Sampling frequency = 2 kHz", Some(0.0005)),
            ("Delta_X\t0.020000\t0.020000\t", Some(0.02)),
            ("Delta_X\t0,020000\t0,020000", Some(0.02)),
            ("Delta_X\t0.02\t0.01", None),
            ("20 msec/sample", Some(0.02)),
            ("Sampling interval: 20", None),
            ("Rate of climb: 5 m/s", None),
            ("Interval: 3 deg", None),
            ("Rate: 5 deg/s", None),
        ] {
            let found = of_line(line);
            let is_same = match (found, expected) {
                (Some(found), Some(expected)) => (found - expected).abs() < 1e-12,
                (found, expected) => found == expected,
            };
            assert!(is_same, "{line}: {found:?}");
        }
    }
}
