//! A table for the terminal.

use std::ops::RangeBounds;

use comfy_table::presets::UTF8_BORDERS_ONLY;
use comfy_table::{CellAlignment, Table};

/// A table whose columns `numeric` are aligned on the right.
pub(super) fn bordered<'h>(
    header: impl IntoIterator<Item = &'h str>,
    rows: impl IntoIterator<Item = Vec<String>>,
    numeric: impl RangeBounds<usize>,
) -> String {
    let mut table = Table::new();
    table
        .load_style(UTF8_BORDERS_ONLY)
        .set_header(header.into_iter().collect::<Vec<_>>())
        .add_rows(rows);
    for (number, column) in table.column_iter_mut().enumerate() {
        if numeric.contains(&number) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table.to_string()
}
