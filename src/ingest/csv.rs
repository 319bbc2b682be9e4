//! CSV recordings: a header of `name[unit]`, one row a sample, cells separated by commas.

use ::csv::{ByteRecord, ReaderBuilder};
use indexmap::IndexMap;

use crate::flight::{Fault, Maneuver};

use super::{
    IngestError, Limits,
    axis::{TimeAxis, code_of},
    cell::{number, unquote},
    code,
    fault::pointer,
    fault::{CELLS_LISTED, of_file},
    header::{Column, Header},
    text::{decode, line_at, quoted},
};

/// Reads a CSV recording.
///
/// Empty cells and the usual words (nan, na, null, inf in any case) are missing values.
///
/// # Errors
/// Every fault of the header; else the first [`CELLS_LISTED`] faults of rows and cells.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Maneuver, IngestError> {
    let text = decode(bytes)?;
    let (header_line, rows) = split_header(text);
    check_delimiter(header_line)?;
    let width = cells_in(header_line);
    limits.columns(width).map_or(Ok(()), Err)?;
    let labels: Vec<&str> = header_line.split(',').map(unquote).collect();
    let header = Header::parse(&labels, limits)?;

    let extent = Extent::of(rows);
    if extent.rows < 2 {
        let rows = extent.rows;
        let message =
            format!("{rows} row(s) below the header: a maneuver needs at least 2 samples");
        return Err(of_file(code::TOO_FEW_SAMPLES, message).into());
    }
    let too_much = [limits.samples(extent.rows), limits.values(extent.cells)];
    IngestError::refuse(too_much.into_iter().flatten().collect())?;
    // One row of a hundred million cells would cost the reader ten times its bytes.
    if let Some((row, cells)) = extent
        .widest
        .filter(|&(_, cells)| cells > limits.max_columns)
    {
        return Err(row_length(row, None, cells, width).into());
    }
    Rows {
        text,
        header: &header,
        behind: text.len() - rows.len(),
        capacity: extent.cells / width,
    }
    .read()
}

/// The first line that is not blank, and what follows it.
fn split_header(text: &str) -> (&str, &str) {
    let body = text.trim_start();
    let end = body.find(['\n', '\r']).unwrap_or(body.len());
    (body[..end].trim(), &body[end..])
}

fn check_delimiter(header: &str) -> Result<(), Fault> {
    let count = |delimiter: char| header.matches(delimiter).count();
    let others = [(';', "semicolons"), ('\t', "tabs"), ('|', "vertical bars")];
    let found = others
        .into_iter()
        .find(|&(delimiter, _)| count(delimiter) > count(','));
    found.map_or(Ok(()), |(_, name)| {
        Err(of_file(
            code::WRONG_DELIMITER,
            format!(
                "the header's cells are separated by {name}; separate them by commas, with decimal points in the numbers"
            ),
        ))
    })
}

fn cells_in(line: &str) -> usize {
    1 + line.bytes().filter(|&byte| byte == b',').count()
}

/// How much there is, before anything is built from it.
#[derive(Default)]
struct Extent {
    rows: usize,
    cells: usize,
    /// Number (from 1) and cells of the row with the most.
    widest: Option<(usize, usize)>,
}

impl Extent {
    fn of(rows: &str) -> Self {
        let mut extent = Self::default();
        for line in rows.split(['\n', '\r']) {
            if line.trim().is_empty() {
                continue;
            }
            let cells = cells_in(line);
            extent.rows += 1;
            extent.cells += cells;
            if extent.widest.is_none_or(|(_, most)| cells > most) {
                extent.widest = Some((extent.rows, cells));
            }
        }
        extent
    }
}

/// The part of a file below its header.
struct Rows<'a> {
    text: &'a str,
    header: &'a Header,
    /// Where the header's line ends in `text`.
    behind: usize,
    capacity: usize,
}

