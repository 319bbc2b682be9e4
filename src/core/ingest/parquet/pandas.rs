//! What pandas says of columns: which of them are its index, and which are durations, for which Parquet has no word.

use std::collections::HashMap;

use serde::Deserialize;

#[derive(Default)]
pub(super) struct Pandas {
    durations: HashMap<String, &'static str>,
    index: Vec<String>,
}

#[derive(Deserialize)]
struct Note {
    /// Names, or the description of an index that is counted.
    #[serde(default)]
    index_columns: Vec<serde_json::Value>,
    columns: Vec<Noted>,
}

#[derive(Deserialize)]
struct Noted {
    field_name: Option<String>,
    numpy_type: Option<String>,
}

impl Pandas {
    /// Of the JSON that it adds to a file; what cannot be read says nothing.
    pub(super) fn read(json: &[u8]) -> Self {
        let Ok(note) = serde_json::from_slice::<Note>(json) else {
            return Self::default();
        };
        let duration = |column: Noted| {
            let unit = match column.numpy_type?.as_str() {
                "timedelta64[s]" => "s",
                "timedelta64[ms]" => "ms",
                "timedelta64[us]" => "us",
                "timedelta64[ns]" => "ns",
                _ => return None,
            };
            Some((column.field_name?, unit))
        };
        Self {
            durations: note.columns.into_iter().filter_map(duration).collect(),
            index: note
                .index_columns
                .iter()
                .filter_map(|name| Some(name.as_str()?.to_string()))
                .collect(),
        }
    }

    /// Whether a column is the index, or one of several. In a file it stands behind the others, in a table before them.
    pub(super) fn is_index(&self, title: &str) -> bool {
        self.index.iter().any(|name| name == title)
    }

    /// The unit of a column of durations.
    pub(super) fn duration_of(&self, title: &str) -> Option<&'static str> {
        self.durations.get(title).copied()
    }
}
