//! Parquet files, as pandas, pyarrow, DuckDB and polars write tables of numbers.
//!
//! The format is described in the Apache Parquet specification. The crate `parquet` was weighed: without Arrow it takes 60
//! seconds of a core to build, its Zstandard is a C library, and it makes room for a page as large as the page says. Here a
//! page is checked against [`Limits`] before anything is made of it. What it is packed with is left to `snap`, `flate2`,
//! `ruzstd` and `lz4_flex`.
//!
//! A column that is a list, or is written in a way that is not read, is left out; the others are read all the same.

mod chunk;
mod codec;
mod compact;
mod damage;
mod decode;
mod footer;
mod hybrid;
mod page;
mod pandas;
mod schema;
mod values;

use super::{
    Limits,
    columns::{Column, Columns},
};
use crate::flight::Fault;
use chunk::Chunk;
use footer::Footer;
use schema::{Leaf, Why};

/// Reads all columns.
///
/// # Errors
/// The file is damaged, encrypted, or has more in it than the limits allow.
pub(super) fn columns(bytes: &[u8], limits: &Limits) -> Result<Columns, Fault> {
    let footer = Footer::read(bytes, limits)?;
    let mut columns = Columns {
        rows: footer.rows,
        ..Columns::default()
    };
    let mut room = limits.max_bytes;
    for (at, leaf) in footer.leaves.iter().enumerate() {
        match column(bytes, &footer, at, leaf, &mut room) {
            Ok(cells) => columns.list.push(cells),
            Err(Why::NotRead(why)) => columns.left_out.push((leaf.title.clone(), why)),
            Err(Why::Refused(fault)) => return Err(fault),
        }
    }
    let is_index = |column: &Column| footer.pandas.is_index(&column.title);
    columns.list.sort_by_key(|column| !is_index(column));
    Ok(columns)
}

fn column(
    bytes: &[u8],
    footer: &Footer,
    at: usize,
    leaf: &Leaf,
    room: &mut usize,
) -> Result<Column, Why> {
    let (kind, meaning) = leaf.kind.clone()?;
    let duration = footer.pandas.duration_of(&leaf.title);
    let mut chunk = Chunk::new(bytes, leaf, kind, room);
    for group in &footer.groups {
        chunk.read(group.chunks.get(at), group.rows)?;
    }
    let (cells, unit) = meaning.cells(chunk.values, duration);
    Ok(Column {
        title: leaf.title.clone(),
        unit,
        cells,
    })
}
