//! The titles of a table, with what is said of units, and the columns that a mapping means by them.

use super::super::{
    cell::{is_missing, unquote},
    code,
    label::Label,
    lines::Line,
    mapping::{Part, Source, Titles as Wanted},
    stamp::Stamp,
    text::{quoted, short_message},
};
use super::{sample::Held, stated::Stated};
use crate::flight::Unit;

/// What a table says of its columns.
pub(super) struct Titles<'a> {
    /// Names, and units in brackets; empty where the table has no header.
    pub(super) names: Option<(Line<'a>, Vec<&'a str>)>,
    /// The row of units.
    pub(super) units: Option<(Line<'a>, Vec<&'a str>)>,
    /// The cells of the first rows.
    pub(super) first: Vec<Vec<&'a str>>,
    pub(super) width: usize,
    /// The step between samples that the lines above the table say.
    pub(super) stated: Option<Stated>,
}

/// Whether a text means a title.
type Way<'a> = dyn Fn(&str, &str) -> bool + 'a;

/// A code and a message.
type Why = (&'static str, String);

impl<'a> Titles<'a> {
    /// The title over a column as it stands there.
    pub(super) fn title(&self, at: usize) -> &'a str {
        self.names
            .as_ref()
            .and_then(|(_, names)| names.get(at))
            .map_or("", |name| name.trim())
    }

    /// Name and unit of a column: the unit in brackets, in the row of units, or at the end of the name.
    ///
    /// # Errors
    /// The header says two units.
    pub(super) fn label(&self, at: usize) -> Result<Label<'a>, Why> {
        let title = self.title(at);
        let label = Label::split(title);
        let below = self
            .units
            .as_ref()
            .and_then(|(_, units)| units.get(at))
            .copied()
            .unwrap_or("");
        let below = if is_missing(below) && below != "-" {
            ""
        } else {
            below
        };
        // Altitude (baro): what is in brackets is no unit where the row of units has one
        if !below.is_empty()
            && !label.unit.is_empty()
            && Unit::parse(label.unit).is_err()
            && Unit::parse(below).is_ok()
        {
            return Label {
                name: title,
                unit: "",
            }
            .with_unit(below);
        }
        let label = label.with_unit(below)?;
        let unit = if label.unit.is_empty() {
            label.unit_in_name().unwrap_or("")
        } else {
            label.unit
        };
        Ok(Label { unit, ..label })
    }

    /// The label, the first of two units where there are two.
    pub(super) fn any_label(&self, at: usize) -> Label<'a> {
        self.label(at)
            .unwrap_or_else(|_| Label::split(self.title(at)))
    }

    fn held(&self, at: usize) -> impl Iterator<Item = (Held, &'a str)> {
        let cells = self.first.iter().filter_map(move |row| row.get(at));
        cells.map(|cell| (Held::by(cell), *cell))
    }

    /// Whether its first cells are words.
    pub(super) fn is_text(&self, at: usize) -> bool {
        let mut said = self
            .held(at)
            .filter(|(held, _)| *held != Held::Nothing)
            .peekable();
        said.peek().is_some() && said.all(|(held, _)| held == Held::Text)
    }

    /// The first cell that says something.
    pub(super) fn first_said(&self, at: usize) -> Option<&'a str> {
        self.held(at)
            .find(|(held, _)| *held != Held::Nothing)
            .map(|(_, cell)| cell)
    }

    /// The first time stamp of a column, if it has time stamps.
    pub(super) fn stamp(&self, at: usize) -> Option<Stamp> {
        self.first_said(at).and_then(Stamp::parse)
    }

    pub(super) fn has_dates(&self, at: usize) -> bool {
        self.first_said(at).is_some_and(Stamp::is_date)
    }

    /// The column that a mapping means: the one of a title, with or without its unit, or of a number.
    ///
    /// # Errors
    /// There is none, or the title is that of several.
    pub(super) fn find(&self, wanted: &Wanted) -> Result<usize, Why> {
        let mut why = (code::INVALID_MAPPING, "the source is empty".to_string());
        for title in wanted.iter() {
            match self.find_one(title.trim()) {
                Ok(at) => return Ok(at),
                Err(fault) => why = fault,
            }
        }
        Err(why)
    }

    /// Whether a title is there, be it that of several columns.
    pub(super) fn has(&self, wanted: &Wanted) -> bool {
        let is_there = |wanted: &str| {
            (0..self.width).any(|at| {
                let title = self.title(at);
                !title.is_empty()
                    && [title, Label::split(title).name]
                        .iter()
                        .any(|title| is_like(&letters(wanted), &letters(title)))
            })
        };
        wanted.iter().any(is_there)
    }

    /// Whether a column has times of other rows than all have: a unit of time, increasing, and cells without a value.
    pub(super) fn has_other_times(&self, at: usize) -> bool {
        let is_number = |cell: &str| cell.trim().parse::<f64>().ok();
        let times: Vec<f64> = self
            .held(at)
            .filter_map(|(_, cell)| is_number(cell))
            .collect();
        self.any_label(at).has_unit_of_time()
            && self.title(at).to_lowercase().starts_with('t')
            && (2..self.first.len()).contains(&times.len())
            && times.windows(2).all(|pair| pair[0] < pair[1])
    }

    /// Whether the first rows have cells, and none of this column says something.
    pub(super) fn is_empty(&self, at: usize) -> bool {
        !self.first.is_empty() && self.first_said(at).is_none()
    }

    /// Whether two columns begin with the same cells.
    pub(super) fn are_alike(&self, one: usize, other: usize) -> bool {
        let mut rows = self.first.iter();
        self.first.len() > 1 && rows.all(|row| row.get(one) == row.get(other))
    }

    fn find_one(&self, wanted: &str) -> Result<usize, Why> {
        let same = |one: &str, other: &str| one == other;
        let alike = |one: &str, other: &str| letters(one) == letters(other);
        let fits = |pattern: &str, title: &str| is_like(&letters(pattern), &letters(title));
        let ways: [&Way; 3] = [&same, &alike, &fits];
        for way in ways {
            let of_title = |at: &usize| way(wanted, self.title(*at));
            let of_name = |at: &usize| way(wanted, Label::split(self.title(*at)).name);
            for of in [&of_title as &dyn Fn(&usize) -> bool, &of_name] {
                let mut found = (0..self.width)
                    .filter(|at| !self.title(*at).is_empty())
                    .filter(of);
                match (found.next(), found.next()) {
                    (Some(at), None) => return Ok(at),
                    // LabVIEW writes the same times before each channel
                    (Some(at), Some(second))
                        if self.are_alike(at, second)
                            && found.all(|other| self.are_alike(at, other)) =>
                    {
                        return Ok(at);
                    }
                    (Some(_), Some(second)) => {
                        let message = format!(
                            "{} is the title of several columns; say which by its number, as (:,{})",
                            quoted(wanted),
                            second + 1
                        );
                        return Err((code::UNKNOWN_SOURCE, message));
                    }
                    (None, _) => {}
                }
            }
        }
        match wanted.parse::<Source>() {
            Ok(Source {
                part: Part::Column(number),
                ..
            }) if number <= self.width => Ok(number - 1),
            Ok(Source {
                part: Part::Column(number),
                ..
            }) => {
                let message = format!("there is no column {number}: the file has {}", self.width);
                Err((code::UNKNOWN_SOURCE, message))
            }
            _ => Err((code::UNKNOWN_SOURCE, self.there_is_none(wanted))),
        }
    }

    fn there_is_none(&self, wanted: &str) -> String {
        let wanted = quoted(wanted);
        if self.names.is_none() {
            return format!(
                "there is no column {wanted}: the file has no header; name its {} columns by their numbers, as (:,2)",
                self.width
            );
        }
        let all: Vec<&str> = (0..self.width)
            .map(|at| Label::split(self.title(at)).name)
            .collect();
        let all = short_message(&all.join(", "));
        format!("there is no column {wanted}; there are {all}")
    }
}

