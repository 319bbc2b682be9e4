//! The values of channels out of the records.

use std::borrow::Cow;
use std::rc::Rc;

use super::super::groups::Samples;
use super::conversion::Conversion;
use super::damage::damaged;
use super::data;
use super::field::Field;
use crate::flight::Fault;

/// A channel as it is to be read.
pub(super) struct Wanted {
    pub(super) records: Rc<Records>,
    /// `None`: the number of the record.
    pub(super) field: Option<Field>,
    pub(super) conversion: Rc<Conversion>,
}

/// Records of one kind.
#[derive(PartialEq, Debug)]
pub(super) struct Records {
    /// Where the data are in which they stand, and how many bytes the number of a kind has there.
    pub(super) data: u64,
    pub(super) number_width: usize,
    /// The number of their kind, and the lengths of all kinds: `None` where each record says its own.
    pub(super) number: u64,
    pub(super) lengths: Rc<Vec<(u64, Option<usize>)>>,
    /// Bytes of one.
    pub(super) length: usize,
    pub(super) count: usize,
}

pub(super) struct Values<'a> {
    pub(super) file: &'a [u8],
    pub(super) wanted: Vec<Wanted>,
    /// Bytes that may still be put together.
    pub(super) room: usize,
    /// Blocks of data that may still be looked at.
    pub(super) blocks: usize,
    /// The data that were read last, and the records in them.
    pub(super) data: Option<(u64, Cow<'a, [u8]>)>,
    pub(super) places: Option<(Rc<Records>, Vec<usize>)>,
}

impl Samples for Values<'_> {
    fn values(&mut self, at: usize) -> Result<Vec<f64>, Fault> {
        let Some(wanted) = self.wanted.get(at) else {
            return Ok(Vec::new());
        };
        let records = &wanted.records;
        if self
            .data
            .as_ref()
            .is_none_or(|(address, _)| *address != records.data)
        {
            self.data = None;
            self.places = None;
            let data = data::records(self.file, records.data, &mut self.room, &mut self.blocks)?;
            self.data = Some((records.data, data));
        }
        let data = self
            .data
            .as_ref()
            .map_or(&[][..], |(_, data)| data.as_ref());
        let value = |(number, record): (usize, &[u8])| {
            let raw = wanted
                .field
                .map_or(number as f64, |field| field.read(record));
            wanted.conversion.apply(raw)
        };
        if records.length == 0 && records.number_width == 0 {
            // nothing but the number of each record is there
            let records = (0..records.count).map(|number| (number, &[][..]));
            return Ok(records.map(value).collect());
        }
        if records.number_width == 0 {
            let records = data.chunks_exact(records.length.max(1)).take(records.count);
            return Ok(records.enumerate().map(value).collect());
        }
        if self.places.as_ref().is_none_or(|(of, _)| of != records) {
            let places = records.places(data);
            let places = places.ok_or_else(|| damaged("a record is of an unknown kind"))?;
            self.places = Some((Rc::clone(records), places));
        }
        let places = self.places.as_ref().map_or(&[][..], |(_, places)| places);
        let records = places
            .iter()
            .map(|&at| data.get(at..at + records.length).unwrap_or_default());
        Ok(records.enumerate().map(value).collect())
    }
}

impl Records {
    /// Where each record begins in data that have records of several kinds, one behind the other; an incomplete one at the end
    /// is none.
    fn places(&self, data: &[u8]) -> Option<Vec<usize>> {
        let mut places = Vec::new();
        let mut at = 0usize;
        while places.len() < self.count {
            let Some(number) = data.get(at..at.saturating_add(self.number_width)) else {
                break;
            };
            let number = number
                .iter()
                .rev()
                .fold(0, |sum, &byte| sum << 8 | u64::from(byte));
            at += self.number_width;
            let known = self
                .lengths
                .binary_search_by_key(&number, |(number, _)| *number);
            let length = match self.lengths.get(known.ok()?)?.1 {
                Some(length) => length,
                None => {
                    let Some(length) = data.get(at..).and_then(<[u8]>::first_chunk) else {
                        break;
                    };
                    at += 4;
                    u32::from_le_bytes(*length) as usize
                }
            };
            let end = at.saturating_add(length);
            if end > data.len() {
                break;
            }
            if number == self.number {
                places.push(at);
            }
            at = end;
        }
        Some(places)
    }
}