impl Rows<'_> {
    fn read(self) -> Result<Maneuver, IngestError> {
        let columns = &self.header.columns;
        let mut axis = TimeAxis::new(columns[self.header.time].unit.unit(), self.capacity);
        let mut values: Vec<Vec<f64>> = (0..columns.len())
            .map(|_| Vec::with_capacity(self.capacity))
            .collect();
        let mut faults = Vec::new();
        // No name, unit or number holds a comma, a quote or a line break, so quotes are only trimmed:
        // one forgotten quote must not swallow the rest of the file.
        let mut reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .quoting(false)
            .from_reader(&self.text.as_bytes()[self.behind..]);
        let mut record = ByteRecord::new();
        let mut row = 0;
        while faults.len() < CELLS_LISTED && next(&mut reader, &mut record)? {
            if record.len() == 1 && record[0].trim_ascii().is_empty() {
                continue;
            }
            row += 1;
            if record.len() != columns.len() {
                let line = Some(self.line_of(&record));
                faults.push(row_length(row, line, record.len(), columns.len()));
                axis.skip();
                continue;
            }
            for (at, cell) in record.iter().enumerate() {
                match number(cell) {
                    Some(value) => values[at].push(value),
                    None => {
                        faults.push(self.not_a_number(row, &record, &columns[at], cell));
                        values[at].push(f64::NAN);
                    }
                }
            }
            self.push_time(&mut axis, row, &record, &mut values, &mut faults);
        }
        faults.truncate(CELLS_LISTED);
        IngestError::refuse(faults)?;
        self.maneuver(axis, values)
    }

    fn push_time(
        &self,
        axis: &mut TimeAxis,
        row: usize,
        record: &ByteRecord,
        values: &mut [Vec<f64>],
        faults: &mut Vec<Fault>,
    ) {
        let at = self.header.time;
        let Some(time) = values[at].pop() else {
            return;
        };
        let is_reported = time.is_nan() && number(&record[at]).is_none();
        if is_reported {
            axis.skip();
        } else if let Err(error) = axis.push(time) {
            let message = format!("line {}: {error}", self.line_of(record));
            let place = cell_pointer(row, &self.header.columns[at]);
            faults.push(Fault::new(place, code_of(&error), message));
        }
    }

    fn maneuver(&self, axis: TimeAxis, values: Vec<Vec<f64>>) -> Result<Maneuver, IngestError> {
        let mut channels = IndexMap::with_capacity(values.len());
        for (at, (column, values)) in self.header.columns.iter().zip(values).enumerate() {
            if at != self.header.time {
                channels.insert(column.name.clone(), column.unit.channel(values));
            }
        }
        Maneuver::new(axis.into_seconds(), channels)
            .map_err(|error| of_file(code_of(&error), error.to_string()).into())
    }

    fn not_a_number(&self, row: usize, record: &ByteRecord, column: &Column, cell: &[u8]) -> Fault {
        let message = format!(
            "line {}: {} in column '{}' is not a number; write it like -1.5e-3, or leave the cell empty where there is no value",
            self.line_of(record),
            quoted(String::from_utf8_lossy(cell).trim()),
            column.name
        );
        Fault::new(cell_pointer(row, column), code::NOT_A_NUMBER, message)
    }

    /// The file's line of a record, from 1. Only a fault pays for it.
    fn line_of(&self, record: &ByteRecord) -> usize {
        let bytes = self.text.as_bytes();
        let start = record.position().map_or(0, |position| position.byte());
        let start = self.behind + usize::try_from(start).unwrap_or(usize::MAX - self.behind);
        // The reader counts line ends and blank lines before a record to the record.
        let before = bytes.get(start..).unwrap_or_default();
        let blank = before
            .iter()
            .take_while(|byte| matches!(byte, b'\n' | b'\r'))
            .count();
        line_at(bytes, start + blank)
    }
}

/// Reads the next record; there is no I/O that could fail, but a library may change its mind.
fn next(reader: &mut ::csv::Reader<&[u8]>, record: &mut ByteRecord) -> Result<bool, Fault> {
    reader
        .read_byte_record(record)
        .map_err(|error| of_file(code::WRONG_SHAPE, error.to_string()))
}

fn cell_pointer(row: usize, column: &Column) -> String {
    pointer(["rows", &row.to_string(), &column.name])
}

fn row_length(row: usize, line: Option<usize>, found: usize, expected: usize) -> Fault {
    let line = line.map_or(String::new(), |line| format!("line {line}: "));
    let message = format!(
        "{line}row {row} has {found} cell(s) where the header has {expected} columns; write one cell for each, empty where there is no value"
    );
    Fault::new(
        pointer(["rows", &row.to_string()]),
        code::ROW_LENGTH,
        message,
    )
}

#[cfg(test)]
mod tests {
    use super::super::fault::places;
    use super::*;

    fn read_text(text: &str) -> Result<Maneuver, IngestError> {
        read(text.as_bytes(), &Limits::default())
    }

    fn faults(text: &str) -> Vec<String> {
        places(read_text(text))
    }

    #[test]
    fn reads_names_units_and_missing_values() {
        let text = "\u{feff}\"alpha [deg]\" , t[ms],mach\r\n\r\n180,0, 0.5 \r\n\"\",40,NaN\r\n -Inf ,80,n/a\r\n90,120,1e-3\r\n";
        let maneuver = read_text(text).unwrap();
        assert_eq!(maneuver.time(), [0.0, 0.04, 0.08, 0.12]);
        let alpha = &maneuver.channels()["alpha"];
        assert_eq!(alpha.recorded_unit, "deg");
        assert_eq!(alpha.values[0], std::f64::consts::PI);
        assert!(alpha.values[1].is_nan() && alpha.values[2].is_nan());
        let mach = &maneuver.channels()["mach"];
        assert_eq!((mach.values[0], mach.values[3]), (0.5, 1e-3));
        assert_eq!(mach.recorded_unit, "-");
    }

