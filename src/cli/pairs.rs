//! Options of the form NAME=VALUE.

use super::Failure;

/// What is said of one name twice would count once, and which is not plain to see.
pub(super) fn once(option: &str, name: &str, again: bool) -> Result<(), Failure> {
    match again {
        true => Err(Failure::new(format!("{option} names '{name}' twice"))),
        false => Ok(()),
    }
}

/// The two sides of it.
pub(super) fn pair<'a>(text: &'a str, option: &str) -> Result<(&'a str, &'a str), Failure> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => Ok((name.trim(), value.trim())),
        _ => Err(Failure::new(format!(
            "{option} '{text}' should read NAME=VALUE"
        ))),
    }
}
