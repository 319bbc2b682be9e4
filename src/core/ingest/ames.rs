//! Files in the format of NASA Ames with one row a sample (FFI 1001), of which ICARTT is a kind: what research aircraft record.
//!
//! S. E. Gaines and R. S. Hipskind, "Format Specification for Data Exchange" (1998). The header says for every variable its
//! name with a unit, what a number is multiplied by, and what stands for no value: it becomes a mapping for the rows.

use super::{
    IngestError, Limits, csv, encoding,
    label::Label,
    mapping::{Draft, Mapping},
    name::{Names, is_identifier},
    note,
    reading::Reading,
    units::RecordedUnit,
};

/// Of one variable of the rows.
struct Variable<'a> {
    name: &'a str,
    unit: &'a str,
    factor: f64,
    missing: f64,
}

/// What the lines before the rows say.
struct Header<'a> {
    lines: usize,
    time: &'a str,
    variables: Vec<Variable<'a>>,
}

/// The line that says how many variables there are, from 0.
const COUNT: usize = 9;

/// Whether a file begins with the number of lines of its header and the number of the format.
pub(super) fn is_ames(bytes: &[u8]) -> bool {
    let line = bytes
        .split(|byte| *byte == b'\n')
        .next()
        .unwrap_or_default();
    let line = String::from_utf8_lossy(&line[..line.len().min(40)]);
    let mut numbers = cells(&line).into_iter();
    let lines = numbers.next().and_then(|lines| lines.parse().ok());
    lines.is_some_and(|lines: usize| lines > COUNT) && numbers.next() == Some("1001")
}

/// Reads a file as its header says, or, with a mapping, as a table of text.
///
/// # Errors
/// Those of a table of text.
pub(super) fn read(
    bytes: &[u8],
    charset: Option<&str>,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    let decoded = encoding::text(bytes, charset)?;
    let header = Header::of(&decoded.text).filter(|_| mapping.is_none());
    let Some(header) = header else {
        return csv::read(bytes, charset, mapping, limits);
    };
    let (said, left_out) = header.mapping(limits);
    let mut reading = csv::read(bytes, charset, Some(&said), limits)?;
    let remedy = "write a mapping to have them";
    reading.findings.extend(note::left_out(&left_out, remedy));
    Ok(reading)
}

fn cells(line: &str) -> Vec<&str> {
    let cells = line.split(|c: char| c == ',' || c.is_whitespace());
    cells.filter(|cell| !cell.is_empty()).collect()
}

impl<'a> Header<'a> {
    /// `None` where the lines are not those of such a header.
    fn of(text: &'a str) -> Option<Self> {
        let count = cells(text.lines().next()?).first()?.parse().ok()?;
        let lines: Vec<&str> = text.lines().take(count).collect();
        if lines.len() < count {
            return None;
        }
        let variables: usize = lines.get(COUNT)?.trim().parse().ok()?;
        let mut at = COUNT + 1;
        let mut numbers = || {
            let mut numbers: Vec<f64> = Vec::new();
            while numbers.len() < variables {
                let more = cells(lines.get(at)?).into_iter().map(str::parse::<f64>);
                numbers.extend(more.collect::<Result<Vec<f64>, _>>().ok()?);
                at += 1;
            }
            (numbers.len() == variables).then_some(numbers)
        };
        let (factors, missing) = (numbers()?, numbers()?);
        let said = lines.get(at..at + variables)?;
        // the last line may have names as short as those of channels, and a line of units below them
        let is_short = |line: &&&str| {
            let cells = cells(line);
            cells.len() == variables + 1 && cells.iter().all(|cell| is_identifier(cell))
        };
        let is_of_names = |line: &&&str| is_short(line) && !is_of_units(line);
        let short = lines[at + variables..]
            .iter()
            .rev()
            .take(3)
            .find(is_of_names);
        let short = short.map_or(Vec::new(), |line| cells(line));
        let variable = |at: usize| {
            let (name, unit) = named(said[at]);
            Variable {
                name: short.get(at + 1).copied().unwrap_or(name),
                unit,
                factor: factors[at],
                missing: missing[at],
            }
        };
        Some(Self {
            lines: count,
            time: named(lines.get(COUNT - 1)?).1,
            variables: (0..variables).map(variable).collect(),
        })
    }

    /// The mapping of its rows, and the variables whose unit is not known.
    fn mapping(&self, limits: &Limits) -> (Mapping, Vec<(String, String)>) {
        let mut names = Names::new(limits);
        let mut draft = Draft::default();
        let time = RecordedUnit::parse_time(self.time).map_or("s", |_| self.time);
        draft.skipped(self.lines);
        draft.time("(:,1)", time, None);
        let mut left_out = Vec::new();
        for (at, variable) in self.variables.iter().enumerate() {
            let unit = match variable.unit {
                "" => "-",
                unit => unit,
            };
            match RecordedUnit::parse(unit) {
                Ok(_) => {
                    let name = names.take_like(variable.name);
                    let from = format!("(:,{})", at + 2);
                    draft.scaled(&name, &from, unit, variable.factor, variable.missing);
                }
                Err((_, why)) => left_out.push((format!("'{}'", variable.name), why)),
            }
        }
        (draft.mapping(), left_out)
    }
}

fn is_of_units(line: &str) -> bool {
    let units = cells(line);
    units
        .iter()
        .skip(1)
        .all(|unit| RecordedUnit::parse(unit).is_ok())
}

/// Name and unit of a variable: `Pitch rate [deg/s]`, `q, deg/s, pitch rate`, `Time [seconds]; since midnight`.
fn named(said: &str) -> (&str, &str) {
    let said = said.split(';').next().unwrap_or_default().trim();
    if let Some((name, rest)) = said.split_once('[')
        && let Some((unit, _)) = rest.split_once(']')
    {
        return (name.trim(), unit.trim());
    }
    let mut fields = said.split(',').map(str::trim);
    let label = Label::split(fields.next().unwrap_or_default());
    match fields.next() {
        Some(unit) => (label.name, if is_none(unit) { "" } else { unit }),
        None => (label.name, label.unit),
    }
}

/// Whether a word says that there is no unit.
fn is_none(unit: &str) -> bool {
    let words = ["none", "unitless", "dimensionless", "n/a", "#", "number"];
    words.iter().any(|word| unit.eq_ignore_ascii_case(word))
}
