//! HDF5 files: those that MATLAB writes with `save -v7.3`, frames of pandas, and datasets as h5py writes them.
//!
//! The format is described in The HDF Group's "HDF5 File Format Specification". Crates that read it were weighed:
//! `hdf5-metno` needs the C library; `hdf5-reader`, `hdf5-pure`, `hdf5-pure-rust` and `rust-hdf5` are pure Rust, but of 30,000 to
//! 140,000 lines, where a recording needs 2,000, and none of them can be given [`Limits`]. Of the format there is here:
//! superblocks of all versions; groups as symbol tables or links, in a heap too; datasets that are compact, contiguous or in
//! chunks, packed with deflate or LZF, shuffled or not; MATLAB's arrays of structs and cells. Chunks in a tree of version 2 or
//! an extensible array, and other filters are told, with how to write the file anew.
//!
//! A file with one table, that is a frame of pandas or a dataset with fields, is read as its titles say. Of others a mapping
//! says what is what.

mod archive;
mod attribute;
mod damage;
mod dataset;
mod datatype;
mod file;
mod filters;
mod frame;
mod group;
mod header;
mod heap;
mod index;
mod layout;
mod objects;
mod packing;
mod pickle;
mod references;
mod room;
mod tree;

use super::{
    IngestError, Limits, code, columns::Columns, fault::of_file, mapping::Mapping, reading::Reading,
};
use archive::Datasets;
use file::File;

/// Whether a file has the signature, at its beginning or where MATLAB writes it.
pub(super) fn is_hdf5(bytes: &[u8]) -> bool {
    file::start(bytes).is_some()
}

/// What there is in a file.
pub(super) enum Opened<'a> {
    Table(Columns),
    Datasets(Box<Datasets<'a>>),
}

/// Looks at a file; its only table is read.
///
/// # Errors
/// The file is damaged, or has more in it than the limits allow.
pub(super) fn open<'a>(bytes: &'a [u8], limits: &Limits) -> Result<Opened<'a>, IngestError> {
    let file = File::of(bytes)?;
    let objects = objects::all(&file, limits)?;
    if let Some(columns) = frame::only(&file, &objects, limits)? {
        return Ok(Opened::Table(columns));
    }
    let datasets = Datasets::of(file, objects, limits);
    Ok(Opened::Datasets(Box::new(datasets)))
}

/// Reads datasets as the mapping says.
///
/// # Errors
/// They are not what the mapping names; or there is no mapping: then the message lists what the file has.
pub(super) fn read(
    mut datasets: Datasets,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    let Some(mapping) = mapping else {
        let message = format!(
            "an HDF5 file has no units; say with a mapping where time and channels are. This one has {}",
            datasets.contents()
        );
        return Err(of_file(code::MAPPING_NEEDED, message).into());
    };
    let mut reading = mapping.apply(&mut datasets, limits)?;
    reading.findings.extend(datasets.unpacked());
    Ok(reading)
}
