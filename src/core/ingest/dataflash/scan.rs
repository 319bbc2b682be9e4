//! One pass over a log: its definitions, where the messages of each kind are, then the tables that they become.

use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

use super::super::messages::{Field, Row, Table};
use super::super::{code, fault::of_file};
use super::definition::{Definition, HEAD, MEANT};
use crate::flight::Fault;

pub(super) const MARK: [u8; 2] = [0xa3, 0x95];
/// The kind of the messages that define others, and their length.
pub(super) const FMT: u8 = 128;
const FMT_LENGTH: usize = 89;

fn damaged(at: usize, why: &str) -> Fault {
    let message = format!(
        "the ArduPilot DataFlash log is damaged at byte {at}: {why}; download it again, or write what is whole as CSV, with mavlogdump.py --format csv --types IMU file.bin > file.csv"
    );
    of_file(code::DAMAGED_FILE, message)
}

/// The messages of a log, one table for each kind and each instance.
///
/// # Errors
/// It has no definition of a message, or none of a message with a time that is there.
pub(super) fn tables(bytes: &[u8]) -> Result<Vec<Table>, Fault> {
    if Row::try_from(bytes.len()).is_err() {
        return Err(damaged(bytes.len(), "it is longer than 4 GB"));
    }
    let log = Scan::of(bytes);
    if log.definitions.is_empty() {
        return Err(damaged(0, "it has no whole definition of a message (FMT)"));
    }
    let units = Units::of(&log);
    let mut tables = Vec::new();
    for (kind, definition) in &log.definitions {
        let rows = log.rows.get(kind).map_or(&[][..], Vec::as_slice);
        tables.extend(of_kind(*kind, definition, rows, &units, bytes));
    }
    if tables.iter().all(|table| table.rows.is_empty()) {
        return Err(damaged(bytes.len(), "it has no message with a time"));
    }
    Ok(tables)
}

struct Scan<'a> {
    bytes: &'a [u8],
    definitions: BTreeMap<u8, Definition>,
    rows: HashMap<u8, Vec<Row>>,
}

impl<'a> Scan<'a> {
    fn of(bytes: &'a [u8]) -> Self {
        let mut log = Self {
            bytes,
            definitions: BTreeMap::new(),
            rows: HashMap::new(),
        };
        let mut at = 0;
        while let Some(rest) = bytes.get(at..).filter(|rest| rest.len() >= HEAD) {
            match log.message(rest, at) {
                Some(length) => at += length,
                // bytes that are no message are passed over
                None => match memchr::memmem::find(&rest[1..], &MARK) {
                    Some(next) => at += 1 + next,
                    None => break,
                },
            }
        }
        log
    }

    /// The length of the message that `rest` begins with; `None` where there is none, or not all of it.
    fn message(&mut self, rest: &[u8], at: usize) -> Option<usize> {
        let &[first, second, kind, ..] = rest else {
            return None;
        };
        if [first, second] != MARK {
            return None;
        }
        if kind == FMT {
            let (kind, definition) = Definition::read(rest.get(HEAD..FMT_LENGTH)?)?;
            // one that is defined again is defined alike, or the log is damaged
            if definition.length >= HEAD && kind != FMT {
                self.definitions.entry(kind).or_insert(definition);
            }
            return Some(FMT_LENGTH);
        }
        let length = self.definitions.get(&kind)?.length;
        rest.get(..length)?;
        self.rows.entry(kind).or_default().push(at as Row);
        Some(length)
    }

    fn of_name(&self, name: &str) -> Option<(&Definition, &[Row])> {
        let (kind, definition) = self.definitions.iter().find(|(_, d)| d.name == name)?;
        Some((definition, self.rows.get(kind)?))
    }
}

/// What a log says of units: by kind of message the letters of its columns, and what letters mean.
struct Units {
    of_kind: HashMap<u8, (String, String)>,
    units: HashMap<char, String>,
    factors: HashMap<char, f64>,
}

/// Letters of columns whose numbers have their factor already.
const HAVE_FACTORS: [u8; 6] = [b'c', b'C', b'e', b'E', b'L', MEANT];
/// The letter of the column that says which of several sensors a message is of.
const INSTANCE: char = '#';

