//! Unpacking within a bound of bytes.

use std::io::Read;

use super::super::{code, fault::of_file};
use crate::flight::Fault;

/// At most `most` bytes of what is unpacked.
pub(super) fn read(unpacking: impl Read, most: usize, what: &str) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::new();
    let room = (most as u64).saturating_add(1);
    let read = unpacking.take(room).read_to_end(&mut bytes);
    if bytes.len() > most {
        return Err(too_large(what, most));
    }
    match read {
        Ok(_) => Ok(bytes),
        Err(error) => Err(damaged(what, &error.to_string())),
    }
}

fn too_large(what: &str, most: usize) -> Fault {
    let message = format!(
        "the {what} unpacks to more than {most} bytes, the longest body that is taken; send a shorter part, or fewer channels"
    );
    of_file(code::UNPACKED_TOO_LARGE, message)
}

pub(super) fn damaged(what: &str, why: &str) -> Fault {
    let message =
        format!("the {what} is damaged: {why}; upload it again, packed anew or saved as CSV");
    of_file(code::DAMAGED_FILE, message)
}
