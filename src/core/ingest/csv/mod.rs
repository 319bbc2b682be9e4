//! CSV recordings: a header of `name[unit]`, one row a sample.
//!
//! Cells are separated by commas, semicolons or tabs; with the latter two, numbers may have decimal commas. Units may
//! stand in a row of their own below the header. Time is a number with a unit, or a time stamp. Lines that begin with
//! `#` or `%` are comments. What of this a file has is found out from the file; what can be read in two ways is refused.

mod decimal;
mod delimiter;
mod dialect;
mod mapped;
mod rows;
mod unit_row;

use crate::flight::{Fault, Maneuver};

use dialect::Dialect;

use super::{
    IngestError, Limits,
    cell::{Decimal, number, unquote},
    code,
    fault::of_file,
    header::{Header, Titles},
    lines::{Line, Lines},
    mapping::Mapping,
    text::decode,
};

/// Reads a CSV recording, as its header says or as a mapping does.
///
/// Empty cells and the usual words (nan, na, null, inf in any case) are missing values.
///
/// # Errors
/// What separates the cells, or a decimal mark, is not clear; else every fault of the header; else the first 20 faults
/// of rows and cells.
pub(super) fn read(
    bytes: &[u8],
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Maneuver, IngestError> {
    let mut rows = Lines::of(decode(bytes)?);
    let (header, delimiter) = header_line(&mut rows)?;
    let ends_with_delimiter = header.text.trim_end_matches(' ').ends_with(delimiter);
    let mut dialect = Dialect {
        delimiter,
        ends_with_delimiter,
        decimal: Decimal::Point,
    };
    let width = dialect.count(header.text);
    limits.columns(width).map_or(Ok(()), Err)?;
    let names: Vec<&str> = dialect.cells(header.text).map(unquote).collect();
    dialect.decimal = decimal::of_rows(rows.clone(), delimiter)?;
    if names
        .iter()
        .all(|name| number(name, dialect.decimal).is_some_and(f64::is_finite))
    {
        return Err(no_header(header).into());
    }

    let units = Some(dialect.first_row(rows.clone(), width))
        .filter(|cells| unit_row::is_one(&names, cells, dialect.decimal));
    if units.is_some() {
        rows.next();
    }
    let first = dialect.first_row(rows.clone(), width);
    let titles = Titles {
        names,
        units,
        first,
    };
    let header = match mapping {
        Some(mapping) => mapped::header(mapping, &titles, limits)?,
        None => Header::parse(&titles, limits)?,
    };
    let values = Extent::of(rows.clone(), &dialect).values(limits, width)?;
    rows::read(rows, &dialect, &header, values / width)
}

/// The header and its delimiter. A line `sep=;` before it is no header, it says the delimiter.
fn header_line<'a>(lines: &mut Lines<'a>) -> Result<(Line<'a>, char), Fault> {
    let nothing = || {
        of_file(
            code::EMPTY_BODY,
            "the file has comments only; a header and rows should follow",
        )
    };
    let first = lines.next().ok_or_else(nothing)?;
    let Some(declared) = delimiter::declared(first) else {
        return Ok((first, delimiter::of_header(first)?));
    };
    Ok((lines.next().ok_or_else(nothing)?, declared))
}

fn no_header(line: Line) -> Fault {
    let message = format!(
        "line {} has numbers where the header should be; begin with a line of names and units, as t[s],alpha[deg], and without # before it",
        line.number
    );
    of_file(code::NO_TIME_COLUMN, message)
}

/// How much there is, before anything is built from it.
#[derive(Default)]
struct Extent {
    rows: usize,
    cells: usize,
}

impl Extent {
    fn of(rows: Lines, dialect: &Dialect) -> Self {
        rows.fold(Self::default(), |extent, line| Self {
            rows: extent.rows + 1,
            cells: extent.cells + dialect.count(line.text),
        })
    }

    /// How many values there are, cells beyond the header's left out: they are a fault of their row.
    fn values(&self, limits: &Limits, width: usize) -> Result<usize, IngestError> {
        if self.rows < 2 {
            let rows = self.rows;
            let message =
                format!("{rows} row(s) below the header: a maneuver needs at least 2 samples");
            return Err(of_file(code::TOO_FEW_SAMPLES, message).into());
        }
        let values = self.cells.min(self.rows.saturating_mul(width));
        let too_much = [limits.samples(self.rows), limits.values(values)];
        IngestError::refuse(too_much.into_iter().flatten().collect())?;
        Ok(values)
    }
}

