//! Which styles of cells show numbers as dates or times.

use std::collections::HashMap;

use super::xml::{Event, Events, attribute, text};

/// By the number that a cell has: what its style shows.
#[derive(Default)]
pub(super) struct Styles {
    shows: Vec<Shows>,
}

/// What a number is shown as.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Shows {
    Number,
    /// With a day, month or year in it.
    Date,
    /// Hours, minutes or seconds only.
    Time,
}

impl Styles {
    pub(super) fn read(part: &str) -> Self {
        let mut styles = Self::default();
        let mut formats: HashMap<&str, Shows> = HashMap::new();
        let mut is_of_cells = false;
        for event in Events::of(part) {
            match event {
                Event::Open {
                    name: "numFmt",
                    attributes,
                    ..
                } => {
                    let format = attribute(attributes, "formatCode").map(text);
                    if let (Some(id), Some(format)) = (attribute(attributes, "numFmtId"), format) {
                        formats.insert(id, shows(&format));
                    }
                }
                Event::Open {
                    name: "cellXfs", ..
                } => is_of_cells = true,
                Event::Close("cellXfs") => is_of_cells = false,
                Event::Open {
                    name: "xf",
                    attributes,
                    ..
                } if is_of_cells => {
                    let id = attribute(attributes, "numFmtId").unwrap_or("0");
                    let of_id = formats.get(id).copied();
                    styles.shows.push(of_id.unwrap_or_else(|| built_in(id)));
                }
                _ => {}
            }
        }
        styles
    }

    /// What the style of this number shows.
    pub(super) fn shows(&self, style: Option<&str>) -> Shows {
        let style = style.and_then(|style| style.parse::<usize>().ok());
        let shows = style.and_then(|style| self.shows.get(style));
        shows.copied().unwrap_or(Shows::Number)
    }
}

/// Formats that every workbook has.
fn built_in(id: &str) -> Shows {
    match id.parse() {
        Ok(14..=17 | 22) => Shows::Date,
        Ok(18..=21 | 45..=47) => Shows::Time,
        _ => Shows::Number,
    }
}

/// What a format such as `yyyy-mm-dd hh:mm:ss.000` shows.
fn shows(format: &str) -> Shows {
    let mut letters = String::new();
    let mut characters = format.chars();
    while let Some(c) = characters.next() {
        match c {
            '"' => {
                characters.by_ref().find(|&c| c == '"');
            }
            '\\' | '_' | '*' => {
                characters.next();
            }
            '[' => {
                let inside: String = characters.by_ref().take_while(|&c| c != ']').collect();
                // hours that count beyond a day; others are colours and languages
                if matches!(
                    inside.to_ascii_lowercase().as_str(),
                    "h" | "hh" | "m" | "mm" | "s" | "ss"
                ) {
                    letters.push('h');
                }
            }
            // what follows is for negative numbers
            ';' => break,
            c => letters.push(c.to_ascii_lowercase()),
        }
    }
    if letters == "general" {
        return Shows::Number;
    }
    let has = |wanted: &[char]| letters.contains(wanted);
    match (has(&['y', 'd']), has(&['h', 's'])) {
        (true, _) => Shows::Date,
        (false, true) => Shows::Time,
        (false, false) if has(&['m']) => Shows::Date,
        _ => Shows::Number,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_show_dates_times_or_numbers() {
        for (format, expected) in [
            ("General", Shows::Number),
            ("0.00E+00", Shows::Number),
            ("[Red]#,##0.0", Shows::Number),
            ("0.0\" deg/s\"", Shows::Number),
            ("yyyy\\-mm\\-dd hh:mm:ss.000", Shows::Date),
            ("mmm\\-yy", Shows::Date),
            ("mm:ss.0", Shows::Time),
            ("[h]:mm:ss", Shows::Time),
            ("0;[Red]-0 \"days\"", Shows::Number),
        ] {
            assert_eq!(shows(format), expected, "{format}");
        }
        let part = "<styleSheet><numFmts><numFmt numFmtId=\"164\" formatCode=\"hh:mm:ss\"/></numFmts>\
            <cellStyleXfs><xf numFmtId=\"22\"/></cellStyleXfs><cellXfs><xf numFmtId=\"0\"/><xf numFmtId=\"164\"/><xf numFmtId=\"22\"/></cellXfs></styleSheet>";
        let styles = Styles::read(part);
        let of = |style| styles.shows(Some(style));
        assert_eq!(
            (of("0"), of("1"), of("2")),
            (Shows::Number, Shows::Time, Shows::Date)
        );
        assert_eq!(
            (of("9"), styles.shows(None)),
            (Shows::Number, Shows::Number)
        );
    }
}
