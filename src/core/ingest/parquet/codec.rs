//! Unpacking of pages, each of which says how long it becomes.

use std::io::Read;

use flate2::read::MultiGzDecoder;
use ruzstd::decoding::StreamingDecoder;

use super::super::{code, fault::of_file};
use super::damage::damaged;
use crate::flight::Fault;

const NONE: i64 = 0;
const SNAPPY: i64 = 1;
const GZIP: i64 = 2;
const ZSTD: i64 = 6;
const LZ4_RAW: i64 = 7;

/// The bytes of a page, which become `length`: so many of `room` are taken.
///
/// # Errors
/// There is less room; the page is damaged, or packed in a way that is not read.
pub(super) fn unpack(
    codec: i64,
    packed: &[u8],
    length: usize,
    room: &mut usize,
) -> Result<Vec<u8>, Fault> {
    if length > *room {
        let message = "the Parquet file unpacks to more than the longest body that is taken; send a shorter part, or fewer columns";
        return Err(of_file(code::UNPACKED_TOO_LARGE, message));
    }
    *room -= length;
    let not_unpacked = || damaged("a page cannot be unpacked");
    let unpacked = match codec {
        NONE => packed.to_vec(),
        SNAPPY => {
            let becomes = snap::raw::decompress_len(packed);
            if becomes.ok() != Some(length) {
                return Err(not_unpacked());
            }
            let unpacked = snap::raw::Decoder::new().decompress_vec(packed);
            unpacked.map_err(|_| not_unpacked())?
        }
        GZIP => at_most(MultiGzDecoder::new(packed), length).ok_or_else(not_unpacked)?,
        ZSTD => {
            let decoder = StreamingDecoder::new(packed).map_err(|_| not_unpacked())?;
            at_most(decoder, length).ok_or_else(not_unpacked)?
        }
        LZ4_RAW => lz4_flex::block::decompress(packed, length).map_err(|_| not_unpacked())?,
        _ => return Err(not_read(codec)),
    };
    match unpacked.len() == length {
        true => Ok(unpacked),
        false => Err(damaged("a page is not as long as it says")),
    }
}

fn at_most(unpacking: impl Read, most: usize) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let room = (most as u64).saturating_add(1);
    unpacking.take(room).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}

fn not_read(codec: i64) -> Fault {
    let name = match codec {
        3 => "LZO",
        4 => "Brotli",
        5 => "LZ4 of Hadoop",
        _ => "an unknown method",
    };
    let message = format!(
        "the Parquet file is packed with {name}, which is not read; write it with Snappy, as pandas.read_parquet('file.parquet').to_parquet('new.parquet', compression='snappy')"
    );
    of_file(code::FORMAT_NOT_READ, message)
}