impl Units {
    fn of(log: &Scan) -> Self {
        let mut units = Self {
            of_kind: HashMap::new(),
            units: HashMap::new(),
            factors: HashMap::new(),
        };
        let bytes = log.bytes;
        if let Some((definition, rows)) = log.of_name("FMTU")
            && let (Some(kind), Some(unit_ids), Some(factor_ids)) = (
                definition.column("FmtType"),
                definition.column("UnitIds"),
                definition.column("MultIds"),
            )
        {
            for &row in rows {
                let row = row as usize;
                let of_kind = (unit_ids.text(bytes, row), factor_ids.text(bytes, row));
                let kind = kind.value(bytes, row).filter(|kind| kind.is_finite());
                units.of_kind.extend(kind.map(|kind| (kind as u8, of_kind)));
            }
        }
        for (name, column) in [("UNIT", "Label"), ("MULT", "Mult")] {
            let Some((definition, rows)) = log.of_name(name) else {
                continue;
            };
            let (Some(id), Some(column)) = (definition.column("Id"), definition.column(column))
            else {
                continue;
            };
            for &row in rows {
                let row = row as usize;
                let letter = id.value(bytes, row).filter(|id| id.is_finite());
                let Some(letter) = letter.map(|letter| char::from(letter as u8)) else {
                    continue;
                };
                if name == "UNIT" {
                    units.units.insert(letter, column.text(bytes, row));
                } else if let Some(factor) = column.value(bytes, row) {
                    units.factors.insert(letter, factor);
                }
            }
        }
        units
    }

    /// The unit of a column, with a factor before it that the letter of the column does not have already.
    fn of_column(&self, kind: u8, at: usize, letter: u8) -> String {
        let Some((unit_ids, factor_ids)) = self.of_kind.get(&kind) else {
            return String::new();
        };
        let unit = unit_ids.chars().nth(at).and_then(|id| self.units.get(&id));
        let Some(unit) = unit.filter(|unit| !unit.is_empty()) else {
            return String::new();
        };
        let factor = factor_ids
            .chars()
            .nth(at)
            .and_then(|id| self.factors.get(&id));
        match factor {
            Some(&factor) if factor != 1.0 && factor != 0.0 && !HAVE_FACTORS.contains(&letter) => {
                format!("{factor} {unit}")
            }
            _ => unit.clone(),
        }
    }

    /// Which column says the instance.
    fn instance(&self, kind: u8, definition: &Definition) -> Option<usize> {
        let said = self.of_kind.get(&kind);
        let said = said.and_then(|(unit_ids, _)| unit_ids.chars().position(|id| id == INSTANCE));
        // logs that do not say it call the column so
        let named = || {
            definition
                .columns
                .iter()
                .position(|column| column.name == "I")
        };
        said.or_else(named)
            .filter(|&at| at < definition.columns.len())
    }
}

/// The tables of a kind of message; none where it has no time.
fn of_kind(
    kind: u8,
    definition: &Definition,
    rows: &[Row],
    units: &Units,
    bytes: &[u8],
) -> Vec<Table> {
    let Some((time, time_unit)) = definition.time() else {
        return Vec::new();
    };
    let time = definition.columns[time].name.as_str();
    let columns = definition.columns.iter().enumerate();
    let fields: Vec<Field> = columns
        .flat_map(|(at, column)| column.fields(&units.of_column(kind, at, column.letter)))
        .collect();
    let Some(time) = fields.iter().position(|field| field.name == time) else {
        return Vec::new();
    };
    let fields = Rc::new(fields);
    let instance = units.instance(kind, definition);
    let mut by_instance: BTreeMap<Option<u32>, Vec<Row>> = BTreeMap::new();
    for &row in rows {
        let value = instance.map(|at| definition.columns[at].value(bytes, row as usize));
        let number = match value {
            None => None,
            // a message that does not say which sensor it is of is of none
            Some(value) => match value.filter(|value| *value >= 0.0) {
                Some(value) => Some(value as u32),
                None => continue,
            },
        };
        by_instance.entry(number).or_default().push(row);
    }
    // instances are few: more of them are numbers of something else
    if by_instance.len() > 16 {
        by_instance = BTreeMap::from([(None, rows.to_vec())]);
    }
    let table = |(instance, rows)| Table {
        name: definition.name.clone(),
        instance,
        fields: fields.clone(),
        time,
        time_unit,
        rows,
        repeated: 0,
        late: 0,
    };
    by_instance.into_iter().map(table).collect()
}
