//! The segments of a file: each says what has changed since the one before, and has some of the values.

use std::collections::HashMap;
use std::rc::Rc;

use super::super::cursor::Cursor;
use super::super::stored::Order;
use super::super::{Limits, code, fault::of_file};
use super::damage::damaged;
use super::layout::{Layout, Slot};
use super::object::{Object, Said};
use super::property;
use crate::flight::Fault;

pub(super) struct File<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) objects: Vec<Object>,
    pub(super) segments: Vec<Segment>,
}

/// Chunks of one layout, one behind the other.
pub(super) struct Segment {
    pub(super) start: usize,
    pub(super) chunks: usize,
    pub(super) layout: Rc<Layout>,
}

const HEAD: usize = 28;
/// Segments, and places of channels in all layouts of them.
const MOST_SEGMENTS: usize = 1_000_000;
const MOST_SLOTS: usize = 4_000_000;
/// Bits of what a segment is.
const HAS_META_DATA: u32 = 1 << 1;
const HAS_NEW_LIST: u32 = 1 << 2;
const HAS_DATA: u32 = 1 << 3;
const IS_INTERLEAVED: u32 = 1 << 5;
const IS_BIG_ENDIAN: u32 = 1 << 6;

/// Looks at all segments.
///
/// # Errors
/// The file is damaged, or has more channels or segments than are taken.
pub(super) fn scan<'a>(bytes: &'a [u8], limits: &Limits) -> Result<File<'a>, Fault> {
    let mut scan = Scan {
        file: File {
            bytes,
            objects: Vec::new(),
            segments: Vec::new(),
        },
        known: HashMap::new(),
        list: Vec::new(),
        has_data: Vec::new(),
        is_listed: Vec::new(),
        layout: None,
        slots: 0,
        // groups are objects, too
        most: limits.max_columns.saturating_mul(2),
    };
    let (mut at, mut count) = (0, 0);
    while let Some(head) = Head::read(bytes, at) {
        count += 1;
        scan.segment(at, &head, count)?;
        let length = usize::try_from(head.length).unwrap_or(usize::MAX);
        at = at.saturating_add(HEAD).saturating_add(length);
    }
    match count {
        0 => Err(damaged("its first segment cannot be read")),
        _ => Ok(scan.file),
    }
}

struct Head {
    flags: u32,
    /// Of all numbers behind the flags.
    order: Order,
    /// Bytes of the segment, and before its values.
    length: u64,
    values: u64,
}

impl Head {
    /// That of a segment; `None` where there is none.
    fn read(bytes: &[u8], at: usize) -> Option<Self> {
        let mut cursor = Cursor::of(bytes.get(at..)?, Order::Little);
        if cursor.take(4)? != b"TDSm" {
            return None;
        }
        let flags = cursor.u32()?;
        let order = match flags & IS_BIG_ENDIAN {
            0 => Order::Little,
            _ => Order::Big,
        };
        let mut cursor = Cursor::of(cursor.take(20)?, order);
        cursor.u32()?;
        Some(Self {
            flags,
            order,
            length: cursor.u64()?,
            values: cursor.u64()?,
        })
    }
}

struct Scan<'a> {
    file: File<'a>,
    known: HashMap<&'a [u8], usize>,
    /// The objects of the segment that have values, or had some in one before: they keep their places.
    list: Vec<usize>,
    /// Whether each is in the list, and whether it has values in the segment.
    is_listed: Vec<bool>,
    has_data: Vec<bool>,
    /// The layout of the segment before, with its bits.
    layout: Option<(u32, Rc<Layout>)>,
    slots: usize,
    most: usize,
}

