//! Kinds of messages as a log defines them (FMT), and the units of their fields (FMTU, UNIT, MULT).

use super::super::messages::Field;
use super::super::stored::{Order, Stored, stored};

/// A kind of message.
pub(super) struct Definition {
    pub(super) name: String,
    /// Bytes of a message, its mark and its kind included.
    pub(super) length: usize,
    /// Of every column: its place in the message, and its letter.
    pub(super) columns: Vec<Column>,
}

pub(super) struct Column {
    pub(super) name: String,
    pub(super) letter: u8,
    pub(super) at: usize,
    pub(super) width: usize,
}

/// The letter of doubles as they are meant, with no factor to come, which a log as text becomes. Logs have no such letter.
pub(super) const MEANT: u8 = b'=';

/// Mark (two bytes) and kind of a message.
pub(super) const HEAD: usize = 3;

impl Definition {
    /// Of the content of a message FMT; `None` where it contradicts itself.
    pub(super) fn read(content: &[u8]) -> Option<(u8, Self)> {
        let [kind, length, ref rest @ ..] = *content else {
            return None;
        };
        let name = text(rest.get(..4)?);
        let letters = rest.get(4..20)?;
        let letters = &letters[..letters.iter().position(|&c| c == 0).unwrap_or(16)];
        let names = text(rest.get(20..84)?);
        let mut at = HEAD;
        let mut columns = Vec::new();
        for (&letter, name) in letters.iter().zip(names.split(',')) {
            let width = width(letter)?;
            columns.push(Column {
                name: name.trim().to_string(),
                letter,
                at,
                width,
            });
            at += width;
        }
        let definition = Self {
            name,
            length: usize::from(length),
            columns,
        };
        (at <= definition.length).then_some((kind, definition))
    }

    /// The column of this name.
    pub(super) fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// Which column is time, and its unit.
    pub(super) fn time(&self) -> Option<(usize, &'static str)> {
        let find = |name: &str| self.columns.iter().position(|column| column.name == name);
        let of_old_logs = || find("TimeMS").map(|at| (at, "ms"));
        find("TimeUS").map(|at| (at, "us")).or_else(of_old_logs)
    }
}

impl Column {
    /// The numbers of the column: one, or those of an array; none of a text.
    pub(super) fn fields(&self, unit: &str) -> Vec<Field> {
        let Some(number) = number(self.letter) else {
            return Vec::new();
        };
        let field = |name: String, at: usize| Field {
            name,
            at,
            number,
            unit: unit.to_string(),
        };
        if self.letter == b'a' {
            let of_array = |k: usize| field(format!("{}[{k}]", self.name), self.at + 2 * k);
            return (0..32).map(of_array).collect();
        }
        vec![field(self.name.clone(), self.at)]
    }

    /// The text in the message at `row`.
    pub(super) fn text(&self, bytes: &[u8], row: usize) -> String {
        let start = row + self.at;
        bytes
            .get(start..start + self.width)
            .map_or(String::new(), text)
    }

    /// The number in the message at `row`.
    pub(super) fn value(&self, bytes: &[u8], row: usize) -> Option<f64> {
        let number = number(self.letter)?;
        let start = row + self.at;
        bytes.get(start..start + number.width).map(number.read)
    }
}

fn text(bytes: &[u8]) -> String {
    let end = bytes
        .iter()
        .position(|&byte| byte == 0)
        .unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).trim().to_string()
}

fn width(letter: u8) -> Option<usize> {
    Some(match letter {
        b'a' => 64,
        b'n' => 4,
        b'N' => 16,
        b'Z' => 64,
        letter => number(letter)?.width,
    })
}

/// How a number of this letter is stored; `None` for text.
fn number(letter: u8) -> Option<Stored> {
    Some(match letter {
        b'b' => stored!(i8, Order::Little),
        b'B' | b'M' => stored!(u8, Order::Little),
        b'a' | b'h' => stored!(i16, Order::Little),
        b'H' => stored!(u16, Order::Little),
        b'i' => stored!(i32, Order::Little),
        b'I' => stored!(u32, Order::Little),
        b'q' => stored!(i64, Order::Little),
        b'Q' => stored!(u64, Order::Little),
        b'f' => stored!(f32, Order::Little),
        b'd' | MEANT => stored!(f64, Order::Little),
        b'c' => stored!(i16, Order::Little, / 100.0),
        b'C' => stored!(u16, Order::Little, / 100.0),
        b'e' => stored!(i32, Order::Little, / 100.0),
        b'E' => stored!(u32, Order::Little, / 100.0),
        // latitude and longitude
        b'L' => stored!(i32, Order::Little, / 1e7),
        b'g' => Stored {
            width: 2,
            read: |bytes| {
                bytes
                    .try_into()
                    .map_or(f64::NAN, |bytes| half(u16::from_le_bytes(bytes)))
            },
        },
        _ => return None,
    })
}

/// A number of half precision (IEEE 754).
fn half(bits: u16) -> f64 {
    let sign = if bits & 0x8000 == 0 { 1.0 } else { -1.0 };
    let fraction = f64::from(bits & 0x03ff);
    match (bits >> 10) & 0x1f {
        0 => sign * fraction * 2f64.powi(-24),
        31 if fraction == 0.0 => sign * f64::INFINITY,
        31 => f64::NAN,
        exponent => sign * (1.0 + fraction / 1024.0) * 2f64.powi(i32::from(exponent) - 15),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_half_precision() {
        for (bits, value) in [
            (0x3c00, 1.0),
            (0xc000, -2.0),
            (0x3555, 0.333_251_953_125),
            (0x7bff, 65504.0),
            (0x0001, 5.960_464_477_539_063e-8),
            (0x7c00, f64::INFINITY),
        ] {
            assert_eq!(half(bits), value);
        }
        assert!(half(0x7e00).is_nan());
    }
}
