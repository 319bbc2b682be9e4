//! Which of the lines above the rows has names, which units, and which descriptions.

use super::super::{
    cell::{is_missing, unquote},
    label::Label,
    lines::Line,
    name::is_identifier,
};
use super::sample::Held;
use crate::flight::Unit;

/// The lines of a header by what they are.
#[derive(Default)]
pub(super) struct Head<'a> {
    pub(super) names: Option<(Line<'a>, Vec<&'a str>)>,
    pub(super) units: Option<(Line<'a>, Vec<&'a str>)>,
    /// Those that are neither.
    pub(super) others: Vec<Line<'a>>,
}

impl<'a> Head<'a> {
    pub(super) fn of(above: Vec<(Line<'a>, Vec<&'a str>)>) -> Self {
        let mut rows: Vec<(Line, Vec<&str>)> = above
            .into_iter()
            .map(|(line, cells)| (line, cells.into_iter().map(unquote).collect()))
            .collect();
        // of two that might be names as well, the upper one has the names
        let last_best =
            |best: (usize, f64), other: (usize, f64)| if other.1 >= best.1 { other } else { best };
        let first_best =
            |best: (usize, f64), other: (usize, f64)| if other.1 > best.1 { other } else { best };
        let is_of_units_alone = matches!(&rows[..], [(_, cells)] if are_bracketed_units(cells));
        let units = (rows.iter().enumerate())
            .map(|(at, (_, cells))| (at, share_of_units(cells)))
            .reduce(last_best)
            .filter(|&(_, share)| (rows.len() > 1 || is_of_units_alone) && share >= 0.6)
            .map(|(at, _)| rows.remove(at));
        let names = (rows.iter().enumerate())
            .map(|(at, (_, cells))| (at, likeness_to_names(cells)))
            .filter(|&(_, likeness)| likeness > 0.0)
            // of long names with units and short ones without, those with units tell more
            .map(|(at, likeness)| match &units {
                Some(_) => (at, likeness),
                None => (at, likeness + 2.0 * share_with_units(&rows[at].1)),
            })
            .reduce(first_best)
            .map(|(at, _)| rows.remove(at));
        let [names, units] = [names, units].map(|row| row.map(without_word_for_row));
        let (names, units) = match (names, units) {
            (Some(names), None) => with_units_before(names),
            other => other,
        };
        Self {
            names,
            units,
            others: rows.into_iter().map(|(line, _)| line).collect(),
        }
    }
}

type Row<'a> = (Line<'a>, Vec<&'a str>);

/// Whether every cell that says something is a unit in brackets: `(SEC) (DEG)`.
fn are_bracketed_units(cells: &[&str]) -> bool {
    let mut said = cells.iter().filter(|cell| !cell.is_empty()).peekable();
    said.peek().is_some()
        && said.all(|cell| {
            let inner = cell.strip_prefix(['(', '[']);
            let inner = inner.and_then(|cell| cell.strip_suffix([')', ']']));
            inner.is_some_and(|unit| Unit::parse(unit).is_ok())
        })
}

/// `ChannelTitle=` before the titles says what the line is, and is no title.
fn without_word_for_row((line, mut names): Row) -> Row {
    let is_word = |cell: &str| cell.ends_with(['=', ':']);
    if let [first, others @ ..] = names.as_mut_slice()
        && is_word(first)
        && !others.iter().any(|other| is_word(other))
    {
        *first = "";
    }
    (line, names)
}

/// Names with their units before them, where nearly all are written so: `degrees/Pitch`, `knots/IAS`.
fn with_units_before<'a>((line, cells): Row<'a>) -> (Option<Row<'a>>, Option<Row<'a>>) {
    let parted = |cell: &&'a str| {
        let (unit, name) = cell.split_once('/')?;
        let are_said = !unit.is_empty() && !name.is_empty();
        let is_one = are_said && Unit::parse(unit).is_ok() && Unit::parse(cell).is_err();
        is_one.then_some((unit, name))
    };
    let said = cells.iter().filter(|cell| !cell.is_empty()).count();
    let all: Vec<Option<(&str, &str)>> = cells.iter().map(parted).collect();
    if said < 3 || all.iter().flatten().count() * 10 < said * 8 {
        return (Some((line, cells)), None);
    }
    let both = all.iter().zip(&cells);
    let names = both.map(|(parted, cell)| parted.map_or(*cell, |(_, name)| name));
    let units = all.iter().map(|parted| parted.map_or("", |(unit, _)| unit));
    (Some((line, names.collect())), Some((line, units.collect())))
}

/// How many of the cells that are not empty are units.
pub(super) fn share_of_units(cells: &[&str]) -> f64 {
    let said: Vec<&str> = cells
        .iter()
        .map(|cell| unquote(cell))
        .filter(|cell| !cell.is_empty())
        .collect();
    let is_unit = |cell: &&&str| {
        let is_clock = ["utc", "hh:mm:ss"].contains(&cell.to_ascii_lowercase().as_str());
        is_clock || is_missing(cell) || Unit::parse(cell.trim_matches(['[', ']', '(', ')'])).is_ok()
    };
    let is_word = said.iter().any(|cell| Held::by(cell) == Held::Text);
    if said.is_empty() || !is_word {
        return 0.0;
    }
    said.iter().filter(|cell| is_unit(cell)).count() as f64 / said.len() as f64
}

