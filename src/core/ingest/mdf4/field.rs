//! A number in a record.

#[derive(Clone, Copy, Debug)]
pub(super) struct Field {
    pub(super) kind: Kind,
    /// Bytes before it, and bits.
    pub(super) at: usize,
    pub(super) shift: u32,
    pub(super) bits: u32,
    /// The bit of a record that says that there is no value.
    pub(super) invalid: Option<usize>,
}

#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Kind {
    Unsigned { is_big: bool },
    Signed { is_big: bool },
    Float { is_big: bool },
}

impl Kind {
    /// By its number in the format; `None` where it is no number.
    pub(super) fn of(number: u8) -> Option<Self> {
        let is_big = number % 2 == 1;
        Some(match number {
            0 | 1 => Self::Unsigned { is_big },
            2 | 3 => Self::Signed { is_big },
            4 | 5 => Self::Float { is_big },
            _ => return None,
        })
    }
}

impl Field {
    /// Whether it has a size that is read.
    pub(super) fn is_sound(&self) -> bool {
        match self.kind {
            Kind::Float { .. } => self.shift == 0 && [32, 64].contains(&self.bits),
            _ => self.shift < 8 && (1..=64).contains(&self.bits),
        }
    }

    /// Its value; NaN where the record has none.
    pub(super) fn read(&self, record: &[u8]) -> f64 {
        let is_invalid = self.invalid.is_some_and(|bit| {
            record
                .get(bit / 8)
                .is_none_or(|byte| byte >> (bit % 8) & 1 == 1)
        });
        if is_invalid {
            return f64::NAN;
        }
        self.number(record).unwrap_or(f64::NAN)
    }

    fn number(&self, record: &[u8]) -> Option<f64> {
        let length = (self.shift + self.bits).div_ceil(8) as usize;
        let bytes = record.get(self.at..)?.get(..length)?;
        let sum = |sum: u128, byte: &u8| sum << 8 | u128::from(*byte);
        let (Kind::Unsigned { is_big } | Kind::Signed { is_big } | Kind::Float { is_big }) =
            self.kind;
        let number = match is_big {
            true => bytes.iter().fold(0, sum),
            false => bytes.iter().rev().fold(0, sum),
        };
        let bits = (number >> self.shift & ((1 << self.bits) - 1)) as u64;
        let unused = 64 - self.bits;
        Some(match self.kind {
            Kind::Unsigned { .. } => bits as f64,
            Kind::Signed { .. } => ((bits << unused) as i64 >> unused) as f64,
            Kind::Float { .. } if self.bits == 32 => f32::from_bits(bits as u32).into(),
            Kind::Float { .. } => f64::from_bits(bits),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_bit_by_bit() {
        let read = |kind: u8, at, shift, bits, record: &[u8]| {
            let field = Field {
                kind: Kind::of(kind).unwrap(),
                at,
                shift,
                bits,
                invalid: None,
            };
            assert!(field.is_sound());
            field.read(record)
        };
        assert_eq!(read(0, 1, 4, 8, &[0, 0x10, 0x02]), 33.0);
        assert_eq!(read(1, 0, 0, 16, &[1, 2]), 258.0);
        assert_eq!(read(2, 0, 3, 4, &[0b0111_1000]), -1.0);
        assert_eq!(read(3, 0, 0, 16, &[0xff, 0xfe]), -2.0);
        assert_eq!(
            read(4, 1, 0, 64, &[&[9][..], &1.5f64.to_le_bytes()].concat()),
            1.5
        );
        assert_eq!(read(5, 0, 0, 32, &0.5f32.to_be_bytes()), 0.5);
        assert_eq!(read(0, 0, 7, 64, &[0xff; 9]), u64::MAX as f64);
        assert!(read(0, 2, 0, 8, &[1, 2]).is_nan());
        let invalid = Field {
            kind: Kind::of(0).unwrap(),
            at: 0,
            shift: 0,
            bits: 8,
            invalid: Some(9),
        };
        assert!(invalid.read(&[1, 2]).is_nan() && invalid.read(&[1, 1]) == 1.0);
    }
}
