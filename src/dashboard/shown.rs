//! How quantities are shown to people.

pub(super) use crate::flight::{Shown, shown_in};
