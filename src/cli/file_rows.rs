//! A recording, or some rows of one, as it is named on the command line.

use std::path::{Path, PathBuf};
use std::str::FromStr;

/// `FILE`, or `FILE:FIRST-LAST` for rows counted from 1, both included.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct FileRows {
    pub file: PathBuf,
    pub rows: Option<[usize; 2]>,
}

impl FromStr for FileRows {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let whole = || Self {
            file: PathBuf::from(text),
            rows: None,
        };
        // a file may be called so
        let Some((file, rows)) = text.rsplit_once(':').filter(|_| !Path::new(text).exists()) else {
            return Ok(whole());
        };
        let Some((first, last)) = rows.split_once('-') else {
            return Ok(whole());
        };
        let number = |text: &str| text.trim().parse::<usize>().ok();
        match (number(first), number(last)) {
            (Some(first), Some(last)) if 1 <= first && first < last => Ok(Self {
                file: PathBuf::from(file),
                rows: Some([first, last]),
            }),
            _ => Err(format!(
                "'{rows}' is not a range of rows; write FIRST-LAST, counted from 1, both included"
            )),
        }
    }
}

impl FileRows {
    /// What it is called in tables.
    pub(super) fn label(&self) -> Option<String> {
        let stem = self.file.file_stem()?.to_string_lossy().into_owned();
        Some(match self.rows {
            Some([first, last]) => format!("{stem}:{first}-{last}"),
            None => stem,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_behind_the_file() {
        let read = |text: &str| text.parse::<FileRows>();
        let whole = read("C:/flights/a.csv").unwrap();
        assert_eq!(whole.rows, None);
        let part = read("C:/flights/a.csv:10-200").unwrap();
        assert_eq!(part.rows, Some([10, 200]));
        assert_eq!(part.file, PathBuf::from("C:/flights/a.csv"));
        assert_eq!(part.label().as_deref(), Some("a:10-200"));
        for wrong in ["a.csv:0-7", "a.csv:7-7", "a.csv:x-7", "a.csv:7-"] {
            assert!(read(wrong).unwrap_err().contains("FIRST-LAST"), "{wrong}");
        }
    }
}
