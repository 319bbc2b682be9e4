//! What is found in a file that is looked at.

use super::super::{
    IngestError, Limits, cell::Decimal, encoding, lines::Line, mapping::Mapping, reading::Reading,
};
use super::{draft, read::read, table::Table, titles::Titles};

/// What is found in a table of text.
#[derive(Clone, PartialEq, Debug)]
pub struct Inspection {
    /// How it is written: encoding, delimiter, decimal mark, the lines of the header.
    pub written: Vec<(&'static str, String)>,
    /// Every column.
    pub columns: Vec<InspectedColumn>,
    /// The recording, or why it is none.
    pub reading: Result<Reading, IngestError>,
    /// A mapping that takes every column that can be one; `?` where a choice is to be made.
    pub draft: Mapping,
}

/// A column of a table as it stands there.
#[derive(Clone, PartialEq, Debug)]
pub struct InspectedColumn {
    /// The title over it; empty where there is none.
    pub title: String,
    /// The unit that the file says, in whatever place.
    pub unit: String,
    /// The first cell that says something.
    pub first: String,
}

/// Looks at a table of text.
///
/// # Errors
/// There is no table in it.
pub(in super::super) fn inspect(
    bytes: &[u8],
    charset: Option<&str>,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Inspection, IngestError> {
    let decoded = encoding::text(bytes, charset)?;
    let table = Table::find(&decoded.text, mapping, limits)?;
    let titles = &table.described.titles;
    Ok(Inspection {
        written: written(&table, decoded.encoding),
        columns: columns(titles),
        reading: read(bytes, charset, mapping, limits),
        draft: draft::of(titles, None, limits),
    })
}

pub(super) fn columns(titles: &Titles) -> Vec<InspectedColumn> {
    let column = |at: usize| InspectedColumn {
        title: titles.title(at).to_string(),
        unit: titles.any_label(at).unit.to_string(),
        first: titles.first_said(at).unwrap_or_default().trim().to_string(),
    };
    (0..titles.width).map(column).collect()
}

fn written(table: &Table, encoding: &str) -> Vec<(&'static str, String)> {
    let Titles { names, units, .. } = &table.described.titles;
    let decimal = match (table.marks.decimal, table.marks.has_thousands) {
        (Decimal::Point, false) => "points",
        (Decimal::Point, true) => "points, commas between thousands",
        (Decimal::Comma, false) => "commas",
        (Decimal::Comma, true) => "commas, points between thousands",
    };
    let line = |row: &Option<(Line, Vec<&str>)>| {
        row.as_ref()
            .map_or("no line of their own".to_string(), |(line, _)| {
                format!("line {}", line.number)
            })
    };
    let mut written = vec![
        ("encoding", encoding.to_string()),
        ("cells separated by", table.delimiter.name().to_string()),
        ("decimals", decimal.to_string()),
        ("names", line(names)),
        ("units", line(units)),
    ];
    let described: Vec<String> = table
        .descriptions
        .iter()
        .map(|line| line.number.to_string())
        .collect();
    if !described.is_empty() {
        written.push(("other lines of the header", described.join(", ")));
    }
    if let Some(name) = table.described.recognised {
        written.push(("recognised as", name.to_string()));
    }
    written
}
