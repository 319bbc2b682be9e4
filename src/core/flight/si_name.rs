//! What an engineer calls the SI unit of a quantity: `rad/s` for `deg/s`, where the dimension says `1/s`.

use super::Unit;

/// SI units with a name of their own, tried before base units.
const NAMED: [&str; 4] = ["N", "Pa", "W", "V"];

impl Unit {
    /// The SI unit of a quantity recorded in `text`, as text that reads back with scale 1.
    ///
    /// The dimension alone would call every angle a pure number; where the recording speaks of degrees the
    /// answer speaks of radians.
    pub fn si_name(text: &str) -> String {
        let text = match text.trim() {
            "" | "1" => "-",
            other => other,
        };
        let Ok(unit) = Self::parse(text) else {
            return text.to_string();
        };
        let in_symbols = Self::in_symbols(text);
        let text = in_symbols
            .trim_start_matches(|c: char| c.is_ascii_digit() || matches!(c, '.' | 'e' | '-' | '+'))
            .trim_start_matches([' ', '*']);
        let text = if text.is_empty() || text.starts_with(['/', '^']) {
            in_symbols.as_str()
        } else {
            text
        };
        if unit.is_si() {
            return text.to_string();
        }
        let in_radians = degrees_to_radians(text);
        std::iter::once(in_radians)
            .chain(NAMED.map(str::to_string))
            .find(|name| {
                Self::parse(name)
                    .is_ok_and(|named| named.is_si() && named.dimension == unit.dimension)
            })
            .unwrap_or_else(|| unit.dimension.to_string())
    }

    /// Whether numbers in this unit are in SI as they stand.
    pub fn is_si(&self) -> bool {
        self.scale == 1.0 && self.offset == 0.0
    }
}

fn degrees_to_radians(text: &str) -> String {
    let is_symbol = |c: char| c.is_alphabetic() || matches!(c, '°' | '_' | '%');
    let mut result = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let symbol = is_symbol(first);
        let end = rest.find(|c| is_symbol(c) != symbol).unwrap_or(rest.len());
        let (token, behind) = rest.split_at(end);
        result.push_str(match token {
            "deg" | "°" | "mrad" | "rev" | "cdeg" | "ddeg" | "mdeg" | "udeg" | "crad" => "rad",
            other => other,
        });
        rest = behind;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn si_units_read_as_an_engineer_writes_them() {
        let expected = [
            ("deg", "rad"),
            ("deg/s^2", "rad/s^2"),
            ("1/deg", "1/rad"),
            ("°/s", "rad/s"),
            ("rad/s", "rad/s"),
            ("kt", "m/s"),
            ("hPa", "Pa"),
            ("lbf", "N"),
            ("degC", "K"),
            ("%", "-"),
            ("", "-"),
            ("rpm", "1/s"),
            ("DEG/SEC", "rad/s"),
            ("0.01 deg", "rad"),
            ("1/deg", "1/rad"),
        ];
        for (recorded, name) in expected {
            assert_eq!(Unit::si_name(recorded), name, "of {recorded}");
            assert!(Unit::parse(name).unwrap().is_si(), "{name}");
        }
    }
}
