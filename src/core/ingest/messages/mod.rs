//! Logs of messages: tables with a time of their own, whose rows lie scattered over the file.

mod log;
mod order;
mod table;

pub(super) use log::Log;
pub(super) use order::longest_in_order;
pub(super) use table::{Field, Fields, Row, Table};
