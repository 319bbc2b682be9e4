//! A recording, or some rows of one, as it is named on the command line.

use std::path::{Path, PathBuf};
use std::str::FromStr;

/// `FILE`, or `FILE:FIRST-LAST` for rows counted from 1, both included, or `FILE:2s-32.5s` for seconds.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct FileRows {
    pub file: PathBuf,
    pub rows: Option<[usize; 2]>,
    pub seconds: Option<[f64; 2]>,
}

impl FromStr for FileRows {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let whole = || Self {
            file: PathBuf::from(text),
            rows: None,
            seconds: None,
        };
        // a file may be called so
        let Some((file, rows)) = text.rsplit_once(':').filter(|_| !Path::new(text).exists()) else {
            return Ok(whole());
        };
        let Some((first, last)) = rows.split_once('-') else {
            return Ok(whole());
        };
        let second = |text: &str| text.trim().strip_suffix('s')?.parse::<f64>().ok();
        if let (Some(from), Some(to)) = (second(first), second(last))
            && from < to
        {
            return Ok(Self {
                file: PathBuf::from(file),
                rows: None,
                seconds: Some([from, to]),
            });
        }
        let number = |text: &str| text.trim().parse::<usize>().ok();
        match (number(first), number(last)) {
            (Some(first), Some(last)) if 1 <= first && first < last => Ok(Self {
                file: PathBuf::from(file),
                rows: Some([first, last]),
                seconds: None,
            }),
            _ => Err(format!(
                "'{rows}' is not a range of rows or seconds; write FIRST-LAST, rows counted from 1, both included, or 2s-32.5s"
            )),
        }
    }
}

impl FileRows {
    /// What it is called in tables.
    pub(super) fn label(&self) -> Option<String> {
        let stem = self.file.file_stem()?.to_string_lossy().into_owned();
        Some(match (self.rows, self.seconds) {
            (Some([first, last]), _) => format!("{stem}:{first}-{last}"),
            (None, Some([from, to])) => format!("{stem}:{from}s-{to}s"),
            (None, None) => stem,
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
        let seconds = read("a.csv:2s-32.5s").unwrap();
        assert_eq!((seconds.rows, seconds.seconds), (None, Some([2.0, 32.5])));
        assert_eq!(seconds.label().as_deref(), Some("a:2s-32.5s"));
        for wrong in [
            "a.csv:7s-2s",
            "a.csv:0-7",
            "a.csv:7-7",
            "a.csv:x-7",
            "a.csv:7-",
        ] {
            assert!(read(wrong).unwrap_err().contains("FIRST-LAST"), "{wrong}");
        }
    }
}
