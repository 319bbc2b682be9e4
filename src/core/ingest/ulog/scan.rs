//! One pass over a log: its definitions, its topics, and where the messages of each are.

use std::collections::HashMap;

use super::super::messages::{Row, Table};
use super::super::{Limits, code, fault::of_file};
use super::definition::{Definitions, Flat};
use crate::flight::Fault;

const HEADER: usize = 16;
/// Length and type of a message, and what a synchronisation message has.
const SYNCHRONISATION: [u8; 11] = [8, 0, b'S', 0x2f, 0x73, 0x13, 0x20, 0x25, 0x0c, 0xbb, 0x12];
/// Of the flags that a reader must understand: that data are appended.
const APPENDED: u8 = 1;

fn damaged(at: usize, why: &str) -> Fault {
    let message = format!(
        "the PX4 ULog is damaged at byte {at}: {why}; copy it from the vehicle again, or write what is whole as CSV, with ulog2csv file.ulg"
    );
    of_file(code::DAMAGED_FILE, message)
}

/// A topic that messages of data belong to.
struct Topic {
    table: Table,
    length: usize,
}

/// The topics of a log.
///
/// # Errors
/// It is damaged so that nothing behind the damage can be found, or says something that is not understood.
pub(super) fn tables(bytes: &[u8], limits: &Limits) -> Result<Vec<Table>, Fault> {
    if bytes.len() < HEADER {
        return Err(damaged(bytes.len(), "it ends inside its header"));
    }
    if Row::try_from(bytes.len()).is_err() {
        return Err(damaged(bytes.len(), "it is longer than 4 GB"));
    }
    let mut log = Scan {
        bytes,
        limits,
        definitions: Definitions::default(),
        topics: HashMap::new(),
        closed: Vec::new(),
        ends: vec![bytes.len()],
    };
    log.scan()?;
    let topics = log.topics.into_values().map(|topic| topic.table);
    let tables: Vec<Table> = log.closed.into_iter().chain(topics).collect();
    if tables.iter().all(|table| table.rows.is_empty()) {
        return Err(damaged(bytes.len(), "it has no message of data"));
    }
    Ok(joined(tables))
}

/// A topic that was subscribed to more than once is one.
fn joined(tables: Vec<Table>) -> Vec<Table> {
    let mut by_name: HashMap<(String, Option<u32>), Table> = HashMap::new();
    for table in tables {
        let key = (table.name.clone(), table.instance);
        match by_name.get_mut(&key) {
            Some(first) => {
                first.rows.extend(table.rows);
                first.rows.sort_unstable();
            }
            None => {
                by_name.insert(key, table);
            }
        }
    }
    by_name.into_values().collect()
}

struct Scan<'a> {
    bytes: &'a [u8],
    limits: &'a Limits,
    definitions: Definitions<'a>,
    topics: HashMap<u16, Topic>,
    /// Whose number was given to another.
    closed: Vec<Table>,
    /// Where parts of the log end, the next one last: messages may be cut off there.
    ends: Vec<usize>,
}

impl<'a> Scan<'a> {
    fn scan(&mut self) -> Result<(), Fault> {
        let bytes = self.bytes;
        let mut at = HEADER;
        // a message may have said that there are more parts
        while let Some(&end) = self.ends.last() {
            let head = bytes.get(at..at + 3).filter(|_| at + 3 <= end);
            let Some(&[low, high, kind]) = head else {
                at = at.max(end);
                self.ends.pop();
                continue;
            };
            if !kind.is_ascii_uppercase() {
                at = self.behind_damage(at, end)?.unwrap_or(end);
                continue;
            }
            let start = at + 3;
            let next = start + usize::from(u16::from_le_bytes([low, high]));
            match bytes.get(start..next).filter(|_| next <= end) {
                Some(content) => {
                    self.message(kind, content, start)?;
                    at = next;
                }
                None => at = end,
            }
        }
        Ok(())
    }

    /// Where reading goes on behind what is no message; `None` where the rest is empty.
    fn behind_damage(&self, at: usize, end: usize) -> Result<Option<usize>, Fault> {
        let rest = &self.bytes[at..end];
        if let Some(next) = memchr::memmem::find(rest, &SYNCHRONISATION) {
            return Ok(Some(at + next));
        }
        // storage that was set aside and not written to
        if rest.iter().all(|&byte| byte == 0) || rest.iter().all(|&byte| byte == 0xff) {
            return Ok(None);
        }
        Err(damaged(at, "there is no message"))
    }

    fn message(&mut self, kind: u8, content: &'a [u8], start: usize) -> Result<(), Fault> {
        match kind {
            b'F' => self.definitions.add(content),
            b'A' => self.subscribe(content, start)?,
            b'D' => {
                let Some((number, message)) = content.split_first_chunk() else {
                    return Ok(());
                };
                let topic = self.topics.get_mut(&u16::from_le_bytes(*number));
                if let Some(topic) = topic.filter(|topic| message.len() >= topic.length) {
                    // the length of the file is one of a row
                    topic.table.rows.push((start + 2) as Row);
                }
            }
            b'B' => self.flags(content, start)?,
            _ => {}
        }
        Ok(())
    }

    fn flags(&mut self, content: &[u8], start: usize) -> Result<(), Fault> {
        let must = content.get(8..16).unwrap_or_default();
        let unknown = must.iter().enumerate().any(|(at, &flags)| {
            let known = if at == 0 { APPENDED } else { 0 };
            flags & !known != 0
        });
        if unknown {
            let why = "it needs a newer reader: it has flags that are not known";
            return Err(damaged(start, why));
        }
        let offsets = content.get(16..40).unwrap_or_default().chunks_exact(8);
        let mut appended: Vec<usize> = offsets
            .filter_map(|bytes| bytes.try_into().ok().map(u64::from_le_bytes))
            .filter_map(|offset| usize::try_from(offset).ok())
            .filter(|offset| (start + content.len()..self.bytes.len()).contains(offset))
            .collect();
        appended.sort_unstable_by(|a, b| b.cmp(a));
        self.ends.extend(appended);
        Ok(())
    }

    fn subscribe(&mut self, content: &[u8], start: usize) -> Result<(), Fault> {
        let [instance, low, high, ref name @ ..] = *content else {
            return Ok(());
        };
        let name = String::from_utf8_lossy(name).into_owned();
        let flat = self.definitions.find(&name);
        let Flat {
            fields,
            length,
            time,
        } = flat.map_err(|why| damaged(start, &format!("{why} ('{}')", shortened(&name))))?;
        if self.closed.len() + self.topics.len() >= self.limits.max_columns {
            return Err(damaged(start, "it has more topics than max_columns"));
        }
        let table = Table {
            name,
            instance: Some(u32::from(instance)),
            fields,
            time,
            time_unit: "us",
            rows: Vec::new(),
            repeated: 0,
            late: 0,
        };
        let topic = Topic { table, length };
        let before = self.topics.insert(u16::from_le_bytes([low, high]), topic);
        self.closed.extend(before.map(|topic| topic.table));
        Ok(())
    }
}

fn shortened(name: &str) -> String {
    name.chars().filter(|c| !c.is_control()).take(60).collect()
}
