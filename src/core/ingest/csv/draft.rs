//! The draft of a mapping for a table: what the file says, and `?` where a choice is to be made.

use super::super::{
    Limits,
    mapping::{Draft, Mapping, Repeated},
    name::Names,
};
use super::{parts, titles::Titles};
use crate::flight::Unit;

/// What a unit is that must be said.
const ASKED_FOR: &str = "?";

/// A mapping that takes every column that can be one, by its title, else by its number.
pub(super) fn of(titles: &Titles, repeated: Option<Repeated>, limits: &Limits) -> Mapping {
    let mut names = Names::new(limits);
    let mut draft = Draft::default();
    let time = (0..titles.width)
        .filter(|&at| titles.first.is_empty() || titles.first_said(at).is_some())
        .find(|&at| titles.stamp(at).is_some() || titles.any_label(at).is_called_time_or_stamp());
    let parts = parts::found(titles).filter(|parts| time.is_none_or(|at| parts.has(at)));
    let time = if parts.is_some() { None } else { time };
    for at in 0..titles.width {
        let label = titles.any_label(at);
        let from = source(titles, at);
        let unit = match label.unit {
            "" if titles.stamp(at).is_some() => "",
            "" => ASKED_FOR,
            unit if Unit::parse(unit).is_ok() => unit,
            _ => ASKED_FOR,
        };
        if parts.is_some_and(|parts| parts.has(at)) {
            continue;
        }
        if Some(at) == time {
            draft.time(&from, unit, repeated);
        } else if !titles.is_text(at)
            && !titles.has_dates(at)
            && (!titles.title(at).is_empty() || titles.names.is_none())
        {
            let name = names.take_like(if label.name.is_empty() {
                "channel"
            } else {
                label.name
            });
            draft.channel(&name, &from, unit);
        }
    }
    match parts {
        Some(parts) => {
            let stated = titles.any_label(parts.at).unit;
            let unit = if stated.is_empty() {
                parts.usual
            } else {
                stated
            };
            let parts_of = parts
                .parts
                .columns
                .map(|at| at.map(|at| source(titles, at)));
            draft.time_in_parts(parts_of, &source(titles, parts.at), unit);
        }
        None if time.is_none() => draft.even_time(),
        None => {}
    }
    draft.mapping()
}

/// A column by its title, else by its number.
fn source(titles: &Titles, at: usize) -> String {
    let alike = (0..titles.width).filter(|&other| titles.title(other) == titles.title(at));
    let is_once = alike.count() == 1;
    match titles.title(at) {
        title if !title.is_empty() && is_once => title.to_string(),
        _ => format!("(:,{})", at + 1),
    }
}
