//! Names in a message.

use super::super::text::short_message;

/// Variables are listed up to this many.
const LISTED: usize = 20;

pub(super) fn listed(names: impl Iterator<Item = String>) -> String {
    let mut names = names.peekable();
    let mut list: Vec<String> = names.by_ref().take(LISTED).collect();
    if list.is_empty() {
        return "nothing".to_string();
    }
    if names.peek().is_some() {
        list.push("more".to_string());
    }
    short_message(&list.join(", "))
}
