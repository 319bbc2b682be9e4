//! MAT files of version 5, which MATLAB writes with `save -v6` and `save -v7`: matrices, structs of them and arrays of
//! structs; and of version 4, which has matrices only.
//!
//! The format is described in MathWorks' "MAT-File Format" (R2019b). Only what a mapping asks for is unpacked; numbers
//! are read from where they stand. A file cannot ask for more memory than [`Limits`] allow.

mod array;
mod element;
mod structs;
mod variables;
mod version4;
mod version5;

use crate::flight::Fault;

use super::{
    IngestError, Limits, code,
    fault::of_file,
    mapping::{Archive, Mapping},
    reading::Reading,
    stored::Order,
};
use element::damaged;
use version4::Version4;
pub(super) use version4::is_version_4;
use version5::Version5;

const HEADER: usize = 128;

/// Reads a MAT file as the mapping says.
///
/// # Errors
/// It is no MAT file of version 5, is damaged, or does not have what the mapping names; or there is no mapping: then the
/// message lists what the file has.
pub(super) fn read(
    bytes: &[u8],
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    if is_version_4(bytes) {
        let mut file = Version4::of(bytes, limits)?;
        let contents = file.contents();
        return map(&mut file, &contents, mapping, limits);
    }
    let order = byte_order(bytes)?;
    let mut file = Version5::of(&bytes[HEADER..], order, limits)?;
    let contents = file.contents();
    map(&mut file, &contents, mapping, limits)
}

fn map(
    file: &mut impl Archive,
    contents: &str,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    let Some(mapping) = mapping else {
        let message = format!(
            "a MAT file has no units; say with a mapping where time and channels are. This one has {contents}"
        );
        return Err(of_file(code::MAPPING_NEEDED, message).into());
    };
    mapping.apply(file, limits)
}

/// # Errors
/// It is another file; what to do about it.
fn byte_order(bytes: &[u8]) -> Result<Order, Fault> {
    if bytes.is_empty() {
        return Err(of_file(
            code::EMPTY_BODY,
            "the file is empty; send a MAT file",
        ));
    }
    if bytes.starts_with(b"MATLAB 7.3") {
        return Err(damaged("it is cut off behind its header"));
    }
    match bytes.get(124..HEADER) {
        Some([0x00, 0x01, b'I', b'M']) => Ok(Order::Little),
        Some([0x01, 0x00, b'M', b'I']) => Ok(Order::Big),
        _ if bytes.starts_with(b"MATLAB 5.0") => Err(damaged("its header is incomplete")),
        _ => {
            let message = "this is not a MAT file; send a matrix of numbers as text/plain, and other recordings as CSV or JSON";
            Err(of_file(code::NOT_A_MAT_FILE, message))
        }
    }
}
