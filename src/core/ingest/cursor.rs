//! Numbers and texts of a binary file, read one behind the other.

use super::stored::Order;

#[derive(Clone, Copy)]
pub(super) struct Cursor<'a> {
    rest: &'a [u8],
    order: Order,
}

impl<'a> Cursor<'a> {
    pub(super) fn of(bytes: &'a [u8], order: Order) -> Self {
        Self { rest: bytes, order }
    }

    pub(super) fn take(&mut self, length: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(length)?;
        self.rest = rest;
        Some(taken)
    }

    /// The bytes of a number, the lowest first.
    fn number<const N: usize>(&mut self) -> Option<[u8; N]> {
        let mut bytes: [u8; N] = self.take(N)?.try_into().ok()?;
        if self.order == Order::Big {
            bytes.reverse();
        }
        Some(bytes)
    }

    pub(super) fn u8(&mut self) -> Option<u8> {
        self.number().map(u8::from_le_bytes)
    }

    pub(super) fn u16(&mut self) -> Option<u16> {
        self.number().map(u16::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.number().map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> Option<u64> {
        self.number().map(u64::from_le_bytes)
    }

    pub(super) fn f64(&mut self) -> Option<f64> {
        self.number().map(f64::from_le_bytes)
    }

    /// A count, as one of elements in memory.
    pub(super) fn count(&mut self) -> Option<usize> {
        usize::try_from(self.u64()?).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_in_both_orders() {
        let bytes = [1, 2, 3, 4, 5, 6, 7];
        let mut little = Cursor::of(&bytes, Order::Little);
        assert_eq!(
            (little.u8(), little.u16(), little.u32()),
            (Some(1), Some(0x302), Some(0x706_0504))
        );
        assert_eq!(little.u8(), None);
        let mut big = Cursor::of(&bytes, Order::Big);
        assert_eq!((big.u32(), big.u16()), (Some(0x102_0304), Some(0x506)));
        assert_eq!((big.u64(), big.take(1)), (None, Some(&[7u8][..])));
    }
}
