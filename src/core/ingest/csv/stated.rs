//! What a file says of its sampling in the lines before its table: an interval, or a rate.

use super::super::cell::{self, Decimal, Marks};
use super::super::units::RecordedUnit;
use super::sample::Looked;

/// What lines say, where numbers have decimal points, and where they have decimal commas: seconds.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Announced {
    points: Option<f64>,
    commas: Option<f64>,
    /// Whether a comma may be in the number.
    has_comma: bool,
    line: usize,
}

/// A step between samples, and the line that says it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Stated {
    /// Seconds; `None` where a comma in it can be read in two ways.
    pub(super) step: Option<f64>,
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
pub(super) fn step(lines: &[Looked]) -> Option<Announced> {
    let (points, commas) = (of(lines, Decimal::Point), of(lines, Decimal::Comma));
    let (_, at) = points.or(commas)?;
    Some(Announced {
        points: points.map(|(step, _)| step),
        commas: commas.map(|(step, _)| step),
        has_comma: lines[at].line.text.contains(','),
        line: lines[at].line.number,
    })
}

/// The step, and which line says it first.
fn of(lines: &[Looked], decimal: Decimal) -> Option<(f64, usize)> {
    let mut all = lines.iter().enumerate().filter_map(|(at, looked)| {
        let step = of_line(looked.line.text, decimal)?;
        (step.is_finite() && step > 0.0).then_some((step, at))
    });
    let first = all.next()?;
    all.all(|(step, _)| is_same(step, first.0)).then_some(first)
}

fn is_same(one: f64, other: f64) -> bool {
    (one / other - 1.0).abs() < 1e-6
}

impl Announced {
    /// As it is meant where the numbers of the table have this decimal mark; `None` where they do not tell.
    pub(super) fn stated(self, decimal: Option<Decimal>) -> Stated {
        let step = match (self.points, self.commas, decimal) {
            (Some(points), Some(commas), _) if is_same(points, commas) => Some(points),
            (Some(_), Some(commas), Some(Decimal::Comma)) => Some(commas),
            (Some(_), Some(_), None) if self.has_comma => None,
            (points, commas, _) => points.or(commas),
        };
        let line = self.line;
        Stated { step, line }
    }
}

fn of_line(line: &str, decimal: Decimal) -> Option<f64> {
    let said = line.trim_start_matches(|c: char| "#%/!; \t\"".contains(c));
    per_sample(said, decimal).or_else(|| {
        let at = said.find([':', '=', '\t', ';', ','])?;
        let (label, rest) = said.split_at(at);
        let letters = label.chars().filter(char::is_ascii_alphabetic);
        let label: String = letters.map(|letter| letter.to_ascii_lowercase()).collect();
        let cells = rest[1..].split(['\t', ';']).map(str::trim);
        let cells: Vec<&str> = cells.filter(|cell| !cell.is_empty()).collect();
        let (first, others) = cells.split_first()?;
        let is_one = others.iter().all(|other| other == first) || label != OF_LABVIEW;
        let (value, unit) = number(first.trim_matches('"'), decimal)?;
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
fn per_sample(line: &str, decimal: Decimal) -> Option<f64> {
    let before = line.trim_end().strip_suffix("/sample")?;
    let (value, unit) = number(before, decimal)?;
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

/// A number and the word behind it. The other mark than the decimal one may stand between thousands.
fn number(text: &str, decimal: Decimal) -> Option<(f64, &str)> {
    let text = text.trim();
    let is_of_number = |c: char| c.is_ascii_digit() || "+-.,eE".contains(c);
    let end = text.find(|c| !is_of_number(c)).unwrap_or(text.len());
    let digits = text[..end].trim_end_matches([',', '.']);
    let other = match decimal {
        Decimal::Point => ',',
        Decimal::Comma => '.',
    };
    // 0,020 has no thousands
    let is_below_one = digits.trim_start_matches(['+', '-']).starts_with('0');
    if digits.contains(other) && is_below_one {
        return None;
    }
    let marks = Marks {
        decimal,
        has_thousands: true,
    };
    Some((cell::number(digits, marks)?, text[end..].trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_near(found: Option<f64>, expected: Option<f64>) -> bool {
        match (found, expected) {
            (Some(found), Some(expected)) => (found - expected).abs() < 1e-12,
            (found, expected) => found == expected,
        }
    }

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
            let found = |decimal| of_line(line, decimal);
            let found = found(Decimal::Point).or_else(|| found(Decimal::Comma));
            assert!(is_near(found, expected), "{line}: {found:?}");
        }
    }

    /// By the rule of thousands: groups of three digits. Each with decimal points and with decimal commas.
    #[test]
    fn marks_between_thousands_are_no_decimals() {
        for (line, points, commas) in [
            ("Sample rate: 1,000 Hz", Some(0.001), Some(1.0)),
            ("Sample rate: 1.000 Hz", Some(1.0), Some(0.001)),
            ("Sample rate: 1,000.0 Hz", Some(0.001), None),
            ("Sample rate: 1.000,0 Hz", None, Some(0.001)),
            ("Sample rate: 1,000,000 Hz", Some(1e-6), None),
            ("Sample interval: 0,020 s", None, Some(0.02)),
            ("Sample interval: 0.020 s", Some(0.02), None),
            ("Sample rate: 12,5 Hz", None, Some(0.08)),
            ("Sample rate: 1,2,3 Hz", None, None),
        ] {
            let found = [Decimal::Point, Decimal::Comma].map(|decimal| of_line(line, decimal));
            let is_right = is_near(found[0], points) && is_near(found[1], commas);
            assert!(is_right, "{line}: {found:?}");
        }
    }
}
