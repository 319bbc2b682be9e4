//! That a file is damaged, or holds something in a way that is not read.

use super::super::{code, fault::of_file};
use crate::flight::Fault;

pub(super) fn damaged(why: &str) -> Fault {
    let message = format!("the HDF5 file is damaged: {why}; copy it again, or write it once more");
    of_file(code::DAMAGED_FILE, message)
}

/// How a file is written that is read: in Python, and in a shell.
pub(super) const REWRITE: &str = "write it anew, in Python with h5py.File('new.h5', 'w', libver='earliest') and compression='gzip', or with h5repack -f GZIP=1 file.h5 new.h5";
