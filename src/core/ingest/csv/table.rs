//! A table that was found in a text, and the mapping that says what its columns are.

use super::super::{
    IngestError, Limits,
    cell::{Decimal, Marks},
    code,
    fault::of_file,
    lines::{Line, Lines},
    mapping::Mapping,
};
use super::{
    decimal,
    delimiter::Delimiter,
    described::Described,
    head::Head,
    layout::{self, Said},
    plan::Plan,
    titles::Titles,
    trouble::Written,
};
use crate::flight::Fault;

pub(super) struct Table<'a> {
    pub(super) delimiter: Delimiter,
    pub(super) marks: Marks,
    pub(super) described: Described<'a>,
    /// Lines of the header that have neither names nor units.
    pub(super) descriptions: Vec<Line<'a>>,
    pub(super) rows: Lines<'a>,
}

impl<'a> Table<'a> {
    /// Finds the table of a text.
    ///
    /// # Errors
    /// There is none, or it is not clear how it is written.
    pub(super) fn find(
        text: &'a str,
        mapping: Option<&'a Mapping>,
        limits: &Limits,
    ) -> Result<Self, IngestError> {
        let layout = layout::find(text, said(mapping)?)?;
        let widest = layout
            .misfit
            .map_or(0, |(_, cells)| cells)
            .max(layout.width);
        limits.columns(widest).map_or(Ok(()), Err)?;
        let marks = match mapping.and_then(|mapping| mapping.decimal.as_deref()) {
            Some(mark) => Marks {
                decimal: if mark == "," {
                    Decimal::Comma
                } else {
                    Decimal::Point
                },
                has_thousands: true,
            },
            None => decimal::of_rows(&layout.rows, layout.delimiter)?,
        };
        let head = Head::of(layout.above);
        if let Some((line, cells)) = layout.misfit
            && head.names.is_none()
            && cells > 1
            && mapping.is_none()
        {
            return Err(misfit(line, cells, layout.width, layout.delimiter).into());
        }
        let decimal = shown(&marks, layout.delimiter, &layout.first);
        let titles = Titles {
            names: head.names,
            units: head.units,
            first: layout.first,
            width: layout.width,
            stated: layout.announced.map(|announced| announced.stated(decimal)),
        };
        Ok(Self {
            delimiter: layout.delimiter,
            marks,
            described: Described::of(titles, mapping),
            descriptions: head.others,
            rows: layout.rows,
        })
    }

    /// About how many rows there are.
    ///
    /// # Errors
    /// There are more than a recording may have.
    pub(super) fn check_size(&self, limits: &Limits) -> Result<usize, IngestError> {
        let text = self.rows.rest().as_bytes();
        let ends = memchr::memchr_iter(b'\n', text)
            .count()
            .max(memchr::memchr_iter(b'\r', text).count());
        let mut rows = ends + 1;
        let values = |rows: usize| rows.saturating_mul(self.described.titles.width);
        if limits.samples(rows).is_some() || limits.values(values(rows)).is_some() {
            // lines that are no rows do not count
            rows = self.rows.clone().count();
        }
        let too_much = [limits.samples(rows), limits.values(values(rows))];
        IngestError::refuse(too_much.into_iter().flatten().collect())?;
        Ok(rows)
    }

    pub(super) fn written(&self, plan: &Plan) -> Written<'a> {
        let titles = &self.described.titles;
        let of_header = [&titles.names, &titles.units]
            .into_iter()
            .flatten()
            .map(|(line, _)| line.text.trim());
        let described = self.descriptions.iter().map(|line| line.text.trim());
        Written {
            delimiter: self.delimiter,
            marks: self.marks,
            width: titles.width,
            header: of_header.chain(described).collect(),
            time: self.described.name_of_time(plan),
            is_cut_off: !self.rows.rest().ends_with(['\n', '\r']),
        }
    }
}

/// The decimal mark, where the numbers of a table show it.
fn shown(marks: &Marks, delimiter: Delimiter, first: &[Vec<&str>]) -> Option<Decimal> {
    let has_point = |cell: &&str| cell.contains('.') && cell.trim().parse::<f64>().is_ok();
    match marks.decimal {
        Decimal::Comma => Some(Decimal::Comma),
        Decimal::Point => {
            let are_points = delimiter == Delimiter::Byte(b',')
                || marks.has_thousands
                || first.iter().flatten().any(has_point);
            are_points.then_some(Decimal::Point)
        }
    }
}

fn said(mapping: Option<&Mapping>) -> Result<Said, Fault> {
    let Some(mapping) = mapping else {
        return Ok(Said::default());
    };
    let delimiter = match mapping.delimiter.as_deref() {
        None => None,
        Some(sign) => Some(Delimiter::named(sign).ok_or_else(|| {
            let message = "mapping: delimiter is \",\", \";\", \"tab\", \"|\" or \"blanks\"";
            Fault::new("/delimiter", code::INVALID_MAPPING, message)
        })?),
    };
    Ok(Said {
        skip: mapping.skip.unwrap_or(0),
        header: mapping.header,
        delimiter,
    })
}

fn misfit(line: Line, cells: usize, width: usize, delimiter: Delimiter) -> Fault {
    let with_decimal_commas = if delimiter == Delimiter::Byte(b',') && width > cells {
        "; where numbers have decimal commas, separate cells by semicolons"
    } else {
        ""
    };
    let message = format!(
        "line {}: {cells} cell(s) stand above rows of {width} cells, separated by {}: there is no header with a title for each column{with_decimal_commas}; name the columns by their numbers in a mapping, as (:,2)",
        line.number,
        delimiter.name()
    );
    of_file(code::ROW_LENGTH, message)
}