    #[test]
    fn every_line_ending_is_one() {
        let digest = |text: &str| read_text(text).unwrap().digest();
        let expected = digest("t[s],a\n0,1\n1,2\n");
        for text in [
            "t[s],a\r\n0,1\r\n1,2",
            "t[s],a\r0,1\r1,2\r",
            "\n\nt[s],a\n\n0,1\n   \n1,2\n\n",
            "t[s],a[-]\n0.0,1.0\n1e0,2\n",
        ] {
            assert_eq!(digest(text), expected, "{text:?}");
        }
    }

    #[test]
    fn faults_of_the_whole_file() {
        assert_eq!(faults(""), ["empty_body "]);
        assert_eq!(faults("t[s],a\n"), ["too_few_samples "]);
        assert_eq!(faults("t[s],a\n0,1\n"), ["too_few_samples "]);
        assert_eq!(faults("t[s];a\n0;1\n1;1\n"), ["wrong_delimiter "]);
        assert_eq!(faults("t[s]\ta\n0\t1\n1\t1\n"), ["wrong_delimiter "]);
        assert_eq!(faults("a,b\n1,2\n1,2\n"), ["no_time_column "]);
        let cut = read(
            "t[s],a\n0,1\n1,\u{b0}".as_bytes().split_last().unwrap().1,
            &Limits::default(),
        );
        let fault = &cut.unwrap_err().into_faults()[0];
        assert_eq!(fault.code, code::NOT_UTF8);
        assert!(fault.message.contains("line 3"), "{}", fault.message);
    }

    #[test]
    fn all_faults_of_cells_and_rows_are_reported_with_line_and_column() {
        let text = "t[s],a\n0,1\n\nx,2\n1,y\n2\n1,3\n0.5,4\n,5\n3,1e999\n";
        assert_eq!(
            faults(text),
            [
                "not_a_number /rows/2/t",
                "not_a_number /rows/3/a",
                "row_length /rows/4",
                "time_not_increasing /rows/6/t",
                "time_missing /rows/7/t",
                "not_a_number /rows/8/a",
            ]
        );
        let error = read_text(text).unwrap_err();
        let message = |at: usize| error.faults()[at].message.as_str();
        assert!(
            message(0).starts_with("line 4: 'x' in column 't'"),
            "{}",
            message(0)
        );
        assert!(
            message(2).starts_with("line 6: row 4 has 1 cell(s)"),
            "{}",
            message(2)
        );
    }

    #[test]
    fn at_most_twenty_faults_of_cells_are_listed() {
        let rows: String = (0..100).map(|k| format!("{k},x,y,z\n")).collect();
        let listed = faults(&format!("t[s],a,b,c\n{rows}"));
        assert_eq!(listed.len(), CELLS_LISTED);
        assert_eq!(listed[19], "not_a_number /rows/7/b");
    }

    #[test]
    fn limits_are_named() {
        let limits = Limits {
            max_columns: 3,
            max_samples: 4,
            max_values: 8,
            max_name_length: 5,
        };
        let refused = |text: &str, code: &str, bound: &str| {
            let error = read(text.as_bytes(), &limits).unwrap_err();
            assert_eq!(error.faults()[0].code, code);
            assert!(error.to_string().contains(bound), "{error}");
        };
        refused("t[s],a,b,c\n", code::TOO_MANY_COLUMNS, "max_columns = 3");
        refused(
            "t[s],a\n1,1\n2,1\n3,1\n4,1\n5,1\n",
            code::TOO_MANY_SAMPLES,
            "max_samples = 4",
        );
        refused(
            "t[s],a,b\n1,1,1\n2,1,1\n3,1,1\n",
            code::TOO_MANY_VALUES,
            "max_values = 8",
        );
        refused("t[s],abcdef\n", code::NAME_TOO_LONG, "max_name_length = 5");
        refused("t[s],a\n1,1\n2,1,1,1\n", code::ROW_LENGTH, "row 2 has 4");
    }

    #[test]
    fn a_header_of_a_million_columns_is_refused_at_once() {
        let header = format!("t[s]{}\n0\n1\n", ",a".repeat(1_000_000));
        assert_eq!(faults(&header), ["too_many_columns "]);
    }

    #[test]
    fn a_forgotten_quote_spoils_one_cell_only() {
        assert_eq!(
            faults("t[s],a\n0,\"1\n1,2\n2,3\n"),
            ["not_a_number /rows/1/a"]
        );
    }
}
