//! A name in a spec that the model does not have.

use super::Fault;
use crate::flight::escape;

/// The fault at `pointer`/`name`; `what` the name was to be, and which of that kind there are.
pub(super) fn unknown_name<'n>(
    pointer: &str,
    code: &'static str,
    (what, name): (&str, &str),
    known: impl Iterator<Item = &'n str>,
) -> Fault {
    let known: Vec<&str> = known.collect();
    let has = match known.is_empty() {
        true => "none".to_string(),
        false => known.join(", "),
    };
    let message = format!("the model has no {what} '{name}'; it has {has}");
    Fault::new(format!("{pointer}/{}", escape(name)), code, message)
}
