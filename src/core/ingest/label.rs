//! What a column is called: a name and perhaps a unit.

use crate::flight::Unit;

use super::{code, text::quoted, units::RecordedUnit};

/// A header cell in its two parts.
#[derive(Clone, Copy)]
pub(super) struct Label<'a> {
    pub(super) name: &'a str,
    /// Empty where the cell names none.
    pub(super) unit: &'a str,
}

impl<'a> Label<'a> {
    /// Reads `alpha[deg]`, `alpha (deg)`, `alpha {deg}`, `alpha, deg`, or `mach` without a unit. Digits in brackets are an
    /// index.
    pub(super) fn split(cell: &'a str) -> Self {
        let (name, unit) = in_brackets(cell, '[', ']')
            .or_else(|| in_brackets(cell, '(', ')'))
            .filter(|(_, unit)| !is_index(unit))
            .or_else(|| in_brackets(cell, '{', '}').filter(|(_, unit)| is_unit(unit)))
            .or_else(|| in_brackets(cell, '<', '>').filter(|(_, unit)| is_unit(unit)))
            .or_else(|| cell.rsplit_once(',').filter(|(_, unit)| is_unit(unit)))
            .or_else(|| behind_a_word(cell))
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

    /// The unit that a name ends with, as `alpha_deg` or `time_us` does. Only words that are nothing but units count.
    pub(super) fn unit_in_name(&self) -> Option<&'a str> {
        let (stem, word) = self.name.rsplit_once(['_', ' ', '-'])?;
        // deg_s, rad_sec
        let (stem, word) = match stem.rsplit_once(['_', ' ']) {
            Some((stem, rate))
                if ["s", "sec"].contains(&word) && UNITS_IN_NAMES.contains(&rate) =>
            {
                (stem, &self.name[stem.len() + 1..])
            }
            _ => (stem, word),
        };
        let lower = word.to_ascii_lowercase();
        let is_word = UNITS_IN_NAMES.contains(&lower.as_str())
            || ["deg_s", "rad_s", "deg_sec", "rad_sec", "ft_s", "m_s"].contains(&lower.as_str());
        let is_of_time = ["s", "ms", "us", "ns"].contains(&lower.as_str())
            && Self {
                name: stem,
                unit: "",
            }
            .is_called_time_or_stamp();
        (!stem.is_empty() && (is_word || is_of_time)).then_some(word)
    }

    pub(super) fn is_called_time(&self) -> bool {
        self.is_called(&["t", "time"])
    }

    /// By one of the words that loggers have for time.
    pub(super) fn is_called_time_or_stamp(&self) -> bool {
        let is_of_time = |unit: &str| {
            let units = ["s", "ms", "us", "ns"];
            units.iter().any(|other| unit.eq_ignore_ascii_case(other))
        };
        self.is_called_time()
            || self.is_called(&CLOCKS)
            || self.unit_in_name().is_some_and(is_of_time)
    }

    /// A calendar date, a column of which goes with one of times of day.
    pub(super) fn is_called_date(&self) -> bool {
        self.is_called(&[
            "date",
            "lcldate",
            "localdate",
            "utcdate",
            "gpsdate",
            "datum",
        ])
    }

    /// The week of the satellites' clock.
    pub(super) fn is_called_week(&self) -> bool {
        self.is_called(&["week", "gpsweek", "gpswk", "gwk", "gpsweekno", "wn"])
    }

    /// Letter by letter in any case, whatever is between the words.
    fn is_called(&self, names: &[&str]) -> bool {
        let letters = self.name.bytes().filter(u8::is_ascii_alphanumeric);
        let letters: Vec<u8> = letters.map(|byte| byte.to_ascii_lowercase()).collect();
        self.name.is_ascii() && names.iter().any(|name| name.as_bytes() == letters)
    }

    pub(super) fn has_unit_of_time(&self) -> bool {
        RecordedUnit::parse(self.unit).is_ok_and(|unit| unit.is_of_time())
    }
}

/// What loggers call the time, without what is between the words.
const CLOCKS: [&str; 45] = [
    "timestamp",
    "timestamps",
    "datetime",
    "elapsed",
    "elapsedtime",
    "relativetime",
    "reltime",
    "timesincestart",
    "timesinceboot",
    "timesincelaunch",
    "simtime",
    "simulationtime",
    "systemtime",
    "systime",
    "utc",
    "utctime",
    "gpstime",
    "lcltime",
    "localtime",
    "zulutime",
    "irigtime",
    "irig",
    "clock",
    "timeus",
    "timems",
    "times",
    "timesec",
    "timesecs",
    "seconds",
    "secs",
    "tow",
    "gpstow",
    "itow",
    "zeit",
    "temps",
    "tiempo",
    "tempo",
    "sessiontime",
    "realtime",
    "totltime",
    "missntime",
    "xvalue",
    "flighttime",
    "offsettime",
    "clockoffsettime",
];

/// Words that are nothing but units.
const UNITS_IN_NAMES: [&str; 38] = [
    "deg", "degs", "degrees", "rad", "rads", "radians", "dps", "degps", "radps", "mps", "fps",
    "kt", "kts", "kias", "kcas", "ktas", "mph", "kmh", "kph", "fpm", "ft", "feet", "meters",
    "metres", "hpa", "kpa", "psi", "psf", "inhg", "degc", "degf", "rpm", "pct", "percent", "lbs",
    "lbf", "kg", "volts",
];

fn is_unit(text: &str) -> bool {
    !is_index(text) && Unit::parse(text).is_ok()
}

/// `Alpha - deg`, `alpha / deg`, `Alpha in deg`. A capital alone is a side or a number, not a unit.
fn behind_a_word(cell: &str) -> Option<(&str, &str)> {
    let is_clear = |unit: &str| {
        let is_capital = unit.len() == 1 && unit.bytes().all(|byte| byte.is_ascii_uppercase());
        !unit.is_empty() && unit != "-" && !is_capital && is_unit(unit)
    };
    [" - ", " / ", " in "].iter().find_map(|between| {
        let (name, unit) = cell.rsplit_once(between)?;
        (!name.trim().is_empty() && is_clear(unit.trim())).then_some((name, unit))
    })
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
    fn units_stand_in_brackets_or_behind_a_comma() {
        for (cell, expected) in [
            ("alpha[deg]", ("alpha", "deg")),
            (" alpha [ deg ] ", ("alpha", "deg")),
            ("alpha (deg)", ("alpha", "deg")),
            ("q(1/s)", ("q", "1/s")),
            ("mach", ("mach", "")),
            ("q(1)", ("q(1)", "")),
            ("q()", ("q()", "")),
            ("q[1]", ("q[1]", "")),
            ("alpha {deg}", ("alpha", "deg")),
            ("Alpha {vane}", ("Alpha {vane}", "")),
            ("alpha, deg", ("alpha", "deg")),
            ("CHT 1, left", ("CHT 1, left", "")),
            ("alpha[deg", ("alpha[deg", "")),
        ] {
            let label = Label::split(cell);
            assert_eq!((label.name, label.unit), expected, "{cell}");
        }
    }

    #[test]
    fn names_end_with_units() {
        let unit = |name| Label::split(name).unit_in_name();
        assert_eq!(unit("alpha_deg"), Some("deg"));
        assert_eq!(unit("q_deg_s"), Some("deg_s"));
        assert_eq!(unit("time_us"), Some("us"));
        for name in ["alpha", "de_s", "q_dyn", "deg", "V_m", "n1_left"] {
            assert_eq!(unit(name), None, "{name}");
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
