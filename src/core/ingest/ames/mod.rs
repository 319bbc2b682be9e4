//! Files in the format of NASA Ames with one row a sample (FFI 1001), of which ICARTT is a kind: what research aircraft record.
//!
//! S. E. Gaines and R. S. Hipskind, "Format Specification for Data Exchange" (1998). The header says for every variable its
//! name with a unit, what a number is multiplied by, and what stands for no value: it becomes a mapping for the rows.

mod header;
mod words;

use super::{
    IngestError, Inspection, Limits, code, csv, encoding,
    fault::of_file,
    mapping::{Draft, Mapping},
    name::Names,
    note,
    reading::Reading,
    text::quoted,
    units::RecordedUnit,
};
use crate::flight::Fault;
use header::{Broken, Header, Variable, cells};

/// Whether a file begins with the number of lines of its header and the number of the format.
pub(super) fn is_ames(bytes: &[u8]) -> bool {
    let line = bytes
        .split(|byte| *byte == b'\n')
        .next()
        .unwrap_or_default();
    let line = String::from_utf8_lossy(&line[..line.len().min(40)]);
    let mut numbers = cells(&line).into_iter();
    let lines = numbers.next().and_then(|lines| lines.parse().ok());
    lines.is_some_and(|lines: usize| lines > header::COUNT) && numbers.next() == Some("1001")
}

/// Reads a file as its header says, or, with a mapping, as a table of text.
///
/// # Errors
/// Those of a table of text; a header that cannot be read, or says no unit of time.
pub(super) fn read(
    bytes: &[u8],
    charset: Option<&str>,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    if mapping.is_some() {
        return csv::read(bytes, charset, mapping, limits);
    }
    let decoded = encoding::text(bytes, charset)?;
    let header = match Header::of(&decoded.text) {
        Ok(header) => header,
        // numbers alone are a table, which begins in this way by chance
        Err(_) if !header::has_words(&decoded.text) => {
            return csv::read(bytes, charset, mapping, limits);
        }
        Err(broken) => return Err(broken.fault().into()),
    };
    if let Err(fault) = header.unit_of_time() {
        return Err(IngestError::from(fault).with_draft(header.draft(limits).to_json()));
    }
    let Said {
        mapping,
        left_out,
        without_unit,
    } = header.said(limits);
    let mut reading = csv::read(bytes, charset, Some(&mapping), limits)?;
    let remedy = "write a mapping to have them";
    let findings = &mut reading.findings;
    findings.extend(note::left_out(&left_out, remedy));
    findings.extend(note::without_unit(&without_unit));
    Ok(reading)
}

/// Looks at a file as its header says: the draft of a mapping has its factors and missing values.
///
/// # Errors
/// There is no table in it.
pub(super) fn inspect(
    bytes: &[u8],
    charset: Option<&str>,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Inspection, IngestError> {
    let decoded = encoding::text(bytes, charset)?;
    let Ok(header) = Header::of(&decoded.text) else {
        let inspected = csv::inspect(bytes, charset, mapping, limits)?;
        let reading = read(bytes, charset, mapping, limits);
        return Ok(Inspection {
            reading,
            ..inspected
        });
    };
    let draft = header.draft(limits);
    let mut inspected = csv::inspect(bytes, charset, mapping.or(Some(&draft)), limits)?;
    let format = format!("NASA Ames FFI 1001, a header of {} lines", header.lines);
    inspected.written.insert(0, ("format", format));
    if inspected.columns.len() == header.variables.len() + 1 {
        let time = (header.name_of_time(), header.unit_of_time().unwrap_or(""));
        let others = header.variables.iter();
        let others = others.map(|variable| (variable.name, variable.unit.unwrap_or("")));
        let titles = std::iter::once(time).chain(others);
        for (column, (title, unit)) in inspected.columns.iter_mut().zip(titles) {
            (column.title, column.unit) = (title.to_string(), unit.to_string());
        }
    }
    Ok(Inspection {
        reading: read(bytes, charset, mapping, limits),
        draft,
        ..inspected
    })
}

/// What a header makes of its rows.
struct Said {
    mapping: Mapping,
    /// Variables whose unit is not known, and why.
    left_out: Vec<(String, String)>,
    /// Channels whose unit is said nowhere.
    without_unit: Vec<String>,
}

/// What a unit is that must be said.
const ASKED_FOR: &str = "?";

impl Header<'_> {
    /// The unit of time.
    ///
    /// # Errors
    /// The header says none that is known.
    fn unit_of_time(&self) -> Result<&str, Fault> {
        let unit = words::unit_of_time(self.time).or(self.unit_below);
        unit.ok_or_else(|| {
            let message = format!(
                "line {}: {} says no unit of time that is known; write it in brackets, as Time [s], or read the file with a mapping: skip = {}, time = {{from = \"(:,1)\", unit = \"s\"}}, and the channels as (:,2)",
                header::COUNT,
                quoted(self.time),
                self.lines
            );
            of_file(code::TIME_UNIT, message)
        })
    }

    fn name_of_time(&self) -> &str {
        words::named(self.time).0
    }

    fn beginning(&self) -> Draft {
        let mut draft = Draft::default();
        draft.skipped(self.lines);
        draft.time("(:,1)", self.unit_of_time().unwrap_or(ASKED_FOR), None);
        draft
    }

    /// The mapping by which its rows are read.
    fn said(&self, limits: &Limits) -> Said {
        let mut names = Names::new(limits);
        let mut draft = self.beginning();
        let (mut left_out, mut without_unit) = (Vec::new(), Vec::new());
        for (at, variable) in self.variables.iter().enumerate() {
            let unit = variable.unit.unwrap_or("-");
            if let Err((_, why)) = RecordedUnit::parse(unit) {
                left_out.push((quoted(variable.name), why));
                continue;
            }
            let name = names.take_like(variable.name);
            variable.drafted(&mut draft, &name, at, unit);
            if variable.unit.is_none() {
                without_unit.push(name);
            }
        }
        Said {
            mapping: draft.mapping(),
            left_out,
            without_unit,
        }
    }

    /// A mapping that takes every variable, `?` where its unit is to be said.
    fn draft(&self, limits: &Limits) -> Mapping {
        let mut names = Names::new(limits);
        let mut draft = self.beginning();
        for (at, variable) in self.variables.iter().enumerate() {
            let known = variable
                .unit
                .filter(|unit| RecordedUnit::parse(unit).is_ok());
            let name = names.take_like(variable.name);
            variable.drafted(&mut draft, &name, at, known.unwrap_or(ASKED_FOR));
        }
        draft.mapping()
    }
}

impl Variable<'_> {
    /// `at` counts the variables from 0; the first column is time.
    fn drafted(&self, draft: &mut Draft, name: &str, at: usize, unit: &str) {
        let from = format!("(:,{})", at + 2);
        draft.scaled(name, &from, unit, self.factor, &self.missing);
    }
}

impl Broken {
    fn fault(&self) -> Fault {
        let Self { line, why } = self;
        let message = format!(
            "line {line}: the header of NASA Ames (FFI 1001) {why}; mend it, or read the file with a mapping that says how many lines are before the rows: skip = 20, and columns by their numbers, as (:,2)"
        );
        of_file(code::DAMAGED_FILE, message)
    }
}
