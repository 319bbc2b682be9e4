//! In which form a list is printed: a table for people, CSV for tables, JSON for programs.

use serde_json::Value;

use super::Failure;
use super::table::bordered;
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
}

impl Column {
    pub(super) const fn text(title: &'static str, pointer: &'static str) -> Self {
        Self {
            title,
            pointer,
            is_number: false,
        }
    }

    pub(super) const fn number(title: &'static str, pointer: &'static str) -> Self {
        Self {
            title,
            pointer,
            is_number: true,
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
    let cells = |entry: &Value| {
        let of = |column: &Column| cell(entry.pointer(column.pointer));
        columns.iter().map(of).collect()
    };
    let texts = columns.iter().take_while(|column| !column.is_number);
    let numeric = texts.count()..;
    let header = columns.iter().map(|column| column.title);
    bordered(header, entries.iter().map(cells), numeric)
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

    const COLUMNS: [Column; 3] = [
        Column::text("name", "/name"),
        Column::text("tags", "/tags"),
        Column::number("R²", "/fit/r_squared"),
    ];

    #[test]
    fn what_is_not_there_is_an_empty_cell() {
        let entries = [
            json!({"name": "=a, b", "tags": ["x", "y"], "fit": {"r_squared": 0.5}}),
            json!({"name": "c", "tags": [], "fit": {"r_squared": 1}}),
        ];
        assert_eq!(
            as_csv(&COLUMNS, &entries),
            "name,tags,R²\n\"'=a, b\",\"x, y\",0.5\nc,,1\n"
        );
        let table = as_table(&COLUMNS, &entries);
        assert!(table.contains("x, y") && table.contains("R²"), "{table}");
    }
}
