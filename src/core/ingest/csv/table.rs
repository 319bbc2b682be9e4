//! A table that was found in a text, and the mapping that says what its columns are.

use std::borrow::Cow;

use super::super::{
    IngestError, Limits,
    cell::{Decimal, Marks},
    code,
    fault::of_file,
    lines::{Line, Lines},
    mapping::{Mapping, Titles as Wanted},
    units::RecordedUnit,
};
use super::{
    decimal,
    delimiter::Delimiter,
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
    pub(super) titles: Titles<'a>,
    /// Lines of the header that have neither names nor units.
    pub(super) descriptions: Vec<Line<'a>>,
    pub(super) rows: Lines<'a>,
    pub(super) mapping: Cow<'a, Mapping>,
    /// The bundled mapping that was recognised.
    pub(super) recognised: Option<&'static str>,
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
        let titles = Titles {
            names: head.names,
            units: head.units,
            first: layout.first,
            width: layout.width,
        };
        let recognised = mapping
            .is_none()
            .then(|| Mapping::recognised(|wanted| titles.has(wanted)))
            .flatten();
        let (recognised, mapping) = match (mapping, recognised) {
            (Some(mapping), _) => (None, Cow::Borrowed(mapping)),
            (None, Some((name, mapping))) => {
                (Some(name), Cow::Owned(without_units_of(&titles, mapping)))
            }
            (None, None) => (None, Cow::Owned(Mapping::default())),
        };
        Ok(Self {
            delimiter: layout.delimiter,
            marks,
            titles,
            descriptions: head.others,
            rows: layout.rows,
            mapping,
            recognised,
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
        let values = |rows: usize| rows.saturating_mul(self.titles.width);
        if limits.samples(rows).is_some() || limits.values(values(rows)).is_some() {
            // lines that are no rows do not count
            rows = self.rows.clone().count();
        }
        let too_much = [limits.samples(rows), limits.values(values(rows))];
        IngestError::refuse(too_much.into_iter().flatten().collect())?;
        Ok(rows)
    }

    pub(super) fn written(&self, plan: &Plan) -> Written<'a> {
        let of_header = [&self.titles.names, &self.titles.units]
            .into_iter()
            .flatten()
            .map(|(line, _)| line.text.trim());
        let described = self.descriptions.iter().map(|line| line.text.trim());
        let time = plan
            .time
            .column()
            .map_or("", |at| self.titles.any_label(at).name);
        let is_mapped = !self.mapping.channels.is_empty() && self.recognised.is_none();
        Written {
            delimiter: self.delimiter,
            marks: self.marks,
            width: self.titles.width,
            header: of_header.chain(described).collect(),
            time: if time.is_empty() || is_mapped {
                "t".to_string()
            } else {
                time.to_string()
            },
            is_cut_off: !self.rows.rest().ends_with(['\n', '\r']),
        }
    }
}

/// A mapping that was only recognised says no unit where the file states one that can be read.
fn without_units_of(titles: &Titles, mapping: &Mapping) -> Mapping {
    let stated = |from: &Wanted| {
        let label = titles.find(from).and_then(|at| titles.label(at)).ok()?;
        Some(label.unit).filter(|unit| !unit.is_empty())
    };
    let mut mapping = mapping.clone();
    let time = &mut mapping.time;
    let of_time = time.from.as_ref().and_then(stated);
    if of_time.is_some_and(|unit| RecordedUnit::parse_time(unit).is_ok()) {
        time.unit.clear();
    }
    for channel in mapping.channels.values_mut() {
        if stated(&channel.from).is_some_and(|unit| RecordedUnit::parse(unit).is_ok()) {
            channel.unit.clear();
        }
    }
    mapping
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
