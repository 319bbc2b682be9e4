//! What a file of LabVIEW (`.lvm`) says before its titles.

use super::super::lines::Line;
use super::{
    sample::Looked,
    sample_rows::{SampleRows, width},
};

/// The line of units in the block that stands before the titles of a file of LabVIEW.
pub(super) fn units_of_labview<'a>(
    lines: &[Looked<'a>],
    rows: &SampleRows,
) -> Option<(Line<'a>, Vec<&'a str>)> {
    let is_of_units = |looked: &&Looked| looked.line.text.starts_with("Y_Unit_Label");
    let looked = lines.iter().rev().find(is_of_units)?;
    let mut cells = rows.titles(looked);
    *cells.first_mut()? = "";
    (width(&cells) <= rows.count).then_some((looked.line, cells))
}
