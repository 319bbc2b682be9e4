//! Time stamps: seconds since 1904, and parts of 2^64 of one.

use super::super::cursor::Cursor;
use super::super::stored::Order;

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct Stamp(i128);

pub(super) const WIDTH: usize = 16;

impl Stamp {
    pub(super) fn read(bytes: &[u8], order: Order) -> Option<Self> {
        let mut cursor = Cursor::of(bytes, order);
        let (one, other) = (cursor.u64()?, cursor.u64()?);
        let (parts, seconds) = match order {
            Order::Little => (one, other),
            Order::Big => (other, one),
        };
        Some(Self(i128::from(seconds as i64) << 64 | i128::from(parts)))
    }

    /// Seconds since another.
    pub(super) fn since(self, other: Self) -> f64 {
        self.0.saturating_sub(other.0) as f64 / 2f64.powi(64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_second_count() {
        let mut bytes = (1u64 << 63).to_le_bytes().to_vec();
        bytes.extend((-3i64).to_le_bytes());
        let stamp = Stamp::read(&bytes, Order::Little).unwrap();
        let zero = Stamp::read(&[0; 16], Order::Big).unwrap();
        assert_eq!(stamp.since(zero), -2.5);
        bytes.reverse();
        assert_eq!(Stamp::read(&bytes, Order::Big), Some(stamp));
        assert_eq!(Stamp::read(&bytes[1..], Order::Big), None);
    }
}
