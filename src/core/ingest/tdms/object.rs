//! Objects: channels and groups, with what a segment says of them.

use super::super::cursor::Cursor;
use super::super::stored::Order;
use super::layout::{Kind, kind};
use super::property::{self, Properties};
use super::stamp;

#[derive(Default)]
pub(super) struct Object {
    /// The names of its group and its own, as far as it has them.
    pub(super) path: Vec<String>,
    pub(super) properties: Properties,
    /// The last one that was said.
    pub(super) index: Option<Index>,
}

/// What stands of a channel in every chunk of a segment.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Index {
    kind: u32,
    pub(super) count: usize,
    /// Bytes, where the kind does not say how many each has.
    length: Option<usize>,
    pub(super) daqmx: Option<Daqmx>,
}

/// Values as a device of DAQmx gives them, those of all channels side by side.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Daqmx {
    /// `None` where they are stored in a way that is not read.
    kind: Option<u32>,
    pub(super) at: usize,
    /// Bytes of all channels.
    pub(super) row: usize,
}

/// What a segment says of the values of an object.
pub(super) enum Said {
    None,
    AsBefore,
    Index(Index),
}

const NO_DATA: u32 = 0xffff_ffff;
const AS_BEFORE: u32 = 0;
/// Numbers of a device of DAQmx; and bits of digital lines, by two numbers that are in use.
const DAQMX: u32 = 0x1269;
const DIGITAL: [u32; 2] = [0x126a, 0x1369];
/// Channels that are measured together, or scalers of one.
const MOST_SCALERS: u32 = 10_000;

impl Said {
    pub(super) fn read(cursor: &mut Cursor) -> Option<Self> {
        let head = cursor.u32()?;
        Some(match head {
            NO_DATA => Self::None,
            AS_BEFORE => Self::AsBefore,
            DAQMX => Self::Index(daqmx(cursor, false)?),
            _ if DIGITAL.contains(&head) => Self::Index(daqmx(cursor, true)?),
            _ => {
                let kind = cursor.u32()?;
                cursor.u32()?;
                let count = cursor.count()?;
                let length = match kind {
                    kind::TEXT => Some(cursor.count()?),
                    _ => None,
                };
                Self::Index(Index {
                    kind,
                    count,
                    length,
                    daqmx: None,
                })
            }
        })
    }
}

fn daqmx(cursor: &mut Cursor, is_digital: bool) -> Option<Index> {
    let kind = cursor.u32()?;
    cursor.u32()?;
    let count = cursor.count()?;
    let scalers = cursor.u32()?;
    let mut first = None;
    for _ in 0..scalers.min(MOST_SCALERS) {
        let (kind, buffer, at) = (cursor.u32()?, cursor.u32()?, cursor.u32()?);
        // a map of bits, and the number of the scaler
        cursor.take(if is_digital { 5 } else { 8 })?;
        first = first.or(Some((kind, buffer, at)));
    }
    let buffers = cursor.u32()?;
    let mut row = 0usize;
    for _ in 0..buffers.min(MOST_SCALERS) {
        row = row.checked_add(cursor.u32()? as usize)?;
    }
    // one device with values of one kind of channel is what is read
    let (stored, at) = match (first, scalers, buffers) {
        (Some((kind, 0, at)), 1, 1) if !is_digital => (Some(kind), at as usize),
        _ => (None, 0),
    };
    let daqmx = Daqmx {
        kind: stored,
        at,
        row,
    };
    Some(Index {
        kind,
        count,
        length: None,
        daqmx: Some(daqmx),
    })
}

impl Index {
    pub(super) fn values(&self, order: Order) -> Kind {
        let number = match (self.daqmx, self.length) {
            (Some(daqmx), _) => daqmx.kind.and_then(|kind| kind::of_daqmx(kind, order)),
            (None, Some(_)) => None,
            (None, None) => kind::number(self.kind, order),
        };
        match number {
            Some(number) => Kind::Number(number),
            None if self.kind == kind::STAMP && self.daqmx.is_none() => Kind::Stamp(order),
            None => Kind::Other,
        }
    }

    /// Bytes of one value; `None` where they are not alike.
    pub(super) fn width(&self, order: Order) -> Option<usize> {
        match (self.length, self.values(order)) {
            (Some(_), _) => None,
            (None, Kind::Number(number)) => Some(number.width),
            (None, Kind::Stamp(_)) => Some(stamp::WIDTH),
            (None, Kind::Other) => kind::width_of_others(self.kind),
        }
    }

    /// Bytes of all values in a chunk.
    pub(super) fn bytes(&self, order: Order) -> Option<usize> {
        match self.length {
            Some(length) => Some(length),
            None => self.width(order)?.checked_mul(self.count),
        }
    }
}

impl Object {
    /// Of a path such as `/'Group'/'Channel'`, in which a quote is written twice.
    pub(super) fn of(path: &[u8]) -> Self {
        let path = String::from_utf8_lossy(path);
        let mut names = Vec::new();
        let mut rest = path.as_ref();
        while let Some(quoted) = rest.strip_prefix("/'") {
            let mut name = String::new();
            let mut characters = quoted.char_indices().peekable();
            rest = "";
            while let Some((at, character)) = characters.next() {
                if character != '\'' {
                    name.push(character);
                } else if characters.next_if(|(_, next)| *next == '\'').is_some() {
                    name.push('\'');
                } else {
                    rest = &quoted[at + 1..];
                    break;
                }
            }
            names.push(name);
        }
        Self {
            path: names,
            ..Self::default()
        }
    }

    pub(super) fn read_properties(&mut self, cursor: &mut Cursor, order: Order) -> Option<()> {
        property::read(cursor, order, &mut self.properties)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_have_names_in_quotes() {
        let names = |path: &str| Object::of(path.as_bytes()).path;
        assert_eq!(names("/"), [""; 0]);
        assert_eq!(names("/'Air Data'"), ["Air Data"]);
        assert_eq!(names("/'it''s'/'a/b'"), ["it's", "a/b"]);
        assert_eq!(names("/'open"), ["open"]);
    }
}
