//! What is made of a stored number.

use super::block::Block;

#[derive(Clone, Debug)]
pub(super) enum Conversion {
    None,
    /// An offset and a factor.
    Linear(f64, f64),
    /// Two polynomials of second degree, one above the other.
    Rational([f64; 6]),
    /// Keys with values, in the order of the keys: on straight lines between them, or at the nearest.
    Table {
        pairs: Vec<[f64; 2]>,
        is_straight: bool,
    },
    /// From, to, and the value there; and the value elsewhere.
    Ranges(Vec<[f64; 3]>, f64),
    /// From, to, and the conversion there; and the conversion elsewhere. `None`: a text, which is no value.
    Conversions(Vec<([f64; 2], Option<Conversion>)>, Option<Box<Conversion>>),
}

/// Conversions in conversions.
const DEEPEST: u32 = 4;

impl Conversion {
    /// `None` where it is one that is not read, or has more numbers than the `room`, of which they are taken.
    pub(super) fn read(file: &[u8], block: &Block, room: &mut usize) -> Option<Self> {
        Self::within(file, block, room, DEEPEST)
    }

    fn within(file: &[u8], block: &Block, room: &mut usize, depth: u32) -> Option<Self> {
        let depth = depth.checked_sub(1)?;
        let mut cursor = block.cursor();
        let kind = cursor.u8()?;
        cursor.take(5)?;
        let count = cursor.u16()?;
        cursor.take(16)?;
        let values: Vec<f64> = (0..count).map_while(|_| cursor.f64()).collect();
        *room = room.checked_sub(values.len())?;
        Some(match (kind, &values[..]) {
            // texts that numbers stand for; but there may be conversions between them
            (7, values) if leads_to_another(file, block) => {
                let keys = values.iter().map(|key| [*key; 2]);
                Self::conversions(file, block, keys, room, depth)?
            }
            (8, values) if leads_to_another(file, block) => {
                let ranges = values.as_chunks::<2>().0.iter().copied();
                Self::conversions(file, block, ranges, room, depth)?
            }
            (0 | 7 | 8, _) => Self::None,
            (1, [offset, factor, ..]) => Self::Linear(*offset, *factor),
            (2, [a, b, c, d, e, f, ..]) => Self::Rational([*a, *b, *c, *d, *e, *f]),
            (4 | 5, [_, _, ..]) => {
                let mut pairs = values.as_chunks::<2>().0.to_vec();
                pairs.sort_by(|a, b| a[0].total_cmp(&b[0]));
                let is_straight = kind == 4;
                Self::Table { pairs, is_straight }
            }
            (6, _) => {
                let (ranges, rest) = values.as_chunks::<3>();
                Self::Ranges(ranges.to_vec(), rest.first().copied().unwrap_or(f64::NAN))
            }
            _ => return None,
        })
    }

    /// What links of a table of texts lead to, one for each range, and the last for what is in none.
    fn conversions(
        file: &[u8],
        block: &Block,
        ranges: impl Iterator<Item = [f64; 2]>,
        room: &mut usize,
        depth: u32,
    ) -> Option<Self> {
        let mut links = block.links().skip(OTHER_LINKS);
        let mut next = || -> Option<Option<Self>> {
            *room = room.checked_sub(1)?;
            match Block::read(file, links.next().unwrap_or(0)) {
                Ok(block) if block.kind == *b"CC" => {
                    Self::within(file, &block, room, depth).map(Some)
                }
                _ => Some(None),
            }
        };
        let ranges: Option<Vec<_>> = ranges.map(|range| Some((range, next()?))).collect();
        Some(Self::Conversions(ranges?, next()?.map(Box::new)))
    }

    /// NaN, which is no value, remains NaN.
    pub(super) fn apply(&self, raw: f64) -> f64 {
        if raw.is_nan() {
            return f64::NAN;
        }
        match self {
            Self::None => raw,
            Self::Linear(offset, factor) => offset + factor * raw,
            Self::Rational([a, b, c, d, e, f]) => {
                ((a * raw + b) * raw + c) / ((d * raw + e) * raw + f)
            }
            Self::Table { pairs, is_straight } => looked_up(pairs, *is_straight, raw),
            Self::Ranges(ranges, elsewhere) => {
                let is_in = |[from, to, _]: &&[f64; 3]| (*from..=*to).contains(&raw);
                ranges
                    .iter()
                    .find(is_in)
                    .map_or(*elsewhere, |[_, _, value]| *value)
            }
            Self::Conversions(ranges, elsewhere) => {
                let mut ranges = ranges.iter();
                let found = ranges.find(|([from, to], _)| (*from..=*to).contains(&raw));
                let conversion = match found {
                    Some((_, conversion)) => conversion.as_ref(),
                    None => elsewhere.as_deref(),
                };
                conversion.map_or(f64::NAN, |conversion| conversion.apply(raw))
            }
        }
    }
}

/// Links of a conversion that are not to what it leads to: its name, unit, comment, and the way back.
const OTHER_LINKS: usize = 4;

fn leads_to_another(file: &[u8], block: &Block) -> bool {
    let mut links = block.links().skip(OTHER_LINKS);
    links.any(|link| Block::read(file, link).is_ok_and(|block| block.kind == *b"CC"))
}