/// A title in lower case, with one blank for several.
fn letters(title: &str) -> String {
    let words: Vec<&str> = unquote(title).split_whitespace().collect();
    words.join(" ").to_lowercase()
}

/// Whether a title fits a pattern in which `*` stands for anything.
fn is_like(pattern: &str, title: &str) -> bool {
    let mut parts = pattern.split('*');
    let Some(mut rest) = parts.next().and_then(|first| title.strip_prefix(first)) else {
        return false;
    };
    let parts: Vec<&str> = parts.collect();
    let Some((last, between)) = parts.split_last() else {
        return rest.is_empty();
    };
    for part in between {
        match rest.find(part) {
            Some(at) => rest = &rest[at + part.len()..],
            None => return false,
        }
    }
    rest.ends_with(last)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn titles(names: &'static str) -> Titles<'static> {
        let line = Line {
            number: 1,
            text: names,
        };
        let names: Vec<&str> = names.split(';').collect();
        Titles {
            width: names.len(),
            names: Some((line, names)),
            units: None,
            first: Vec::new(),
            stated: None,
        }
    }

    #[test]
    fn a_column_is_found_by_title_name_pattern_or_number() {
        let titles = titles("Lcl Time;Elev Pos [deg];imu/rates[1] (rad/s);Alpha {vane};a;a;q(1)");
        let find = |wanted: &str| {
            titles
                .find(&Wanted::One(wanted.to_string()))
                .map_err(|(code, _)| code)
        };
        for (wanted, at) in [
            ("Lcl Time", 0),
            ("lcl  time", 0),
            ("Elev Pos", 1),
            ("Elev Pos [deg]", 1),
            ("imu/rates[1]", 2),
            ("imu/rates[1] (rad/s)", 2),
            ("Alpha {vane}", 3),
            ("Elev*", 1),
            ("*rates*", 2),
            ("(:,4)", 3),
            ("fdata(:,4)", 3),
            ("q(1)", 6),
        ] {
            assert_eq!(find(wanted), Ok(at), "{wanted}");
        }
        for wanted in ["a", "b", "(:,9)", "A*x", "(2,:)"] {
            assert_eq!(find(wanted), Err(code::UNKNOWN_SOURCE), "{wanted}");
        }
        assert!(
            titles.has(&Wanted::One("a".to_string()))
                && titles.has(&Wanted::One("*(1)".to_string()))
        );
        assert!(!titles.has(&Wanted::One("b".to_string())));
        let any = Wanted::AnyOf(vec!["b".to_string(), "Lcl Time".to_string()]);
        assert_eq!(titles.find(&any), Ok(0));
    }
}
