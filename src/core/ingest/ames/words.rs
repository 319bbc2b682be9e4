//! What a line of a header says in words: a name, and a unit.

use super::super::{label::Label, units::RecordedUnit};

/// Name and unit of a variable: `Pitch rate [deg/s]`, `q, deg/s, pitch rate`, `Time [seconds]; since midnight`. The unit is `-`
/// where it is said to be none, and `None` where nothing is said of it.
pub(super) fn named(said: &str) -> (&str, Option<&str>) {
    let said = said.split(';').next().unwrap_or_default().trim();
    if let Some((name, rest)) = said.split_once('[')
        && let Some((unit, _)) = rest.split_once(']')
    {
        return (name.trim(), unit_of(unit));
    }
    let mut fields = said.split(',').map(str::trim);
    let label = Label::split(fields.next().unwrap_or_default());
    (label.name, unit_of(fields.next().unwrap_or(label.unit)))
}

/// A unit as it is written here; `None` where nothing is.
pub(super) fn unit_of(unit: &str) -> Option<&str> {
    match unit.trim() {
        "" => None,
        unit if is_none(unit) => Some("-"),
        unit => Some(unit),
    }
}

/// Whether a word says that there is no unit.
fn is_none(unit: &str) -> bool {
    let words = ["none", "unitless", "dimensionless", "n/a", "#", "number"];
    words.iter().any(|word| unit.eq_ignore_ascii_case(word))
}

/// The unit of the time that a line describes: the one that stands where units do, else the only one among its words before
/// those that say where it begins: `Elapsed UT seconds from 0 hours on the day given by DATE`.
pub(super) fn unit_of_time(said: &str) -> Option<&str> {
    let is_of_time = |unit: &&str| RecordedUnit::parse_time(unit).is_ok();
    let (_, unit) = named(said);
    if let Some(unit) = unit.filter(is_of_time) {
        return Some(unit);
    }
    // what stands in brackets is the unit, and no other word is
    if said.contains('[') {
        return None;
    }
    let words = said.split(|c: char| !c.is_alphanumeric());
    let words = words.take_while(|word| {
        let beginnings = ["from", "since", "after", "past", "on"];
        !beginnings
            .iter()
            .any(|other| word.eq_ignore_ascii_case(other))
    });
    let mut units = words.filter(is_of_time);
    let first = units.next()?;
    units.next().is_none().then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_time_are_found_where_they_are_said() {
        for (said, unit) in [
            ("Time [seconds]; UT seconds from midnight", Some("seconds")),
            ("Time_Start, seconds, since midnight UTC", Some("seconds")),
            (
                "Elapsed UT seconds from 0 hours on day given by DATE",
                Some("seconds"),
            ),
            ("Time (h)", Some("h")),
            ("Time_Start, seconds since midnight", Some("seconds")),
            ("Time [fortnights]; seconds of them", None),
            ("Universal time", None),
            ("Hours and seconds since midnight", None),
            ("", None),
        ] {
            assert_eq!(unit_of_time(said), unit, "{said}");
        }
    }

    #[test]
    fn no_unit_is_another_thing_than_nothing_said() {
        for (said, named_as) in [
            ("Mach number [none]", ("Mach number", Some("-"))),
            ("Mach number", ("Mach number", None)),
            ("M, unitless, Mach number", ("M", Some("-"))),
            ("Pitch rate [deg/s]", ("Pitch rate", Some("deg/s"))),
        ] {
            assert_eq!(named(said), named_as, "{said}");
        }
    }
}
