//! A log as text (`.log`), as ground stations write it: a line for each message. It becomes the binary log that has the same.

use std::collections::HashMap;

use super::super::{
    IngestError, Limits,
    cell::{self, Marks},
    code,
    fault::of_file,
    note::note,
    text::quoted,
};
use super::definition::MEANT;
use super::scan::{FMT, MARK};
use crate::flight::{Fault, Finding, FindingCode};

/// Columns of a message; that is how many letters a definition has room for.
const MOST_COLUMNS: usize = 16;
/// What a text becomes that says nothing of units, and one that does.
const SHORT: u8 = b'n';
const LONG: u8 = b'Z';

/// Whether a file is a log as text.
pub(in super::super) fn is_text(bytes: &[u8]) -> bool {
    bytes.starts_with(b"FMT, 128,") || bytes.starts_with(b"FMT,128,")
}

/// A kind of message: its number, and for each column its letter.
struct Kind {
    number: u8,
    letters: Vec<u8>,
}

/// The binary log with the same messages, and what was odd about the text. Numbers are doubles in it: those whose letter says a
/// factor stand in a text as they are meant, the others go by the units of the log.
///
/// # Errors
/// There are more values than a recording may have.
pub(super) fn binary(
    bytes: &[u8],
    limits: &Limits,
) -> Result<(Vec<u8>, Vec<Finding>), IngestError> {
    let mut log = Vec::new();
    let mut kinds: HashMap<String, Kind> = HashMap::new();
    let mut odd = Odd::default();
    let mut values = 0usize;
    for (at, bytes) in bytes.split(|byte| *byte == b'\n').enumerate() {
        odd.line = at + 1;
        let line = String::from_utf8_lossy(bytes);
        let mut cells = line.trim_end().split(',').map(str::trim);
        let name = cells.next().unwrap_or_default();
        if name == "FMT" {
            define(&mut log, &mut kinds, cells.collect());
            continue;
        }
        let Some(kind) = kinds.get(name) else {
            continue;
        };
        let mut cells: Vec<&str> = cells.collect();
        while cells.len() > kind.letters.len() && cells.last() == Some(&"") {
            cells.pop();
        }
        if !kind.has_room_for(&cells) {
            odd.lines.push(odd.line);
            continue;
        }
        values += cells.len();
        limits.values(values).map_or(Ok(()), Err)?;
        log.extend(MARK);
        log.push(kind.number);
        for (cell, letter) in cells.iter().zip(&kind.letters) {
            match *letter {
                SHORT => log.extend(filled::<4>(cell)),
                LONG => log.extend(filled::<64>(cell)),
                _ => log.extend(odd.number(cell).to_le_bytes()),
            }
        }
    }
    Ok((log, odd.findings(bytes)))
}

impl Kind {
    /// Whether a line has a cell for each column. Texts may have commas in them; in numbers they would be decimal commas.
    fn has_room_for(&self, cells: &[&str]) -> bool {
        let has_text = self
            .letters
            .iter()
            .any(|letter| [SHORT, LONG].contains(letter));
        match has_text {
            true => cells.len() >= self.letters.len(),
            false => cells.len() == self.letters.len(),
        }
    }
}

/// What is odd about a text.
#[derive(Default)]
struct Odd {
    /// The one that is being read, from 1.
    line: usize,
    /// Lines that do not have a cell for each column.
    lines: Vec<usize>,
    /// Cells that are no numbers: how many, and of the first its line and what it says.
    cells: usize,
    first: Option<(usize, String)>,
}

impl Odd {
    /// The number of a cell; none is told, and has no value.
    fn number(&mut self, cell: &str) -> f64 {
        cell::number(cell, Marks::POINT).unwrap_or_else(|| {
            self.cells += 1;
            self.first.get_or_insert_with(|| (self.line, quoted(cell)));
            f64::NAN
        })
    }

    /// `bytes` are those of the file.
    fn findings(mut self, bytes: &[u8]) -> Vec<Finding> {
        let mut findings = Vec::new();
        let is_cut_off = !bytes.ends_with(b"\n") && self.lines.last() == Some(&self.line);
        if is_cut_off && self.lines.pop().is_some() {
            let message = format!("line {} is cut off: it was left out", self.line);
            let remedy = "nothing needs to be done";
            findings.push(note(FindingCode::IncompleteLine, message, remedy));
        }
        if let Some(first) = self.lines.first() {
            let message = format!(
                "{} line(s) were left out, the first of them line {first}: they have not one number for each column of their message",
                self.lines.len()
            );
            let remedy =
                "write numbers with decimal points, or send the .bin that the text was made from";
            findings.push(Finding {
                count: self.lines.len(),
                ..note(FindingCode::LeftOut, message, remedy)
            });
        }
        if let Some((line, cell)) = self.first {
            let message = format!(
                "{} cell(s) are no numbers and have no value, the first of them {cell} in line {line}",
                self.cells
            );
            let remedy = "send the .bin that the text was made from";
            findings.push(Finding {
                count: self.cells,
                ..note(FindingCode::MissingValues, message, remedy)
            });
        }
        findings
    }
}

/// A definition: kind, length, name, letters, and the names of the columns. One that cannot be is passed over.
fn define(log: &mut Vec<u8>, kinds: &mut HashMap<String, Kind>, cells: Vec<&str>) {
    let [number, _, name, letters, columns @ ..] = cells.as_slice() else {
        return;
    };
    let Ok(number) = number.parse::<u8>() else {
        return;
    };
    let is_of_units = ["UNIT", "FMTU"].contains(name);
    let text = if is_of_units { LONG } else { SHORT };
    let letter = |letter: u8| match letter {
        b'n' | b'N' | b'Z' | b'M' | b'a' => text,
        b'c' | b'C' | b'e' | b'E' | b'L' => MEANT,
        _ => b'd',
    };
    let letters: Vec<u8> = letters.bytes().take(MOST_COLUMNS).map(letter).collect();
    let width = |letter: &u8| match *letter {
        SHORT => 4,
        LONG => 64,
        _ => 8,
    };
    let length = 3 + letters.iter().map(width).sum::<usize>();
    let (Ok(length), false) = (
        u8::try_from(length),
        number == FMT || kinds.contains_key(*name),
    ) else {
        return;
    };
    log.extend(MARK);
    log.extend([FMT, number, length]);
    log.extend(filled::<4>(name));
    log.extend(filled::<16>(&String::from_utf8_lossy(&letters)));
    log.extend(filled::<64>(&columns.join(",")));
    kinds.insert((*name).to_string(), Kind { number, letters });
}

/// The beginning of a text in a field of fixed length.
fn filled<const N: usize>(text: &str) -> [u8; N] {
    let mut bytes = [0; N];
    let length = text.len().min(N);
    bytes[..length].copy_from_slice(&text.as_bytes()[..length]);
    bytes
}

/// That a log as text has no message that can be read.
pub(super) fn has_nothing() -> Fault {
    let message =
        "the ArduPilot log as text has no message with a time; send the .bin that it was made from";
    of_file(code::DAMAGED_FILE, message)
}
