//! Where in a file a channel's values are: `fdata(:,4)`, `rec.alpha`, `(:,4)`, `scope.signals(1).values`, `imu.xyz[0]`.

use std::fmt;
use std::str::FromStr;

use super::super::{code, text::short_message};
use super::{Archive, Titles};

/// A variable, fields of it, and perhaps one column or row.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(in super::super) struct Source {
    /// The variable and the fields on the way, each as it is written, an element of an array with its number: `signals(1)`
    /// counted from 1, `xyz[0]` counted from 0. Empty: the only matrix of the file.
    pub(in super::super) path: Vec<String>,
    pub(in super::super) part: Part,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in super::super) enum Part {
    Whole,
    /// From 1, as in `x(:,1)`.
    Column(usize),
    /// From 1, as in `x(1,:)`.
    Row(usize),
}

/// Names on a path; a struct that is nested deeper is no recording.
const LONGEST_PATH: usize = 8;

const SHAPE: &str =
    "in brackets there is one column, as (:,3), or one row, as (3,:), counted from 1";

impl Source {
    /// All of what is at a path.
    pub(super) fn whole(path: Vec<String>) -> Self {
        let part = Part::Whole;
        Self { path, part }
    }

    /// The source that is meant: of several the first that the file has.
    ///
    /// # Errors
    /// None of them is a source; why.
    pub(super) fn meant(from: &Titles, archive: &mut impl Archive) -> Result<Self, String> {
        let mut sources = Vec::new();
        let mut why = "it is empty".to_string();
        for text in from.iter() {
            match text.parse::<Self>() {
                Ok(source) => sources.push(source),
                Err(wrong) => {
                    let text = short_message(text);
                    why = format!(
                        "mapping: '{text}' is not a source such as fdata(:,4), rec.alpha or (:,4): {wrong}"
                    );
                }
            }
        }
        let is_there =
            |source: &Self| !matches!(archive.matrix(&source.path), Err((code::UNKNOWN_SOURCE, _)));
        let found = match sources.len() {
            0 | 1 => None,
            _ => sources.iter().position(is_there),
        };
        sources.into_iter().nth(found.unwrap_or(0)).ok_or(why)
    }
}

impl FromStr for Source {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let text = text.trim();
        let (path, part) = match text.rsplit_once('(') {
            // the brackets of an element on the way have a name behind them
            Some((path, index)) if !index.contains('.') => (path.trim_end(), part(index)?),
            _ => (text, Part::Whole),
        };
        let path: Vec<String> = match path {
            "" => Vec::new(),
            // a slash stands between groups of HDF5
            path => path
                .trim_start_matches('/')
                .split(['.', '/'])
                .map(|name| name.trim().to_string())
                .collect(),
        };
        if !path.iter().all(|name| is_name(name)) {
            return Err(
                "names have letters, digits and '_' only, with dots between a struct and its fields; an element of an array is signals(1), counted from 1, or xyz[0], counted from 0",
            );
        }
        if path.len() > LONGEST_PATH {
            return Err("there are more than 8 names in it");
        }
        if path.is_empty() && part == Part::Whole {
            return Err("it is empty");
        }
        Ok(Self { path, part })
    }
}

/// Whether it is a name, perhaps with the number of an element.
fn is_name(text: &str) -> bool {
    let is_number = |number: &str| {
        !number.is_empty() && number.len() <= 9 && number.bytes().all(|byte| byte.is_ascii_digit())
    };
    let name = match text.split_once(['(', '[']) {
        Some((name, number)) => {
            let close = if text[name.len()..].starts_with('(') {
                ')'
            } else {
                ']'
            };
            match number.strip_suffix(close) {
                Some(number) if is_number(number) && (close == ']' || number != "0") => name,
                _ => return false,
            }
        }
        None => text,
    };
    let is_of_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    !name.is_empty() && name.chars().all(is_of_name)
}

/// A name of a path without the number of an element, and that number, counted from 0.
pub(in super::super) fn element(name: &str) -> (&str, Option<usize>) {
    let Some(at) = name.find(['(', '[']) else {
        return (name, None);
    };
    let (name, index) = name.split_at(at);
    let number = index.get(1..index.len() - 1);
    let number: Option<usize> = number.and_then(|number| number.parse().ok());
    let from_1 = usize::from(index.starts_with('('));
    (name, number.and_then(|number| number.checked_sub(from_1)))
}

fn part(index: &str) -> Result<Part, &'static str> {
    let index = index.strip_suffix(')').ok_or(SHAPE)?;
    let (row, column) = index.split_once(',').ok_or(SHAPE)?;
    let number = |text: &str| text.parse().ok().filter(|&number| number > 0);
    match (row.trim(), column.trim()) {
        (":", column) => number(column).map(Part::Column).ok_or(SHAPE),
        (row, ":") => number(row).map(Part::Row).ok_or(SHAPE),
        _ => Err(SHAPE),
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.path.join("."))?;
        match self.part {
            Part::Whole => Ok(()),
            Part::Column(at) => write!(f, "(:,{at})"),
            Part::Row(at) => write!(f, "({at},:)"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_read_as_they_print() {
        for text in [
            "t",
            "fdata(:,12)",
            "rec.acc(3,:)",
            "(:,1)",
            "a.b.c",
            "scope.signals(12).values",
            "scope.signals(1).values(:,2)",
            "imu[1].xyz[0]",
            "imu.xyz[2]",
        ] {
            assert_eq!(text.parse::<Source>().unwrap().to_string(), text);
        }
        let source: Source = " data ( : , 3 ) ".parse().unwrap();
        assert_eq!(
            (source.path, source.part),
            (vec!["data".to_string()], Part::Column(3))
        );
    }

    #[test]
    fn elements_are_counted_as_they_are_written() {
        assert_eq!(element("signals(2)"), ("signals", Some(1)));
        assert_eq!(element("xyz[2]"), ("xyz", Some(2)));
        assert_eq!(element("alpha"), ("alpha", None));
    }

    #[test]
    fn others_are_refused() {
        for text in [
            "",
            "a b",
            "a..b",
            ".a",
            "data(3)",
            "data(:,0)",
            "data(:,:)",
            "data(1,2)",
            "data(:,3",
            "data(:,3))",
            "data(:,1:3)",
            "data(:,-1)",
            "data{1}",
            "()",
            "data(:,99999999999999999999)",
            "a.b.c.d.e.f.g.h.i",
            "signals(0).values",
            "signals(1.values",
            "signals(1).",
            "xyz[a]",
            "xyz[1",
            "[0]",
            "a(1)(2).b",
            "a[1](2).b",
            "a[99999999999].b",
        ] {
            assert!(text.parse::<Source>().is_err(), "{text}");
        }
    }
}