fn looked_up(pairs: &[[f64; 2]], is_straight: bool, raw: f64) -> f64 {
    let behind = pairs.partition_point(|[key, _]| *key < raw);
    let before = behind.checked_sub(1).and_then(|before| pairs.get(before));
    match (before, pairs.get(behind)) {
        (Some([low, of_low]), Some([high, of_high])) => {
            let share = (raw - low) / (high - low);
            match is_straight {
                true => of_low + share * (of_high - of_low),
                false if share <= 0.5 => *of_low,
                false => *of_high,
            }
        }
        (Some([_, value]), None) | (None, Some([_, value])) => *value,
        (None, None) => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bytes of a block before its links.
    const HEAD: usize = 24;

    #[test]
    fn numbers_are_within_a_budget() {
        let mut bytes = b"##CC\0\0\0\0".to_vec();
        let data = [&[1, 0, 0, 0, 0, 0, 2, 0][..], &[0; 32]].concat();
        bytes.extend((HEAD + data.len()).to_le_bytes());
        bytes.extend([0; 8]);
        bytes.extend(data);
        let block = Block::read(&bytes, 0).unwrap();
        let mut room = 3;
        assert!(Conversion::read(&bytes, &block, &mut room).is_some());
        assert!(Conversion::read(&bytes, &block, &mut room).is_none());
    }

    /// A block of a conversion: its kind, values, and what it leads to besides.
    fn block(kind: u8, values: &[f64], links: &[u64]) -> Vec<u8> {
        let count = (values.len() as u16).to_le_bytes();
        let mut data = vec![kind, 0, 0, 0, links.len() as u8, 0];
        data.extend(count);
        data.extend([0; 16]);
        data.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        let links = [&[0; OTHER_LINKS], links].concat();
        let mut bytes = b"##CC\0\0\0\0".to_vec();
        bytes.extend((HEAD + 8 * links.len() + data.len()).to_le_bytes());
        bytes.extend(links.len().to_le_bytes());
        bytes.extend(links.iter().flat_map(|link| link.to_le_bytes()));
        bytes.extend(data);
        bytes
    }

    fn read(bytes: &[u8], room: usize) -> Option<Conversion> {
        Conversion::read(bytes, &Block::read(bytes, 0).unwrap(), &mut { room })
    }

    #[test]
    fn conversions_may_stand_between_texts() {
        let linear = block(1, &[-5.0, 0.01], &[]);
        let text = b"##TX\0\0\0\0\x20\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0SNA\0\0\0\0\0";
        // 255 is a text, all else is converted
        let of = |kind: u8, values: &[f64], links: &[u64]| {
            let length = block(kind, values, links).len() as u64;
            let links: Vec<u64> = links.iter().map(|at| length + at).collect();
            [&block(kind, values, &links), &linear, &text[..]].concat()
        };
        let to_text = linear.len() as u64;
        for bytes in [
            of(7, &[255.0], &[to_text, 0]),
            of(8, &[250.0, 255.0], &[to_text, 0]),
            // the other way round: only 100 has a value
            of(7, &[100.0], &[0, to_text]),
        ] {
            let conversion = read(&bytes, 100).unwrap();
            assert_eq!(conversion.apply(100.0), -4.0);
            assert!(conversion.apply(255.0).is_nan());
            assert!(read(&bytes, 3).is_none(), "numbers and links count");
        }
        let texts = of(7, &[1.0], &[to_text, to_text]);
        assert!(matches!(read(&texts, 1), Some(Conversion::None)));
        // one that leads to itself
        let mut circle = vec![0; 8];
        circle.extend(block(7, &[1.0], &[8, 8]));
        let start = Block::read(&circle, 8).unwrap();
        assert!(Conversion::read(&circle, &start, &mut 1000).is_none());
    }

    #[test]
    fn what_is_no_value_is_not_looked_up() {
        let pairs = vec![[0.0, 10.0], [2.0, 20.0]];
        for is_straight in [true, false] {
            let pairs = pairs.clone();
            let table = Conversion::Table { pairs, is_straight };
            assert!(table.apply(f64::NAN).is_nan());
        }
        let ranges = Conversion::Ranges(vec![[0.0, 1.0, 5.0]], 7.0);
        assert!(ranges.apply(f64::NAN).is_nan());
    }

    #[test]
    fn numbers_are_converted() {
        assert_eq!(Conversion::Linear(1.0, 0.5).apply(3.0), 2.5);
        let rational = Conversion::Rational([0.0, 1.0, 2.0, 0.0, 0.0, 4.0]);
        assert_eq!(rational.apply(6.0), 2.0);
        let table = |is_straight| Conversion::Table {
            pairs: vec![[0.0, 10.0], [2.0, 20.0]],
            is_straight,
        };
        assert_eq!(table(true).apply(0.5), 12.5);
        assert_eq!(
            (table(false).apply(0.5), table(false).apply(1.5)),
            (10.0, 20.0)
        );
        assert_eq!(
            (table(true).apply(-1.0), table(true).apply(9.0)),
            (10.0, 20.0)
        );
        let ranges = Conversion::Ranges(vec![[0.0, 1.0, 5.0]], 7.0);
        assert_eq!((ranges.apply(1.0), ranges.apply(2.0)), (5.0, 7.0));
    }
}
