//! Reading a request: its body, its JSON, its path and query, what it prefers. What cannot be read is a problem.

pub(super) mod body;
pub(super) mod json;
pub(super) mod multipart;
pub(super) mod prefer;
pub(super) mod query;
