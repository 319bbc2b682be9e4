//! The groups and channels of a file.

use std::collections::HashMap;
use std::rc::Rc;

use super::super::groups::{Channel, Group, Groups, Time};
use super::super::{Limits, code, fault::of_file};
use super::block::Block;
use super::conversion::Conversion;
use super::damage::damaged;
use super::data;
use super::field::{Field, Kind};
use super::samples::{Records, Values, Wanted};
use crate::flight::Fault;

/// Groups, and channels of all of them.
const MOST: usize = 100_000;
const FIRST_BLOCK: u64 = 64;

/// Looks at all groups.
///
/// # Errors
/// The file is damaged, or has more in it than is taken.
pub(super) fn scan<'a>(bytes: &'a [u8], limits: &Limits) -> Result<Groups<Values<'a>>, Fault> {
    let head = Block::find(bytes, FIRST_BLOCK, b"HD")?;
    let head = head.ok_or_else(|| damaged("it has no header"))?;
    let mut scan = Scan {
        file: bytes,
        groups: Vec::new(),
        wanted: Vec::new(),
        left_out: Vec::new(),
        conversions: HashMap::new(),
        // conversions that overlap in the file would be more in memory than it is
        numbers: bytes.len() / size_of::<f64>(),
        left: MOST,
        blocks: data::MOST_BLOCKS,
    };
    let mut address = head.link(0);
    while let Some(data) = Block::find(bytes, address, b"DG")? {
        scan.count()?;
        scan.data_group(&data)?;
        address = data.link(0);
    }
    Ok(Groups {
        groups: scan.groups,
        left_out: scan.left_out,
        samples: Values {
            file: bytes,
            wanted: scan.wanted,
            // times and values of a group may be asked for apart
            room: limits.max_bytes.saturating_mul(2),
            blocks: data::MOST_BLOCKS,
            data: None,
            places: None,
        },
    })
}

struct Scan<'a> {
    file: &'a [u8],
    groups: Vec<Group>,
    wanted: Vec<Wanted>,
    left_out: Vec<(String, String)>,
    /// By their addresses: many channels may have one. `None`: it is one that is not read.
    conversions: HashMap<u64, Option<Rc<Conversion>>>,
    /// Numbers that conversions may still have.
    numbers: usize,
    /// Groups and channels that may still follow, and blocks of data that may still be looked at.
    left: usize,
    blocks: usize,
}

/// What a channel is for.
mod kind {
    pub(super) const FIXED: u8 = 0;
    pub(super) const MASTER: u8 = 2;
    pub(super) const VIRTUAL_MASTER: u8 = 3;
    pub(super) const VIRTUAL: u8 = 6;
}

/// A group of channels has records that say their lengths themselves.
const IS_OF_ANY_LENGTH: u16 = 1;
/// Of a channel: it has no valid value, or a bit that says so.
const IS_INVALID: u32 = 1;
const MAY_BE_INVALID: u32 = 2;

/// A group of channels, as far as its block says it.
struct Said<'a> {
    block: Block<'a>,
    number: u64,
    count: usize,
    flags: u16,
    data: usize,
    invalid: usize,
}

impl<'a> Scan<'a> {
    fn count(&mut self) -> Result<(), Fault> {
        self.left = self.left.checked_sub(1).ok_or_else(|| {
            let message = format!("the MDF file has more than {MOST} groups and channels; save those that are wanted, in Python with asammdf.MDF('file.mf4').filter(['q', 'alpha']).save('new.mf4')");
            of_file(code::TOO_MANY_COLUMNS, message)
        })?;
        Ok(())
    }

    fn data_group(&mut self, data: &Block<'a>) -> Result<(), Fault> {
        let number_width = data.cursor().u8().unwrap_or(0).into();
        let mut said = Vec::new();
        let mut address = data.link(1);
        while let Some(block) = Block::find(self.file, address, b"CG")? {
            self.count()?;
            address = block.link(0);
            said.push(Said::read(block).ok_or_else(|| damaged("a group of channels is cut off"))?);
        }
        let length = |said: &Said| match said.flags & IS_OF_ANY_LENGTH {
            0 => Some(said.data.saturating_add(said.invalid)),
            _ => None,
        };
        let mut lengths: Vec<_> = said
            .iter()
            .map(|said| (said.number, length(said)))
            .collect();
        lengths.sort_unstable();
        let lengths = Rc::new(lengths);
        let mut found = None;
        for said in said
            .iter()
            .filter(|said| said.flags & IS_OF_ANY_LENGTH == 0)
        {
            let length = said.data.saturating_add(said.invalid);
            let mut count = said.count;
            // records without bytes are there if the file says so
            if length > 0 && number_width == 0 {
                let (file, blocks) = (self.file, &mut self.blocks);
                let found = *found.get_or_insert_with(|| data::length(file, data.link(2), blocks));
                if self.blocks == 0 {
                    return Err(damaged("its lists of data have no end"));
                }
                let there = found.map_or(count, |bytes| bytes / length);
                count = match count {
                    // a file that was not finished does not say how many there are
                    0 => there,
                    _ => count.min(there),
                };
            }
            let records = Records {
                data: data.link(2),
                number_width,
                number: said.number,
                lengths: Rc::clone(&lengths),
                length,
                count,
            };
            self.group(said, &Rc::new(records))?;
        }
        Ok(())
    }