/// How many of the cells that are not empty have a unit behind their name.
fn share_with_units(cells: &[&str]) -> f64 {
    let said = cells.iter().filter(|cell| !cell.is_empty());
    let labels: Vec<Label> = said.map(|cell| Label::split(cell)).collect();
    let has_unit = |label: &&Label| !label.unit.is_empty() && Unit::parse(label.unit).is_ok();
    labels.iter().filter(has_unit).count() as f64 / labels.len().max(1) as f64
}

/// Names that flight-test recordings usually have.
const USUAL: [&str; 34] = [
    "t",
    "time",
    "timestamp",
    "alpha",
    "beta",
    "p",
    "q",
    "r",
    "u",
    "v",
    "w",
    "phi",
    "theta",
    "psi",
    "de",
    "da",
    "dr",
    "ax",
    "ay",
    "az",
    "nx",
    "ny",
    "nz",
    "V",
    "h",
    "mach",
    "qbar",
    "pitch",
    "roll",
    "yaw",
    "lat",
    "lon",
    "alt",
    "ias",
];

/// Names are words, all different, short, and some of them usual. Channel numbers are none.
fn likeness_to_names(cells: &[&str]) -> f64 {
    let said: Vec<&str> = cells
        .iter()
        .copied()
        .filter(|cell| !cell.is_empty())
        .collect();
    if said.is_empty() || said.iter().all(|cell| Held::by(cell) != Held::Text) {
        return 0.0;
    }
    let share = |of: &dyn Fn(&str) -> bool| {
        said.iter().filter(|cell| of(cell)).count() as f64 / said.len() as f64
    };
    let name = |cell: &str| Label::split(cell).name.to_string();
    let are_identifiers = share(&|cell| is_identifier(&name(cell)));
    let are_usual = share(&|cell| {
        USUAL
            .iter()
            .any(|usual| name(cell).eq_ignore_ascii_case(usual))
    });
    let mut distinct = said.clone();
    distinct.sort_unstable();
    distinct.dedup();
    let are_distinct = distinct.len() as f64 / said.len() as f64;
    let length = said.iter().map(|cell| cell.len()).sum::<usize>() as f64 / said.len() as f64;
    let fullness = said.len() as f64 / cells.len() as f64;
    0.01 + are_identifiers + are_usual + are_distinct + fullness - 0.005 * length.min(100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cells of names, and those of units.
    fn roles(rows: &[&'static str]) -> (String, String) {
        let above = rows.iter().enumerate().map(|(at, row)| {
            let line = Line {
                number: at + 1,
                text: row,
            };
            (line, row.split(';').collect())
        });
        let head = Head::of(above.collect());
        let text = |row: Option<(Line, Vec<&str>)>| {
            row.map_or(String::new(), |(_, cells)| cells.join(";"))
        };
        (text(head.names), text(head.units))
    }

    #[test]
    fn names_units_and_descriptions_stand_in_any_order() {
        let names = "t;alpha;q";
        let units = "s;deg;deg/s";
        let words = "Time since start;Angle of attack;Pitch rate";
        for rows in [
            [names, units, words],
            [names, words, units],
            [units, names, words],
            [units, words, names],
            [words, names, units],
            [words, units, names],
        ] {
            assert_eq!(
                roles(&rows),
                (names.to_string(), units.to_string()),
                "{rows:?}"
            );
        }
        assert_eq!(
            roles(&["V;h;m", "kt;ft;kg"]),
            ("V;h;m".to_string(), "kt;ft;kg".to_string())
        );
        assert_eq!(roles(&["V;h;m"]).0, "V;h;m");
        assert_eq!(roles(&["1;2;3", "t;a;b"]).0, "t;a;b");
        assert_eq!(
            roles(&["t;a;b", ";;"]),
            ("t;a;b".to_string(), String::new())
        );
        assert_eq!(roles(&["t;a;b", "float;float;float"]).0, "t;a;b");
        assert_eq!(roles(&["Titles=;a;b"]).0, ";a;b");
        assert_eq!(roles(&["t:;a:;b:"]).0, "t:;a:;b:");
        let before = roles(&["seconds/t;degrees/Pitch;G/G-load"]);
        assert_eq!(before.0, "t;Pitch;G-load");
        assert_eq!(before.1, "seconds;degrees;G");
        assert_eq!(
            roles(&["/imu/q;/imu/az;/fcs/de"]).0,
            "/imu/q;/imu/az;/fcs/de"
        );
        assert_eq!(
            roles(&["(s);(deg)"]),
            (String::new(), "(s);(deg)".to_string())
        );
        assert_eq!(
            roles(&["[s];[deg];1", names]),
            (names.to_string(), "[s];[deg];1".to_string())
        );
    }
}
