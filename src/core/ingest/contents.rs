//! What a file has in it, once all that is packed around it is taken away.

use std::borrow::Cow;

use super::{
    IngestError, Limits, ames, dataflash, flysight,
    format::Format,
    mat, octave,
    packed::{self, Unpacked},
    recognition::Kind,
};

/// How a recording is read.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Contents {
    Ulog,
    DataFlash,
    Mat,
    Json,
    Workbook,
    Parquet,
    Hdf5,
    Tdms,
    Mdf4,
    FlySight,
    /// A table of text whose header says more of it.
    Ames,
    /// Variables as Octave writes them as text.
    Octave,
    /// A table of text.
    Table,
    /// A table of text, or a matrix of which a mapping names the parts.
    TableOrMatrix,
}

/// A file that is unpacked and recognised.
pub(super) struct Opened<'a> {
    pub(super) bytes: Cow<'a, [u8]>,
    pub(super) contents: Contents,
}

/// Unpacks a file and recognises it by its first bytes, else by its name in what it was packed into, else by what its sender
/// says.
///
/// # Errors
/// It cannot be unpacked, or is of a format that is not read.
pub(super) fn open<'a>(
    bytes: &'a [u8],
    format: Format,
    limits: &Limits,
) -> Result<Opened<'a>, IngestError> {
    let Unpacked { bytes, name } = packed::unpack(bytes, limits)?;
    let extension = name.as_deref().and_then(|name| name.rsplit_once('.'));
    let of_name = extension.and_then(|(_, extension)| Format::from_extension(extension));
    let contents = match Kind::of(&bytes) {
        Some(Kind::Ulog) => Contents::Ulog,
        Some(Kind::DataFlash) => Contents::DataFlash,
        Some(Kind::Mat) => Contents::Mat,
        Some(Kind::Parquet) => Contents::Parquet,
        None if mat::is_version_4(&bytes) => Contents::Mat,
        Some(Kind::Zip) => Contents::Workbook,
        Some(Kind::Hdf5) => Contents::Hdf5,
        Some(Kind::Tdms) => Contents::Tdms,
        Some(Kind::Mdf4) => Contents::Mdf4,
        Some(Kind::Foreign(foreign)) => return Err(foreign.fault().into()),
        None if flysight::is_of_several(&bytes) => Contents::FlySight,
        None if dataflash::is_text(&bytes) => Contents::DataFlash,
        None if octave::is_octave(&bytes) => Contents::Octave,
        None if ames::is_ames(&bytes) => Contents::Ames,
        Some(Kind::Gzip) | None => of_text(&bytes, of_name.unwrap_or(format)),
    };
    Ok(Opened { bytes, contents })
}

fn of_text(bytes: &[u8], format: Format) -> Contents {
    match format {
        Format::Csv => Contents::Table,
        Format::Json => Contents::Json,
        Format::Mat => Contents::Mat,
        Format::Unstated if bytes.trim_ascii_start().starts_with(b"{") => Contents::Json,
        Format::Ascii | Format::Unstated => Contents::TableOrMatrix,
    }
}
