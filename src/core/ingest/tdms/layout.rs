//! Where the values of channels stand in a segment of a file.

use super::super::stored::{Order, Stored};

/// The kinds of values by their numbers in the format.
pub(super) mod kind {
    use super::super::super::stored::{Order, Stored, stored};

    pub(in super::super) const TEXT: u32 = 0x20;
    pub(in super::super) const STAMP: u32 = 0x44;

    pub(in super::super) fn number(kind: u32, order: Order) -> Option<Stored> {
        Some(match kind {
            1 => stored!(i8, order),
            2 => stored!(i16, order),
            3 => stored!(i32, order),
            4 => stored!(i64, order),
            5 | 0x21 => stored!(u8, order),
            6 => stored!(u16, order),
            7 => stored!(u32, order),
            8 => stored!(u64, order),
            9 | 0x19 => stored!(f32, order),
            10 | 0x1a => stored!(f64, order),
            _ => return None,
        })
    }

    /// The same of DAQmx, which counts in another way.
    pub(in super::super) fn of_daqmx(kind: u32, order: Order) -> Option<Stored> {
        number(*[5, 1, 6, 2, 7, 3, 8, 4, 9, 10].get(kind as usize)?, order)
    }

    /// Bytes of values that are no numbers: nothing, long doubles, complex numbers.
    pub(in super::super) fn width_of_others(kind: u32) -> Option<usize> {
        Some(match kind {
            0 => 0,
            0xb | 0x1b | 0x0010_000d => 16,
            0x0008_000c => 8,
            _ => return None,
        })
    }
}

/// What the values of a channel are.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    Number(Stored),
    Stamp(Order),
    /// What is not read.
    Other,
}

/// Where a channel has its values in every chunk.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slot {
    pub(super) kind: Kind,
    /// Bytes before the first.
    pub(super) at: usize,
    /// Bytes from one to the next.
    pub(super) step: usize,
    /// How many there are.
    pub(super) count: usize,
}

/// The chunks of one or several segments.
#[derive(Debug, Default)]
pub(super) struct Layout {
    /// By channel.
    pub(super) slots: Vec<Option<Slot>>,
    /// Bytes of a chunk.
    pub(super) length: usize,
}

impl Slot {
    /// The bytes of one value.
    pub(super) fn width(&self) -> usize {
        match self.kind {
            Kind::Number(number) => number.width,
            Kind::Stamp(_) => super::stamp::WIDTH,
            Kind::Other => 0,
        }
    }
}
