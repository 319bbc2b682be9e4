//! Pages of lists: a cursor says behind what the next page begins, so that a list stays in order
//! while entries are added.

use sqlx::any::AnyRow;

use super::error::StoreError;

/// Some entries, and the cursor of the page behind them; `None` is the only end.
#[derive(Clone, PartialEq, Debug)]
pub struct Page<T> {
    pub entries: Vec<T>,
    pub next_cursor: Option<String>,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("it is not one that a list has answered with")]
pub struct BadCursor;

impl<T> Page<T> {
    /// From rows, one more than `limit` where there are so many; see [`readable`].
    pub(super) fn readable(
        rows: &[AnyRow],
        limit: usize,
        read: impl Fn(&AnyRow) -> Result<T, StoreError>,
        cursor: impl Fn(&T) -> String,
    ) -> Self {
        let more = rows.len() > limit;
        let entries = readable(&rows[..rows.len().min(limit)], read);
        let next_cursor = entries.last().filter(|_| more).map(cursor);
        Self {
            entries,
            next_cursor,
        }
    }

    /// From one entry more than `limit` asks for, where there are so many.
    pub(crate) fn new(mut entries: Vec<T>, limit: usize, cursor: impl Fn(&T) -> String) -> Self {
        let more = entries.len() > limit;
        entries.truncate(limit);
        let next_cursor = if more {
            entries.last().map(cursor)
        } else {
            None
        };
        Self {
            entries,
            next_cursor,
        }
    }
}

/// The entries of a list. One that cannot be read is left out, and said in the log: it takes no others down.
pub(super) fn readable<T>(
    rows: &[AnyRow],
    read: impl Fn(&AnyRow) -> Result<T, StoreError>,
) -> Vec<T> {
    let entries = rows.iter().map(read);
    let entries = entries
        .map(|entry| entry.inspect_err(|error| tracing::error!(%error, "left out of a list")));
    entries.filter_map(Result::ok).collect()
}

/// The number of rows to fetch for [`Page::new`].
pub(super) fn one_more(limit: usize) -> i64 {
    i64::try_from(limit).unwrap_or(i64::MAX - 1) + 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_last_page_has_no_cursor() {
        let page = |entries: &[u8]| Page::new(entries.to_vec(), 2, u8::to_string);
        assert_eq!(page(&[1, 2, 3]).next_cursor.as_deref(), Some("2"));
        assert_eq!(page(&[1, 2, 3]).entries, [1, 2]);
        assert_eq!(page(&[1, 2]).next_cursor, None);
        assert_eq!(page(&[]).next_cursor, None);
    }
}
