//! How long columns of numbers are kept: maneuvers and time histories.
//!
//! ```text
//! "TTC1" | rows: u64 | columns: u32 | header length: u32 | header: JSON | column, column, ...
//! ```
//!
//! All little-endian; a column is its rows as f64. Exact, NaN included, where JSON has none, and read
//! about as fast as memory is copied.

use serde::Serialize;
use serde::de::DeserializeOwned;

const MAGIC: &[u8; 4] = b"TTC1";
const PREFIX: usize = 4 + 8 + 4 + 4;

/// Why bytes cannot be read back. The store wrote them: the file was damaged, or is of a later version.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("not a table of columns: {0}")]
pub(super) struct Unreadable(&'static str);

/// All `columns` have one length.
pub(super) fn encode(header: &impl Serialize, columns: &[&[f64]]) -> serde_json::Result<Vec<u8>> {
    let header = serde_json::to_vec(header)?;
    let rows = columns.first().map_or(0, |column| column.len());
    debug_assert!(columns.iter().all(|column| column.len() == rows));
    let mut bytes = Vec::with_capacity(PREFIX + header.len() + 8 * rows * columns.len());
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&(rows as u64).to_le_bytes());
    bytes.extend_from_slice(&(columns.len() as u32).to_le_bytes());
    bytes.extend_from_slice(&(header.len() as u32).to_le_bytes());
    bytes.extend_from_slice(&header);
    for value in columns.iter().copied().flatten() {
        bytes.extend_from_slice(&value.to_le_bytes());
    }
    Ok(bytes)
}

/// The header and the columns.
pub(super) fn decode<H: DeserializeOwned>(bytes: &[u8]) -> Result<(H, Vec<Vec<f64>>), Unreadable> {
    let truncated = Unreadable("it is truncated");
    let (prefix, rest) = bytes.split_at_checked(PREFIX).ok_or(truncated.clone())?;
    let (magic, prefix) = prefix.split_at(4);
    if magic != MAGIC {
        return Err(Unreadable("it does not begin with TTC1"));
    }
    let (rows, prefix) = prefix.split_at(8);
    let (columns, header) = prefix.split_at(4);
    let [rows, columns, header] = [rows, columns, header].map(little_endian);
    let (header, body) = rest.split_at_checked(header).ok_or(truncated.clone())?;
    let header =
        serde_json::from_slice(header).map_err(|_| Unreadable("its header is of another kind"))?;
    let expected = rows
        .checked_mul(8)
        .and_then(|column| column.checked_mul(columns));
    if expected != Some(body.len()) {
        return Err(truncated);
    }
    let column = |bytes: &[u8]| {
        let (values, _) = bytes.as_chunks::<8>();
        values
            .iter()
            .map(|value| f64::from_le_bytes(*value))
            .collect()
    };
    let columns = match rows {
        0 => vec![Vec::new(); columns.min(1 << 20)],
        rows => body.chunks_exact(8 * rows).map(column).collect(),
    };
    Ok((header, columns))
}

fn little_endian(bytes: &[u8]) -> usize {
    let value = bytes
        .iter()
        .rev()
        .fold(0u64, |value, byte| value << 8 | u64::from(*byte));
    usize::try_from(value).unwrap_or(usize::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_bit_for_bit() {
        let column = [0.1, -0.0, f64::NAN, f64::INFINITY, 5e-324];
        let bytes = encode(&"header", &[&column, &[1.0; 5]]).unwrap();
        let (header, columns): (String, _) = decode(&bytes).unwrap();
        assert_eq!(header, "header");
        let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&columns[0]), bits(&column));
        assert_eq!(columns[1], [1.0; 5]);
    }

    #[test]
    fn damage_is_an_error_wherever_it_is() {
        let bytes = encode(&"header", &[&[1.0, 2.0]]).unwrap();
        for end in 0..bytes.len() {
            assert!(decode::<String>(&bytes[..end]).is_err(), "cut at {end}");
        }
        for at in 0..PREFIX {
            let mut bytes = bytes.clone();
            bytes[at] ^= 0xff;
            assert!(decode::<String>(&bytes).is_err(), "flipped at {at}");
        }
        assert!(decode::<u32>(&bytes).is_err());
    }
}
