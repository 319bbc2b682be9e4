//! What is said of a workbook that is not as the format has it.

use super::super::{code, fault::of_file};
use crate::flight::Fault;

pub(super) fn damaged(why: &str) -> Fault {
    let message = format!("the Excel workbook is damaged: {why}; save it again, or as CSV");
    of_file(code::DAMAGED_FILE, message)
}