impl<'a> Scan<'a> {
    fn segment(&mut self, at: usize, head: &Head, count: usize) -> Result<(), Fault> {
        let bytes = self.file.bytes;
        let wrong = || damaged(&format!("what segment {count} has cannot be read"));
        let place = |length: u64| {
            let length = usize::try_from(length).unwrap_or(usize::MAX);
            at.saturating_add(HEAD)
                .saturating_add(length)
                .min(bytes.len())
        };
        let start = place(head.values);
        if head.flags & HAS_META_DATA != 0 {
            if head.flags & HAS_NEW_LIST != 0 {
                self.list.clear();
                self.is_listed.fill(false);
                self.has_data.fill(false);
                self.layout = None;
            }
            let mut cursor = Cursor::of(&bytes[at + HEAD..start], head.order);
            match self.meta_data(&mut cursor, head.order) {
                Some(()) => {}
                // a segment that was not finished says nothing
                None if place(head.length) == bytes.len() && count > 1 => return Ok(()),
                None => return Err(wrong()),
            }
        }
        if self.file.objects.len() > self.most {
            let message = format!(
                "{} channels and groups are more than are taken; leave out channels that the estimation does not need",
                self.file.objects.len()
            );
            return Err(of_file(code::TOO_MANY_COLUMNS, message));
        }
        if head.flags & HAS_DATA == 0 {
            return Ok(());
        }
        let layout = self.layout(head).ok_or_else(wrong)?;
        let length = place(head.length).saturating_sub(start);
        let chunks = length.checked_div(layout.length).unwrap_or(0);
        if chunks > 0 {
            self.file.segments.push(Segment {
                start,
                chunks,
                layout,
            });
        }
        if self.file.segments.len() > MOST_SEGMENTS || self.slots > MOST_SLOTS {
            let message = "the TDMS file has too many segments; defragment it in LabVIEW (TDMS Defragment), or write it anew";
            return Err(of_file(code::TOO_MANY_VALUES, message));
        }
        Ok(())
    }

    fn meta_data(&mut self, cursor: &mut Cursor<'a>, order: Order) -> Option<()> {
        for _ in 0..cursor.u32()? {
            let path = property::text(cursor)?;
            let said = Said::read(cursor)?;
            let objects = &mut self.file.objects;
            let at = *self.known.entry(path).or_insert_with(|| {
                objects.push(Object::of(path));
                objects.len() - 1
            });
            if objects.len() > self.most {
                return Some(());
            }
            let object = &mut objects[at];
            let has_data = match said {
                Said::None => false,
                Said::AsBefore => object.index.is_some(),
                Said::Index(index) => {
                    if object.index != Some(index) {
                        object.index = Some(index);
                        self.layout = None;
                    }
                    true
                }
            };
            object.read_properties(cursor, order)?;
            self.is_listed.resize(self.file.objects.len(), false);
            self.has_data.resize(self.file.objects.len(), false);
            if std::mem::replace(&mut self.has_data[at], has_data) != has_data {
                self.layout = None;
            }
            // those without values have a place, too, for when they have some
            if !std::mem::replace(&mut self.is_listed[at], true) {
                self.list.push(at);
            }
        }
        Some(())
    }

    /// Where the values of a segment are; `None` where what is said of them cannot be.
    fn layout(&mut self, head: &Head) -> Option<Rc<Layout>> {
        let bits = head.flags & (IS_INTERLEAVED | IS_BIG_ENDIAN);
        if let Some((of, layout)) = &self.layout
            && *of == bits
        {
            return Some(Rc::clone(layout));
        }
        let order = head.order;
        let with_data = self.list.iter().filter(|at| self.has_data[**at]);
        let indices = with_data.filter_map(|&at| Some((at, self.file.objects[at].index?)));
        let mut layout = Layout {
            slots: vec![None; self.file.objects.len()],
            length: 0,
        };
        let is_of_daqmx = indices.clone().any(|(_, index)| index.daqmx.is_some());
        let row = |width: usize, at: usize| Slot {
            kind: super::layout::Kind::Other,
            at,
            step: width,
            count: 1,
        };
        for (at, index) in indices {
            let kind = index.values(order);
            let slot = if let Some(daqmx) = index.daqmx {
                layout.length = daqmx.row;
                Slot {
                    kind,
                    ..row(daqmx.row, daqmx.at)
                }
            } else if is_of_daqmx {
                continue;
            } else if head.flags & IS_INTERLEAVED != 0 {
                let width = index.width(order)?;
                layout.length = layout.length.checked_add(width)?;
                Slot {
                    kind,
                    ..row(width, layout.length - width)
                }
            } else {
                let start = layout.length;
                layout.length = start.checked_add(index.bytes(order)?)?;
                Slot {
                    kind,
                    at: start,
                    step: index.width(order).unwrap_or(0),
                    count: index.count,
                }
            };
            layout.slots[at] = Some(slot);
        }
        self.slots += layout.slots.len();
        let layout = Rc::new(layout);
        self.layout = Some((bits, Rc::clone(&layout)));
        Some(layout)
    }
}