#[cfg(test)]
mod tests {
    use super::super::fault::{CELLS_LISTED, places};
    use super::*;

    fn read_text(text: &str) -> Result<Maneuver, IngestError> {
        read(text.as_bytes(), None, &Limits::default())
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
        assert_eq!(faults("t[s]|a\n0|1\n1|1\n"), ["wrong_delimiter "]);
        assert_eq!(faults("t[s];a,b\n0;1\n1;1\n"), ["wrong_delimiter "]);
        assert_eq!(faults("t[s];a\n0;1,000\n1;1,500\n"), ["ambiguous_number "]);
        assert_eq!(faults("# nothing\n% at all"), ["empty_body "]);
        assert_eq!(faults("#t[s],a\n0,1\n1,1\n"), ["no_time_column "]);
        assert_eq!(faults("a,b\n1,2\n1,2\n"), ["no_time_column "]);
        let cut = read(
            "t[s],a\n0,1\n1,\u{b0}".as_bytes().split_last().unwrap().1,
            None,
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
            ..Limits::default()
        };
        let refused = |text: &str, code: &str, bound: &str| {
            let error = read(text.as_bytes(), None, &limits).unwrap_err();
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

    #[test]
    fn logger_files_are_read_as_they_are() {
        let expected = read_text("t[s],alpha[deg],q[deg/s]\n0,1.5,-2\n0.04,,3e-1\n").unwrap();
        for text in [
            "t[s];alpha[deg];q[deg/s]\r\n0;1.5;-2\r\n0.04;;3e-1\r\n",
            "t[s];alpha[deg];q[deg/s]\n0;1,5;-2\n0,04;;3e-1\n",
            "t (s)\talpha (deg)\tq (deg/s)\n0\t1,5\t-2\n0,04\t\t0,3\n",
            "# logger 7\n% 2026-11-21\nt;alpha;q\n\ns;deg;deg/s\n# begin\n0;1.5;-2\n0.04;;0.3\n# end\n",
            "time,alpha,q\n[s],[deg],[deg/s]\n0,1.5,-2\n0.04,nan,0.3\n",
            "sep=;\nt;alpha[deg];q\ns;;(deg/s)\n0;1,5;-2,0\n0,04;;0,3\n",
            "t;alpha;q;\nms;deg;deg/s;\n0;1.5;-2;\n40;;0.3;\n",
            "time,alpha[deg],q[deg/s]\n2026-11-21T12:00:00Z,1.5,-2\n2026-11-21T12:00:00.040Z,,.3\n",
            "Timestamp;alpha;q\nUTC;deg;deg/s\n12:00:00,000;1,5;-2\n12:00:00,040;;0,3\n",
        ] {
            let maneuver = read_text(text).unwrap_or_else(|error| panic!("{text}: {error}"));
            assert_eq!(maneuver.digest(), expected.digest(), "{text}");
        }
    }

    #[test]
    fn faults_of_time_stamps_name_their_line() {
        let text = "time,a\n12:00:00,1\n12:00:00.5,2\n12:00:00.2,3\n\n1.5,4\n12:00,5\n,6\n2026-11-21T12:00:00Z,7\n";
        assert_eq!(
            faults(text),
            [
                "time_not_increasing /rows/3/time",
                "not_a_number /rows/4/time",
                "not_a_number /rows/5/time",
                "time_missing /rows/6/time",
                "not_a_number /rows/7/time",
            ]
        );
        let error = read_text(text).unwrap_err();
        assert!(
            error.faults()[2]
                .message
                .starts_with("line 7: '12:00' in column 'time'"),
            "{error}"
        );
    }

    #[test]
    fn decimal_commas_between_commas_get_the_right_advice() {
        let error = read_text("t[s],a\n0,0,1,5\n0,1,1,7\n").unwrap_err();
        assert!(
            error.to_string().contains("separate cells by semicolons"),
            "{error}"
        );
    }
}
