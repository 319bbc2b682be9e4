//! Files packed with gzip or zip, unpacked within the limits.

mod bounded;
mod gzip;
mod zip;

use std::borrow::Cow;

use super::{IngestError, Limits, code, fault::of_file, recognition::Kind};
pub(super) use zip::Zip;
#[cfg(test)]
pub(super) use zip::tests::archive;

/// How often a file may be packed into another one.
const DEEPEST: usize = 3;

/// What is left when all that is packed around a file is taken away.
pub(super) struct Unpacked<'a> {
    pub(super) bytes: Cow<'a, [u8]>,
    /// Its own name, where what it was packed into has one.
    pub(super) name: Option<String>,
}

/// Unpacks a file, as often as it is packed; a workbook, which is a zip archive itself, is left as it is.
///
/// # Errors
/// It is damaged, or becomes larger than `max_bytes`; an archive has no recording in it, or more than one.
pub(super) fn unpack<'a>(bytes: &'a [u8], limits: &Limits) -> Result<Unpacked<'a>, IngestError> {
    let mut file = Unpacked {
        bytes: Cow::Borrowed(bytes),
        name: None,
    };
    for _ in 0..DEEPEST {
        file = match Kind::of(&file.bytes) {
            Some(Kind::Gzip) => {
                let (bytes, name) = gzip::unpack(&file.bytes, limits)?;
                let without = file.name.as_deref().and_then(gzip::name_within);
                let name = name.or(without);
                Unpacked {
                    bytes: Cow::Owned(bytes),
                    name,
                }
            }
            Some(Kind::Zip) => {
                let archive = Zip::of(&file.bytes)?;
                if archive.is_workbook() {
                    return Ok(file);
                }
                let entry = archive.recording()?;
                Unpacked {
                    bytes: Cow::Owned(archive.unpack(entry, limits.max_bytes)?),
                    name: Some(entry.name.clone()),
                }
            }
            _ => return Ok(file),
        };
    }
    match Kind::of(&file.bytes) {
        Some(Kind::Gzip | Kind::Zip) => {
            let message =
                format!("the file is packed more than {DEEPEST} times; send the recording itself");
            Err(of_file(code::FORMAT_NOT_READ, message).into())
        }
        _ => Ok(file),
    }
}
