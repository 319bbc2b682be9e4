//! Workbooks of Excel (`.xlsx`, ECMA-376): the first sheet with a table, as the text that Excel would save of it.
//!
//! The crate `calamine` was weighed: it reads all strings of a workbook before anything bounds them, makes a dense range of
//! what may be one cell in the last corner, and brings a dozen crates. Of a sheet, four elements are needed.

mod damage;
mod sheet;
mod stamp;
mod strings;
mod styles;
mod xml;

use super::{
    IngestError, Limits, code,
    fault::of_file,
    packed::Zip,
    text::{quoted, short_message},
};
use crate::flight::Fault;
use damage::damaged;
use sheet::Look;
use strings::Strings;
use styles::Styles;
use xml::{Event, Events, attribute};

/// What the text of a table is encoded in.
pub(super) const CHARSET: &str = "utf-8";

/// The first sheet that has a table, as text with commas between its cells.
///
/// # Errors
/// The workbook is damaged, unpacks to more than the limit, or has no table.
pub(super) fn table(bytes: &[u8], limits: &Limits) -> Result<String, IngestError> {
    let mut workbook = Workbook {
        archive: Zip::of(bytes)?,
        room: limits.max_bytes,
    };
    let outline = workbook
        .part("xl/workbook.xml")?
        .ok_or_else(|| damaged("it has no outline"))?;
    let relations = workbook
        .part("xl/_rels/workbook.xml.rels")?
        .unwrap_or_default();
    let strings = workbook.part("xl/sharedStrings.xml")?.unwrap_or_default();
    let styles = workbook.part("xl/styles.xml")?.unwrap_or_default();
    let look = Look {
        strings: Strings::read(&strings),
        styles: Styles::read(&styles),
        has_dates_from_1904: has_dates_from_1904(&outline),
    };
    let mut tried = Vec::new();
    for (name, part) in sheets(&outline, &relations) {
        let Some(sheet) = workbook.part(&part)? else {
            continue;
        };
        if let Some(text) = sheet::to_csv(&sheet, &look, limits)? {
            return Ok(text);
        }
        tried.push(quoted(&name));
    }
    let message = format!(
        "the workbook has no sheet with a table: a row of names and two rows of numbers or more; it has {}",
        short_message(&tried.join(", "))
    );
    Err(of_file(code::TOO_FEW_SAMPLES, message).into())
}

struct Workbook<'a> {
    archive: Zip<'a>,
    /// Bytes that may still be unpacked.
    room: usize,
}

impl Workbook<'_> {
    /// The text of a part; `None` where there is no such part.
    fn part(&mut self, name: &str) -> Result<Option<String>, Fault> {
        let Some(entry) = self.archive.find(name) else {
            return Ok(None);
        };
        let bytes = self.archive.unpack(entry, self.room)?;
        self.room -= bytes.len();
        let text = String::from_utf8(bytes);
        text.map(Some)
            .map_err(|_| damaged(&format!("{} is not UTF-8", quoted(name))))
    }
}

fn has_dates_from_1904(outline: &str) -> bool {
    Events::of(outline).any(|event| match event {
        Event::Open {
            name: "workbookPr",
            attributes,
            ..
        } => {
            matches!(attribute(attributes, "date1904"), Some("1" | "true"))
        }
        _ => false,
    })
}

/// Names of sheets with the parts that they are in.
fn sheets(outline: &str, relations: &str) -> Vec<(String, String)> {
    let target = |id: &str| {
        Events::of(relations).find_map(|event| match event {
            Event::Open {
                name: "Relationship",
                attributes,
                ..
            } if attribute(attributes, "Id") == Some(id) => attribute(attributes, "Target"),
            _ => None,
        })
    };
    let mut sheets = Vec::new();
    for event in Events::of(outline) {
        let Event::Open {
            name: "sheet",
            attributes,
            ..
        } = event
        else {
            continue;
        };
        let name = xml::text(attribute(attributes, "name").unwrap_or_default());
        let target = attribute(attributes, "id").and_then(target);
        let part = match target {
            Some(target) => match target.strip_prefix('/') {
                Some(whole) => whole.to_string(),
                None => format!("xl/{target}"),
            },
            None => format!("xl/worksheets/sheet{}.xml", sheets.len() + 1),
        };
        sheets.push((name, part));
        if sheets.len() > MOST_SHEETS {
            break;
        }
    }
    sheets
}

/// Sheets that are looked through for a table.
const MOST_SHEETS: usize = 100;

#[cfg(test)]
mod tests;
