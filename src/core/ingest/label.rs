//! What a column is called: a name and perhaps a unit.

use crate::flight::Unit;

use super::{code, name::Names, name::is_identifier, text::quoted, units::RecordedUnit};

/// A header cell in its two parts.
#[derive(Clone, Copy)]
pub(super) struct Label<'a> {
    pub(super) name: &'a str,
    /// Empty where the cell names none.
    pub(super) unit: &'a str,
}

impl<'a> Label<'a> {
    /// Reads `alpha[deg]`, `alpha [deg]`, `alpha (deg)`, or `mach` without a unit.
    pub(super) fn split(cell: &'a str) -> Self {
        let (name, unit) = in_brackets(cell, '[', ']')
            .or_else(|| in_brackets(cell, '(', ')').filter(|(_, unit)| !is_index(unit)))
            .unwrap_or((cell, ""));
        Self {
            name: name.trim(),
            unit: unit.trim(),
        }
    }

    /// Adds the unit that a row of units has for this column: `deg`, `[deg]`, `(deg)` or nothing.
    ///
    /// # Errors
    /// A code and a message: the header says another unit.
    pub(super) fn with_unit(self, cell: &'a str) -> Result<Self, (&'static str, String)> {
        let unit = in_brackets(cell, '[', ']')
            .or_else(|| in_brackets(cell, '(', ')'))
            .filter(|(before, _)| before.trim().is_empty())
            .map_or(cell, |(_, unit)| unit)
            .trim();
        if unit.is_empty() {
            return Ok(self);
        }
        let is_same = self.unit == unit
            || matches!((Unit::parse(self.unit), Unit::parse(unit)), (Ok(a), Ok(b)) if a == b);
        if self.unit.is_empty() || is_same {
            return Ok(Self { unit, ..self });
        }
        let message = format!(
            "the header says the unit {} and the row of units {}; leave the wrong one out",
            quoted(self.unit),
            quoted(unit)
        );
        Err((code::UNIT_CONFLICT, message))
    }

    pub(super) fn check_name(&self, names: &mut Names) -> Result<(), (&'static str, String)> {
        let Some(instead) = self.unit_in_braces() else {
            return names.take(self.name);
        };
        let message = format!(
            "{} does not have its unit in square brackets; write {}",
            quoted(self.name),
            quoted(&instead)
        );
        Err((code::INVALID_NAME, message))
    }

    fn unit_in_braces(&self) -> Option<String> {
        let (name, unit) = in_brackets(self.name, '{', '}')?;
        let is_label = is_identifier(name.trim()) && Unit::parse(unit).is_ok();
        is_label.then(|| format!("{}[{}]", name.trim(), unit.trim()))
    }

    pub(super) fn is_called_time(&self) -> bool {
        ["t", "time"].iter().any(|name| self.is_called(name))
    }

    pub(super) fn is_called_timestamp(&self) -> bool {
        self.is_called("timestamp")
    }

    fn is_called(&self, name: &str) -> bool {
        self.name.eq_ignore_ascii_case(name)
    }

    pub(super) fn has_unit_of_time(&self) -> bool {
        RecordedUnit::parse(self.unit).is_ok_and(|unit| unit.is_of_time())
    }
}

fn in_brackets(cell: &str, open: char, close: char) -> Option<(&str, &str)> {
    cell.trim().strip_suffix(close)?.split_once(open)
}

/// `q(1)` is the first of several q, not a q without unit.
fn is_index(text: &str) -> bool {
    text.trim().bytes().all(|byte| byte.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_stand_in_square_or_round_brackets() {
        for (cell, expected) in [
            ("alpha[deg]", ("alpha", "deg")),
            (" alpha [ deg ] ", ("alpha", "deg")),
            ("alpha (deg)", ("alpha", "deg")),
            ("q(1/s)", ("q", "1/s")),
            ("mach", ("mach", "")),
            ("q(1)", ("q(1)", "")),
            ("q()", ("q()", "")),
            ("alpha[deg", ("alpha[deg", "")),
        ] {
            let label = Label::split(cell);
            assert_eq!((label.name, label.unit), expected, "{cell}");
        }
    }

    #[test]
    fn a_row_of_units_adds_and_does_not_contradict() {
        let unit = |cell, row| Label::split(cell).with_unit(row).map(|label| label.unit);
        assert_eq!(unit("q", "deg/s"), Ok("deg/s"));
        assert_eq!(unit("q", " [deg/s]"), Ok("deg/s"));
        assert_eq!(unit("q", "(deg/s)"), Ok("deg/s"));
        assert_eq!(unit("k", "1/(m*s)"), Ok("1/(m*s)"));
        assert_eq!(unit("q[deg/s]", ""), Ok("deg/s"));
        assert_eq!(unit("t[s]", "sec"), Ok("sec"));
        assert_eq!(
            unit("q[deg/s]", "rad/s").unwrap_err().0,
            code::UNIT_CONFLICT
        );
    }
}