    fn group(&mut self, said: &Said<'a>, records: &Rc<Records>) -> Result<(), Fault> {
        let name = match said.block.text(self.file, 2) {
            name if name.is_empty() => format!("Group {}", self.groups.len() + 1),
            name => name,
        };
        let mut group = Group {
            name,
            rows: records.count,
            said: said.count.max(records.count),
            time: Time::Unknown,
            channels: Vec::new(),
        };
        let mut address = said.block.link(1);
        while let Some(block) = Block::find(self.file, address, b"CN")? {
            self.count()?;
            address = block.link(0);
            let name = block.text(self.file, 2);
            match self.channel(&block, said, records) {
                Ok((wanted, kind)) => {
                    let at = self.wanted.len();
                    self.wanted.push(wanted);
                    if kind == kind::MASTER || kind == kind::VIRTUAL_MASTER {
                        group.time = Time::Recorded(at);
                    } else {
                        let unit = self.unit(&block);
                        group.channels.push(Channel { name, unit, at });
                    }
                }
                Err(why) if records.count > 0 => {
                    self.left_out
                        .push((format!("{}/{name}", group.name), why.to_string()));
                }
                Err(_) => {}
            }
        }
        if records.count > 0 && !group.channels.is_empty() {
            self.groups.push(group);
        }
        Ok(())
    }

    /// How a channel is read, and what it is for.
    fn channel(
        &mut self,
        block: &Block<'a>,
        said: &Said,
        records: &Rc<Records>,
    ) -> Result<(Wanted, u8), &'static str> {
        let (kind, sync, field, flags) = field(block, said).ok_or("it is damaged")?;
        let is_master = kind == kind::MASTER || kind == kind::VIRTUAL_MASTER;
        if is_master && sync != 1 {
            return Err("it is a master that is not time");
        }
        if block.link(1) != 0 {
            return Err("it is an array or a structure");
        }
        if flags & IS_INVALID != 0 {
            return Err("it has no valid value");
        }
        let field = match kind {
            kind::FIXED | kind::MASTER => {
                let field = field.filter(Field::is_sound);
                Some(field.ok_or("it does not hold numbers of a usual size")?)
            }
            kind::VIRTUAL | kind::VIRTUAL_MASTER => None,
            _ => return Err("it does not hold numbers"),
        };
        let conversion = self.conversion(block.link(4));
        let wanted = Wanted {
            records: Rc::clone(records),
            field,
            conversion: conversion.ok_or("it is converted in a way that is not read")?,
        };
        Ok((wanted, kind))
    }

    fn conversion(&mut self, address: u64) -> Option<Rc<Conversion>> {
        let (file, numbers) = (self.file, &mut self.numbers);
        let read = || match address {
            0 => Some(Rc::new(Conversion::None)),
            address => {
                let block = Block::find(file, address, b"CC").ok().flatten()?;
                Conversion::read(file, &block, numbers).map(Rc::new)
            }
        };
        self.conversions.entry(address).or_insert_with(read).clone()
    }

    /// As the channel says it, or its conversion.
    fn unit(&self, block: &Block<'a>) -> String {
        let of_channel = block.text(self.file, 6);
        if !of_channel.is_empty() {
            return of_channel;
        }
        let conversion = Block::find(self.file, block.link(4), b"CC").ok().flatten();
        conversion.map_or(String::new(), |block| block.text(self.file, 1))
    }
}

impl<'a> Said<'a> {
    fn read(block: Block<'a>) -> Option<Self> {
        let mut cursor = block.cursor();
        let (number, count) = (cursor.u64()?, cursor.count()?);
        let flags = cursor.u16()?;
        cursor.take(6)?;
        let (data, invalid) = (cursor.u32()? as usize, cursor.u32()? as usize);
        Some(Self {
            block,
            number,
            count,
            flags,
            data,
            invalid,
        })
    }
}

/// What a channel is for, what its master counts, the number in a record where it is one, and flags.
fn field(block: &Block, said: &Said) -> Option<(u8, u8, Option<Field>, u32)> {
    let mut cursor = block.cursor();
    let (kind, sync, of_data) = (cursor.u8()?, cursor.u8()?, cursor.u8()?);
    let shift = u32::from(cursor.u8()?);
    let at = cursor.u32()? as usize;
    let bits = cursor.u32()?;
    let flags = cursor.u32()?;
    let bit = cursor.u32()? as usize;
    let invalid =
        (flags & MAY_BE_INVALID != 0).then(|| said.data.saturating_mul(8).saturating_add(bit));
    let field = Kind::of(of_data).map(|kind| Field {
        kind,
        at,
        shift,
        bits,
        invalid,
    });
    Some((kind, sync, field, flags))
}
