//! What stands around every handler. In which order is said in `routes`.

pub(super) mod admission;
pub(super) mod count;
pub(super) mod drain;
pub(super) mod headers;
pub(super) mod once;
