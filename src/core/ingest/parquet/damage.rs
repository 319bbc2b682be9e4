//! That a file is damaged.

use super::super::{code, fault::of_file};
use crate::flight::Fault;

pub(super) fn damaged(why: &str) -> Fault {
    let message =
        format!("the Parquet file is damaged: {why}; copy it again, or write it once more");
    of_file(code::DAMAGED_FILE, message)
}