impl File<'_> {
    /// How many values an object has.
    pub(super) fn count(&self, at: usize) -> usize {
        let counts = self.segments.iter().map(|segment| {
            let slot = segment.layout.slots.get(at).copied().flatten();
            slot.map_or(0, |slot| slot.count.saturating_mul(segment.chunks))
        });
        counts.fold(0, usize::saturating_add)
    }

    /// Every value of an object, as bytes.
    pub(super) fn each(&self, at: usize, mut each: impl FnMut(&Slot, &[u8])) -> Result<(), Fault> {
        for segment in &self.segments {
            let Some(slot) = segment.layout.slots.get(at).copied().flatten() else {
                continue;
            };
            for chunk in 0..segment.chunks {
                let start = segment.start + chunk * segment.layout.length;
                let chunk = self.bytes.get(start..start + segment.layout.length);
                let values = chunk.and_then(|chunk| chunk.get(slot.at..));
                let mut rest = values.ok_or_else(|| damaged("a chunk is cut off"))?;
                for _ in 0..slot.count {
                    let value = rest.get(..slot.width());
                    each(&slot, value.ok_or_else(|| damaged("a chunk is cut off"))?);
                    rest = rest.get(slot.step..).unwrap_or_default();
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first bytes of a text, and the text.
    fn text(text: &str) -> Vec<u8> {
        let mut bytes = (text.len() as u32).to_le_bytes().to_vec();
        bytes.extend(text.as_bytes());
        bytes
    }

    /// That of a segment with so many bytes of what is said, and of values.
    fn head(flags: u32, said: usize, values: usize) -> Vec<u8> {
        let mut bytes = b"TDSm".to_vec();
        bytes.extend(flags.to_le_bytes());
        bytes.extend(4713u32.to_le_bytes());
        bytes.extend(((said + values) as u64).to_le_bytes());
        bytes.extend((said as u64).to_le_bytes());
        bytes
    }

    /// A segment of objects, each with what is said of its values; all have values of one byte.
    fn segment(is_new: bool, objects: &[(&str, &[u32])], values: &[u8]) -> Vec<u8> {
        let mut said = (objects.len() as u32).to_le_bytes().to_vec();
        for (path, words) in objects {
            said.extend(text(path));
            said.extend(words.iter().flat_map(|word| word.to_le_bytes()));
            // no properties
            said.extend([0; 4]);
        }
        let flags = HAS_META_DATA | HAS_DATA | if is_new { HAS_NEW_LIST } else { 0 };
        let mut bytes = head(flags, said.len(), values.len());
        bytes.extend(said);
        bytes.extend(values);
        bytes
    }

    fn values(file: &File, at: usize) -> Vec<u8> {
        let mut values = Vec::new();
        let each = |_: &Slot, bytes: &[u8]| values.extend(bytes);
        file.each(at, each).unwrap();
        values
    }

    #[test]
    fn a_channel_that_goes_on_has_its_place() {
        // bytes, of which there are two
        let two: &[u32] = &[20, 5, 1, 2, 0];
        let (none, before): (&[u32], &[u32]) = (&[0xffff_ffff], &[0]);
        let (a, b) = ("/'G'/'a'", "/'G'/'b'");
        let mut bytes = segment(true, &[(a, two), (b, two)], &[1, 2, 11, 12]);
        bytes.extend(segment(false, &[(a, none)], &[13, 14]));
        bytes.extend(segment(false, &[(a, before)], &[3, 4, 15, 16]));
        bytes.extend(segment(false, &[(b, none)], &[5, 6]));
        let file = scan(&bytes, &Limits::default()).unwrap();
        assert_eq!(values(&file, 0), [1, 2, 3, 4, 5, 6]);
        assert_eq!(values(&file, 1), [11, 12, 13, 14, 15, 16]);
    }

    #[test]
    fn digital_lines_are_left_out_and_what_is_beside_them_is_read() {
        // one scaler in 17 bytes, then one buffer of rows of one byte
        let digital: Vec<u8> = [
            &[0x6a, 0x12, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0][..],
            &[3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0],
            &[0; 17],
            &[1, 0, 0, 0, 1, 0, 0, 0],
            // no properties
            &[0; 4],
        ]
        .concat();
        let mut said = 1u32.to_le_bytes().to_vec();
        said.extend(text("/'G'/'line'"));
        said.extend(digital);
        let mut bytes = head(HAS_META_DATA | HAS_NEW_LIST | HAS_DATA, said.len(), 3);
        bytes.extend(said);
        bytes.extend([1, 0, 1]);
        bytes.extend(segment(true, &[("/'G'/'a'", &[20, 5, 1, 2, 0])], &[1, 2]));
        let file = scan(&bytes, &Limits::default()).unwrap();
        assert_eq!((file.count(0), file.count(1)), (3, 2));
        let groups = super::super::groups::of(file);
        assert_eq!(groups.groups.len(), 1);
        assert_eq!(groups.left_out.len(), 1);
        assert!(groups.left_out[0].1.contains("digital"));
    }
}
