//! How a file stores a number: its type and the order of its bytes.

/// Which byte of a number comes first.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Order {
    Little,
    Big,
}

impl Order {
    pub(super) fn u32(self, bytes: &[u8]) -> Option<u32> {
        let bytes = bytes.get(..4)?.try_into().ok()?;
        Some(match self {
            Self::Little => u32::from_le_bytes(bytes),
            Self::Big => u32::from_be_bytes(bytes),
        })
    }
}

/// A stored number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stored {
    /// Bytes of one.
    pub(super) width: usize,
    /// Reads one from so many bytes.
    pub(super) read: fn(&[u8]) -> f64,
}

/// A [`Stored`] number of a type, in an order of bytes, divided by what it is a multiple of.
macro_rules! stored {
    ($type:ty, $order:expr $(, / $per:expr)?) => {{
        let little: fn(&[u8]) -> f64 = |bytes| match bytes.try_into() {
            Ok(bytes) => <$type>::from_le_bytes(bytes) as f64 $(/ $per)?,
            Err(_) => f64::NAN,
        };
        let big: fn(&[u8]) -> f64 = |bytes| match bytes.try_into() {
            Ok(bytes) => <$type>::from_be_bytes(bytes) as f64 $(/ $per)?,
            Err(_) => f64::NAN,
        };
        $crate::ingest::stored::Stored {
            width: size_of::<$type>(),
            read: match $order {
                $crate::ingest::stored::Order::Little => little,
                $crate::ingest::stored::Order::Big => big,
            },
        }
    }};
}
pub(super) use stored;
