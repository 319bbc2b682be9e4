//! Where in a file a channel's values are: `fdata(:,4)`, `rec.alpha`, `(:,4)`.

use std::fmt;
use std::str::FromStr;

/// A variable, fields of it, and perhaps one column or row.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(in super::super) struct Source {
    /// The variable and the fields on the way; empty: the only matrix of the file.
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

impl FromStr for Source {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let text = text.trim();
        let (path, part) = match text.split_once('(') {
            Some((path, index)) => (path.trim_end(), part(index)?),
            None => (text, Part::Whole),
        };
        let path: Vec<String> = match path {
            "" => Vec::new(),
            path => path
                .split('.')
                .map(|name| name.trim().to_string())
                .collect(),
        };
        let is_name = |name: &String| {
            let is_of_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
            !name.is_empty() && name.chars().all(is_of_name)
        };
        if !path.iter().all(is_name) {
            return Err(
                "names have letters, digits and '_' only, with dots between a struct and its fields",
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

fn part(index: &str) -> Result<Part, &'static str> {
    const SHAPE: &str =
        "in brackets there is one column, as (:,3), or one row, as (3,:), counted from 1";
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
        for text in ["t", "fdata(:,12)", "rec.acc(3,:)", "(:,1)", "a.b.c"] {
            assert_eq!(text.parse::<Source>().unwrap().to_string(), text);
        }
        let source: Source = " data ( : , 3 ) ".parse().unwrap();
        assert_eq!(
            (source.path, source.part),
            (vec!["data".to_string()], Part::Column(3))
        );
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
        ] {
            assert!(text.parse::<Source>().is_err(), "{text}");
        }
    }
}
