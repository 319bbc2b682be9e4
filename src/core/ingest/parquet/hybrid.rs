//! Small numbers in few bits: runs of one number, and others packed.

/// `count` numbers of `width` bits. `None` where there are not so many.
pub(super) fn numbers(mut bytes: &[u8], width: u32, count: usize) -> Option<Vec<u32>> {
    let mut numbers = Vec::with_capacity(count.min(bytes.len().saturating_mul(8)));
    if width > 32 {
        return None;
    }
    if width == 0 {
        numbers.resize(count, 0);
    }
    while numbers.len() < count {
        let head = varint(&mut bytes)?;
        let left = count - numbers.len();
        let run = usize::try_from(head >> 1).ok()?;
        if head & 1 == 0 {
            let (value, rest) = bytes.split_at_checked(width.div_ceil(8) as usize)?;
            bytes = rest;
            let value = value
                .iter()
                .rev()
                .fold(0, |sum, &byte| sum << 8 | u32::from(byte));
            numbers.extend(std::iter::repeat_n(value, run.min(left)));
            continue;
        }
        let packed = run.saturating_mul(width as usize).min(bytes.len());
        let mut bits = Bits::of(&bytes[..packed]);
        for _ in 0..run.saturating_mul(8).min(left) {
            numbers.push(bits.next(width)? as u32);
        }
        bytes = &bytes[packed..];
    }
    Some(numbers)
}

pub(super) fn varint(bytes: &mut &[u8]) -> Option<u64> {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let (&byte, rest) = bytes.split_first()?;
        *bytes = rest;
        value |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Some(value);
        }
    }
    None
}

/// Numbers of any width, the lowest bit of each first.
pub(super) struct Bits<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Bits<'a> {
    pub(super) fn of(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    /// The next number of up to 64 bits.
    pub(super) fn next(&mut self, width: u32) -> Option<u64> {
        let end = self.at.checked_add(width as usize)?;
        if end > self.bytes.len().saturating_mul(8) {
            return None;
        }
        let rest = &self.bytes[self.at / 8..];
        let window = match rest.first_chunk::<16>() {
            Some(window) => *window,
            None => {
                let mut window = [0; 16];
                window[..rest.len()].copy_from_slice(rest);
                window
            }
        };
        let shifted = u128::from_le_bytes(window) >> (self.at % 8);
        self.at = end;
        Some((shifted & ((1u128 << width) - 1)) as u64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_and_packed_numbers() {
        // 3 times 5, and eight numbers of 3 bits
        let bytes = [0x06, 0x05, 0x03, 0x88, 0xc6, 0xfa];
        let expected = [5, 5, 5, 0, 1, 2, 3, 4, 5, 6, 7];
        assert_eq!(numbers(&bytes, 3, 11).as_deref(), Some(&expected[..]));
        assert_eq!(numbers(&bytes, 3, 5).as_deref(), Some(&expected[..5]));
        assert_eq!(numbers(&bytes, 3, 12), None);
        assert_eq!(numbers(&bytes[..5], 3, 11), None);
        assert_eq!(numbers(&[], 0, 2), Some(vec![0, 0]));
        assert_eq!(numbers(&[], 1, 1), None);
        let mut bits = Bits::of(&[0xff; 9]);
        assert_eq!((bits.next(5), bits.next(64)), (Some(31), Some(u64::MAX)));
        assert_eq!(bits.next(4), None);
    }
}
