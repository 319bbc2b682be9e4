//! A log as text (`.log`), as ground stations write it: a line for each message. It becomes the binary log that has the same.

use std::collections::HashMap;

use super::super::{IngestError, Limits, code, fault::of_file};
use super::scan::{FMT, MARK};
use crate::flight::Fault;

/// Columns of a message; that is how many letters a definition has room for.
const MOST_COLUMNS: usize = 16;
/// What a text becomes that says nothing of units, and one that does.
const SHORT: u8 = b'n';
const LONG: u8 = b'Z';

/// Whether a file is a log as text.
pub(in super::super) fn is_text(bytes: &[u8]) -> bool {
    bytes.starts_with(b"FMT, 128,") || bytes.starts_with(b"FMT,128,")
}

/// A kind of message: its number, and for each column whether it is a number and, where not, its letter.
struct Kind {
    number: u8,
    letters: Vec<u8>,
}

/// The binary log with the same messages. Numbers are doubles in it, but for those whose letter says a factor: they stand in a text
/// as they are meant, and units go by the letter.
///
/// # Errors
/// There are more values than a recording may have.
pub(super) fn binary(bytes: &[u8], limits: &Limits) -> Result<Vec<u8>, IngestError> {
    let mut log = Vec::new();
    let mut kinds: HashMap<String, Kind> = HashMap::new();
    let mut values = 0usize;
    for line in bytes.split(|byte| *byte == b'\n') {
        let line = String::from_utf8_lossy(line);
        let mut cells = line.trim_end().split(',').map(str::trim);
        let name = cells.next().unwrap_or_default();
        if name == "FMT" {
            define(&mut log, &mut kinds, cells.collect());
            continue;
        }
        let Some(kind) = kinds.get(name) else {
            continue;
        };
        let cells: Vec<&str> = cells.collect();
        // a line that was cut off is no message
        if cells.len() < kind.letters.len() {
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
                letter => log.extend(number(cell, letter)),
            }
        }
    }
    Ok(log)
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
        b'c' | b'C' | b'e' | b'E' | b'L' => letter,
        _ => b'd',
    };
    let letters: Vec<u8> = letters.bytes().take(MOST_COLUMNS).map(letter).collect();
    let width = |letter: &u8| match *letter {
        b'c' | b'C' => 2,
        b'd' => 8,
        LONG => 64,
        _ => 4,
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

/// A number as one of this letter is stored.
fn number(cell: &str, letter: u8) -> Vec<u8> {
    let value = cell.parse().unwrap_or(f64::NAN);
    let hundredths = (value * 100.0).round();
    match letter {
        b'c' => (hundredths as i16).to_le_bytes().to_vec(),
        b'C' => (hundredths as u16).to_le_bytes().to_vec(),
        b'e' => (hundredths as i32).to_le_bytes().to_vec(),
        b'E' => (hundredths as u32).to_le_bytes().to_vec(),
        b'L' => ((value * 1e7).round() as i32).to_le_bytes().to_vec(),
        _ => value.to_le_bytes().to_vec(),
    }
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
