//! In which form a list is printed: a table for people, CSV for tables, JSON for programs.

use serde_json::Value;

use super::Failure;
use super::table::bordered;
use crate::estimate::five_digits;
use crate::ingest::CsvWriter;

/// `--csv` and `--json`.
#[derive(clap::Args, Debug)]
pub(super) struct Form {
    /// Print CSV.
    #[arg(long, conflicts_with = "json")]
    pub csv: bool,
    /// Print JSON, as the API has it.
    #[arg(long)]
    pub json: bool,
}

/// A column of a list: its title, where it is in the JSON, and whether it has numbers.
pub(super) struct Column {
    pub title: &'static str,
    pub pointer: &'static str,
    pub is_number: bool,
    /// A table has no room for it.
    pub only_in_csv: bool,
}

impl Column {
    pub(super) const fn text(title: &'static str, pointer: &'static str) -> Self {
        Self {
            title,
            pointer,
            is_number: false,
            only_in_csv: false,
        }
    }

    pub(super) const fn number(title: &'static str, pointer: &'static str) -> Self {
        Self {
            title,
            pointer,
            is_number: true,
            only_in_csv: false,
        }
    }

    /// A text that CSV has and a table has not.
    pub(super) const fn only_in_csv(title: &'static str, pointer: &'static str) -> Self {
        Self {
            only_in_csv: true,
            ..Self::text(title, pointer)
        }
    }
}

impl Form {
    /// Prints entries as the API has them; numbers stand behind texts.
    pub(super) fn print(&self, columns: &[Column], entries: &[Value]) -> Result<(), Failure> {
        if self.json {
            println!("{}", serde_json::to_string_pretty(entries)?);
        } else if self.csv {
            print!("{}", as_csv(columns, entries));
        } else {
            println!("{}", as_table(columns, entries));
        }
        Ok(())
    }
}

fn as_csv(columns: &[Column], entries: &[Value]) -> String {
    let mut csv = CsvWriter::with_header(columns.iter().map(|column| column.title));
    for entry in entries {
        for column in columns {
            match entry.pointer(column.pointer) {
                Some(Value::Number(number)) if column.is_number && !number.is_u64() => {
                    csv.number(number.as_f64());
                }
                value => csv.text(&cell(value)),
            }
        }
        csv.end_row();
    }
    csv.finish()
}

fn as_table(columns: &[Column], entries: &[Value]) -> String {
    let columns = || columns.iter().filter(|column| !column.only_in_csv);
    let of = |entry: &Value, column: &Column| match entry.pointer(column.pointer) {
        Some(Value::Number(number)) if column.is_number && !number.is_u64() => {
            number.as_f64().map(five_digits).unwrap_or_default()
        }
        value => shortened(cell(value)),
    };
    let cells = |entry: &Value| columns().map(|column| of(entry, column)).collect();
    let texts = columns().take_while(|column| !column.is_number);
    let numeric = texts.count()..;
    let header = columns().map(|column| column.title);
    bordered(header, entries.iter().map(cells), numeric)
}

/// Most letters of a text in a table; CSV and JSON have all of it.
const MOST_LETTERS: usize = 48;

/// With a mark where something is left out.
fn shortened(mut text: String) -> String {
    if text.chars().count() > MOST_LETTERS
        && let Some((end, _)) = text.char_indices().nth(MOST_LETTERS - 1)
    {
        text.truncate(end);
        text.push('…');
    }
    text
}

/// A value in one cell; what is not there is empty.
fn cell(value: Option<&Value>) -> String {
    match value {
        None | Some(Value::Null) => String::new(),
        Some(Value::String(text)) => text.clone(),
        Some(Value::Array(items)) => {
            let items: Vec<String> = items.iter().map(|item| cell(Some(item))).collect();
            items.join(", ")
        }
        Some(other) => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    const COLUMNS: [Column; 4] = [
        Column::text("name", "/name"),
        Column::only_in_csv("inputs", "/inputs"),
        Column::text("tags", "/tags"),
        Column::number("R²", "/fit/r_squared"),
    ];

    #[test]
    fn what_is_not_there_is_an_empty_cell() {
        let entries = [
            json!({"name": "=a, b", "inputs": ["de"], "tags": ["x", "y"], "fit": {"r_squared": 0.987654321}}),
            json!({"name": "c", "tags": [], "fit": {"r_squared": 1}}),
        ];
        assert_eq!(
            as_csv(&COLUMNS, &entries),
            "name,inputs,tags,R²\n\"'=a, b\",de,\"x, y\",0.987654321\nc,,,1\n"
        );
        assert_eq!(shortened("é".repeat(48)), "é".repeat(48));
        assert_eq!(shortened("é".repeat(49)), "é".repeat(47) + "…");
        let table = as_table(&COLUMNS, &entries);
        assert!(table.contains("x, y") && table.contains("R²"), "{table}");
        assert!(
            table.contains(" 0.98765 ") && !table.contains("inputs"),
            "{table}"
        );
    }
}
